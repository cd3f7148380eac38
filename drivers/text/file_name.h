/* Names of files that are made of words. No other code makes one of text that it read. [any] */
#ifndef ETHD_FILE_FILE_NAME_H
#define ETHD_FILE_FILE_NAME_H

#include <stdbool.h>

#define ETHD_FILE_WORD_MAX 32  /* bytes, the closing 0 included */
#define ETHD_FILE_NAME_MAX 128 /* likewise */

/* What ethd__file_word accepts, for messages. */
#define ETHD_FILE_WORD "a word of up to 31 letters, digits, _ . + -"

/* Letters, digits, _ . + - and no dot at the beginning: such a word is the same in a path, a table and a command. */
bool ethd__file_word(const char *word);

/* The words, which NULL ends, joined by - and followed by the suffix; every other character becomes _. */
void ethd__file_name(const char *const *words, const char *suffix, char out[ETHD_FILE_NAME_MAX]);

#endif
