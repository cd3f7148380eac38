/* Reads the text of a world, of the plane or of space: an object or a material on each line. The text is read twice:
   opening it counts lines and reads the materials, so that an object may name a material that is defined below it; then
   the objects are read one by one. [main] */
#ifndef ETHD__SCENE_TEXT_H
#define ETHD__SCENE_TEXT_H

#include "scene/form.h"

typedef struct ethd__text ethd__text;

typedef struct ethd__written {
  size_t shape; /* in its world */
  int32_t material, line;
  const double *numbers; /* a count that the form allows, of any value; they live until the text is closed */
  size_t count;
} ethd__written;

/* Opens a text, which may not change until it is closed. ETHD_E_ARGUMENT, ETHD_E_SYNTAX, ETHD_E_FULL,
   ETHD_E_NOT_FINITE, ETHD_E_MEMORY. */
ethd_status ethd__text_open(const char *text, size_t length, const ethd__world *world, ethd__text **out,
                            ethd_error *error);

/* Reads the next object. ETHD_STATUS_EMPTY: there is none; ETHD_E_SYNTAX, ETHD_E_UNKNOWN. */
ethd_status ethd__text_next(ethd__text *text, ethd__written *out);

/* Returns how many objects there are at most. */
size_t ethd__text_lines(const ethd__text *text);

/* Gives the materials, unchecked; they live until the text is closed. */
const ethd_material *ethd__text_materials(const ethd__text *text, size_t *count);

/* Closes the text; NULL is allowed. */
void ethd__text_close(ethd__text *text);

#endif
