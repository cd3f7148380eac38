/* Strings of JSON. [main] */
#ifndef ETHD__APPS_CLI_JSON_H
#define ETHD__APPS_CLI_JSON_H

#include <stdio.h>

/* Writes at most n bytes of the text in quotes, with what JSON doesn't allow in a string escaped. */
void ethd__json_string(FILE *file, const char *text, size_t n);

/* Does the same with all of it; null for NULL. */
void ethd__json_word(FILE *file, const char *text);

/* Writes a number with 17 significant digits; null where it isn't finite. */
void ethd__json_number(FILE *file, double value);

#endif
