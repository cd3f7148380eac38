#include "text/file_name.h"

#include <string.h>

static const char alphabet[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-";

bool ethd__file_word(const char *word) {
  return *word && *word != '.' && strlen(word) < ETHD_FILE_WORD_MAX && !word[strspn(word, alphabet)];
}

static size_t put(char *out, size_t at, size_t most, const char *word) {
  for (; *word && at < most; word++, at++) {
    bool dot_first = !at && *word == '.';
    out[at] = strchr(alphabet, *word) && !dot_first ? *word : '_';
  }
  return at;
}

/* A long word is cut, the suffix isn't. */
void ethd__file_name(const char *const *words, const char *suffix, char out[ETHD_FILE_NAME_MAX]) {
  size_t most = ETHD_FILE_NAME_MAX - 1 - strlen(suffix), at = 0;
  for (size_t i = 0; words[i]; i++) {
    if (i) at = put(out, at, most, "-");
    at = put(out, at, most, words[i]);
  }
  at = put(out, at, ETHD_FILE_NAME_MAX - 1, suffix);
  out[at] = 0;
}
