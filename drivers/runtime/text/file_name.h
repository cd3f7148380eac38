/* Makes names of files from words. No other code makes a file's name from text that was read. [any] */
#ifndef ETHD__TEXT_FILE_NAME_H
#define ETHD__TEXT_FILE_NAME_H

#include <stdbool.h>

#define ETHD_FILE_WORD_MAX 32  /* bytes, the closing 0 included */
#define ETHD_FILE_NAME_MAX 128 /* the closing 0 included, too */

/* What ethd__file_word accepts, for messages. */
#define ETHD_FILE_WORD "a word of up to 31 letters, digits, _ . + -"

/* Returns true for a word of letters, digits, _ . + - that doesn't begin with a dot: it is the same in a path, a table
   and a command. */
bool ethd__file_word(const char *word);

/* Joins the words, which NULL ends, by - and appends the suffix; every other character becomes _. */
void ethd__file_name(const char *const *words, const char *suffix, char out[ETHD_FILE_NAME_MAX]);

#endif
