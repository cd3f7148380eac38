/* Writes scenes as files, and says why one can't be read. */
#ifndef ETHD__SETTINGS_SCENE_FILE_H
#define ETHD__SETTINGS_SCENE_FILE_H

#include <stdio.h>

#include "ethd/config.h"

/* Prints the materials, then the objects in the order of their numbers, with each number as short as reads back to the
   bit. Reading the text and printing it again gives the same text. ETHD_E_ARGUMENT: a file can't have a material of
   this name. Failed writes show in `out`. [main] */
ETHD_MUST_CHECK ethd_status ethd_scene_print(const ethd_scene *scene, FILE *out);

/* Writes one line about what ethd_scene_parse refused in the file, with the words that are allowed in its place.
   [main] */
void ethd__scene_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

/* Does so about what ethd_solids_parse refused. [main] */
void ethd__solids_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

#endif
