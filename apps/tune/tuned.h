/* The tuned configuration: the user's file with other numbers; its comments stay. [main] */
#ifndef ETHD__APPS_TUNE_TUNED_H
#define ETHD__APPS_TUNE_TUNED_H

#include "tune/space.h"

/* Returns the configuration's text with the point's values. Keys that it lacks go to the end of their section, sections
   that it lacks to the end. With `other_folder` relative paths of scenes, plugins and plants become absolute. Each line
   of `head` becomes a comment at the top. The caller frees it; NULL: no memory. */
char *ethd__tuned_text(const ethd__tune_space *space, const ethd__tune_point *point, const char *head,
                       bool other_folder);

#endif
