#include "cli/terminal.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Replaces control characters but for tabs and line ends, since a terminal obeys sequences that names and words of
   files may hold. In UTF-8 the characters from 0x80 to 0x9f are two bytes long. */
static void make_plain(char *text, size_t length, char *last) {
  for (size_t i = 0; i < length; i++) {
    unsigned char c = (unsigned char)text[i];
    bool control = (c < ' ' && c != '\n' && c != '\t') || c == 0x7f;
    bool second = *last == '\xc2' && c >= 0x80 && c < 0xa0;
    *last = text[i];
    if (control) text[i] = '?';
    if (second) text[i] = '\xbf';
  }
}

typedef struct terminal {
  int fd;
  char last;
} terminal;

static ssize_t put_plain(void *cookie, const char *text, size_t length) {
  terminal *t = cookie;
  char plain[1024];
  size_t n = length < sizeof plain ? length : sizeof plain, done = 0;
  memcpy(plain, text, n);
  make_plain(plain, n, &t->last);
  while (done < n) {
    ssize_t wrote = write(t->fd, plain + done, n - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return 0;
    done += (size_t)wrote;
  }
  return (ssize_t)n;
}

/* Returns false without memory. */
static bool make_stream_plain(terminal *t, FILE **stream, int mode) {
  if (!isatty(t->fd)) return true;
  FILE *plain = fopencookie(t, "w", (cookie_io_functions_t){.write = put_plain});
  if (!plain) return false;
  setvbuf(plain, NULL, mode, BUFSIZ);
  *stream = plain;
  return true;
}

bool ethd__terminals_plain(void) {
  static terminal out = {.fd = STDOUT_FILENO}, err = {.fd = STDERR_FILENO};
  return make_stream_plain(&out, &stdout, _IOLBF) && make_stream_plain(&err, &stderr, _IONBF);
}
