/* Writes scenes as files, and explains why one can't be read. */
#ifndef ETHD__SETTINGS_SCENE_FILE_H
#define ETHD__SETTINGS_SCENE_FILE_H

#include <stdio.h>

#include "ethd/config.h"

/* Prints the materials, then the objects in the order of their numbers, with the fewest digits that read back to the
   bit. Reading the text and printing it again gives the same text. ETHD_E_ARGUMENT: a file can't have a material of
   this name. Failed writes show in `out`. [main] */
ETHD_MUST_CHECK ethd_status ethd_scene_print(const ethd_scene *scene, FILE *out);

/* Writes one line about a refusal of ethd_scene_parse, with the allowed words. [main] */
void ethd__scene_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

/* Writes one line about a refusal of ethd_solids_parse. [main] */
void ethd__solids_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

#endif
