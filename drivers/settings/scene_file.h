/* Scenes as files. */
#ifndef ETHD_FILE_SCENE_FILE_H
#define ETHD_FILE_SCENE_FILE_H

#include <stdio.h>

#include "ethd/config.h"

/* Materials, then objects in the order of their numbers, each number as short as reads back to the bit.
   Reading that and writing it again gives the same text. ETHD_E_ARGUMENT: a material's name can't stand in
   a file. Failed writes show in the file. [main] */
ETHD_MUST_CHECK ethd_status ethd_scene_print(const ethd_scene *scene, FILE *out);

/* One line about what ethd_scene_parse has refused in the file, with the words that are allowed in its place. [main] */
void ethd__scene_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

#endif
