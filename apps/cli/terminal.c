#include "cli/terminal.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/writer.h"

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

typedef struct stream {
  int fd;
  bool is_terminal;
  char last;
  ethd__writer *writer; /* NULL: the caller writes, and waits */
} stream;

static stream out = {.fd = STDOUT_FILENO}, err = {.fd = STDERR_FILENO};

static bool put(stream *s, const char *text, size_t length) {
  if (s->writer) return ethd__writer_put(s->writer, text, length), true;
  while (length) {
    ssize_t wrote = write(s->fd, text, length);
    if (wrote < 0 && errno == EINTR && !ethd__stop) continue;
    if (wrote < 0) return false;
    text += wrote;
    length -= (size_t)wrote;
  }
  return true;
}

static ssize_t put_plain(void *cookie, const char *text, size_t length) {
  stream *s = cookie;
  char plain[1024];
  if (!s->is_terminal) return put(s, text, length) ? (ssize_t)length : 0;
  size_t n = length < sizeof plain ? length : sizeof plain;
  memcpy(plain, text, n);
  make_plain(plain, n, &s->last);
  return put(s, plain, n) ? (ssize_t)n : 0;
}

/* Puts a stream of ours in the place of *file. Returns false without memory. */
static bool replace(stream *s, FILE **file, int mode) {
  FILE *ours = fopencookie(s, "w", (cookie_io_functions_t){.write = put_plain});
  if (!ours) return false;
  setvbuf(ours, NULL, mode, BUFSIZ);
  *file = ours;
  return true;
}

bool ethd__terminals_plain(void) {
  out.is_terminal = isatty(out.fd);
  err.is_terminal = isatty(err.fd);
  return (!out.is_terminal || replace(&out, &stdout, _IOLBF)) && (!err.is_terminal || replace(&err, &stderr, _IONBF));
}

/* ---- by threads ---- */

static void end(stream *s) {
  if (s->writer) ethd__writer_end(s->writer);
}

/* Writes pending output however the program ends. */
static void at_exit(void) {
  fflush(stdout);
  end(&out);
  end(&err);
}

bool ethd__streams_detach(void) {
  static ethd__writer writers[2];
  fflush(stdout);
  if (!out.is_terminal && !replace(&out, &stdout, _IOFBF)) return false;
  if (!err.is_terminal && !replace(&err, &stderr, _IONBF)) return false;
  if (atexit(at_exit) || !ethd__writer_start(&writers[0], out.fd) || !ethd__writer_start(&writers[1], err.fd))
    return false;
  out.writer = &writers[0];
  err.writer = &writers[1];
  return true;
}

int ethd__stdout_end(uint64_t *dropped) {
  end(&out);
  *dropped = out.writer ? out.writer->dropped : 0;
  return out.writer ? out.writer->failure : 0;
}

/* ---- terminals ---- */

void ethd__terminal_erase_line(void) {
  flockfile(stderr);
  (void)!put(&err, "\r\033[K", 4);
  funlockfile(stderr);
}

bool ethd__stdin_is_ours(void) {
  pid_t group = tcgetpgrp(STDIN_FILENO);
  return group <= 0 || group == getpgrp(); /* 0 or less: no terminal of ours */
}
