/* The tuned configuration: the user's own file with other numbers in it, comments and all. [main] */
#ifndef ETHD_TUNE_TUNED_H
#define ETHD_TUNE_TUNED_H

#include "tune/space.h"

/* `text` with the point's values in place of those that its keys have, new keys at the end of their section, new sections
   at the end; paths of scenes, plugins and plants that are relative to `folder` become absolute when the file goes to
   another one. each line of `head` becomes a comment at the top. Freed by the caller; NULL: no memory. */
char *ethd__tuned_text(const ethd__tune_space *space, const ethd__tune_point *point, const char *head,
                       bool other_folder);

#endif
