#include "study/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "text/error_text.h"
#include "text/file.h"
#include "text/sha256.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 30)
#define SUM 8 /* hex digits */

static void sum_of(const char *text, size_t length, char out[ETHD_SHA256_TEXT]) {
  ethd__sha256 s;
  ethd__sha256_begin(&s);
  ethd__sha256_add(&s, text, length);
  ethd__sha256_end(&s, out);
}

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, ethd__file_why());
}

/* ---- reading ---- */

/* Splits a line "KIND TEXT #sum" in place; false if its check sum is wrong. */
static bool part_line(char *line, size_t length, ethd__journal_line *out) {
  char sum[ETHD_SHA256_TEXT];
  if (length < SUM + 4 || memchr(line, 0, length) || line[length - SUM - 1] != '#' || line[length - SUM - 2] != ' ')
    return false;
  size_t body = length - SUM - 2;
  char *space = memchr(line, ' ', body);
  sum_of(line, body, sum);
  if (!space || memcmp(sum, line + length - SUM, SUM) != 0) return false;
  line[body] = 0;
  *space = 0;
  *out = (ethd__journal_line){line, space + 1};
  return true;
}

static size_t count_lines(const char *text, size_t length) {
  size_t n = 1;
  for (size_t i = 0; i < length; i++) n += text[i] == '\n';
  return n;
}

/* Takes the good lines up to the first bad one, which must be the last line of the file. */
static ethd_status part(ethd__journal *journal, size_t length, char *message) {
  char *at = journal->text, *end = at + length;
  journal->lines = calloc(count_lines(at, length), sizeof *journal->lines);
  if (!journal->lines) return ethd__no_memory(message, journal->path);
  while (at < end) {
    char *newline = memchr(at, '\n', (size_t)(end - at));
    if (!newline || !part_line(at, (size_t)(newline - at), &journal->lines[journal->count])) break;
    journal->count++;
    at = newline + 1;
  }
  journal->length = (uint64_t)(at - journal->text);
  journal->cut = at < end;
  char *newline = journal->cut ? memchr(at, '\n', (size_t)(end - at)) : NULL;
  if (!newline || newline + 1 == end) return ETHD_OK;
  return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: a damaged line before others; restore the file from a copy",
                   journal->path, journal->count + 1);
}

ethd_status ethd__journal_parse(char *text, size_t length, const char *name, ethd__journal *out,
                                char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__journal){.fd = -1, .path = strdup(name), .text = text};
  ethd_status status = out->path ? part(out, length, message) : ethd__no_memory(message, NULL);
  if (status) ethd__journal_close(out);
  return status;
}

ethd_status ethd__journal_read(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]) {
  size_t length;
  char *text;
  *out = (ethd__journal){.fd = -1};
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  return status ? status : ethd__journal_parse(text, length, path, out, message);
}

/* ---- writing ---- */

static ethd_status lock(ethd__journal *journal, char *message) {
  if (flock(journal->fd, LOCK_EX | LOCK_NB) == 0) return ETHD_OK;
  if (errno != EWOULDBLOCK) return refuse(journal->path, message);
  return ethd__say(message, ETHD_E_FILE, "%s: another program is at work in this folder", journal->path);
}

static ethd_status take_file(const char *path, int fd, ethd__journal *out, char *message) {
  *out = (ethd__journal){.fd = fd, .path = strdup(path)};
  return out->path ? lock(out, message) : ethd__no_memory(message, path);
}

ethd_status ethd__journal_create(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]) {
  int fd = ethd__file_open(path, O_RDWR | O_CREAT | O_EXCL, 0666);
  *out = (ethd__journal){.fd = -1};
  if (fd < 0) return refuse(path, message);
  ethd_status status = take_file(path, fd, out, message);
  if (status) ethd__journal_close(out);
  return status;
}

/* Under the lock: nobody writes between reading and cutting. */
ethd_status ethd__journal_open(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__journal read = {.fd = -1};
  int fd = ethd__file_edit(path, false, message);
  *out = (ethd__journal){.fd = -1};
  if (fd < 0) return ETHD_E_FILE;
  ethd_status status = take_file(path, fd, out, message);
  if (!status) status = ethd__journal_read(path, &read, message);
  if (!status && read.cut && (ftruncate(out->fd, (off_t)read.length) || fsync(out->fd))) {
    status = refuse(path, message);
    ethd__journal_close(&read);
  }
  if (status) {
    ethd__journal_close(out);
    return status;
  }
  free(out->path);
  read.fd = out->fd;
  *out = read;
  return ETHD_OK;
}

static bool write_all(int fd, const char *text, size_t length, uint64_t at) {
  while (length) {
    ssize_t done = pwrite(fd, text, length, (off_t)at);
    if (done < 0 && errno == EINTR) continue;
    if (done == 0) errno = ENOSPC;
    if (done <= 0) return false;
    text += done;
    at += (uint64_t)done;
    length -= (size_t)done;
  }
  return true;
}

/* Returns the whole line with its check sum and line end; NULL without memory. */
static char *line_of(const char *kind, const char *text) {
  char *line, sum[ETHD_SHA256_TEXT];
  int length = asprintf(&line, "%s %s #%*s\n", kind, text, SUM, "");
  if (length < 0) return NULL;
  sum_of(line, (size_t)length - SUM - 3, sum);
  memcpy(line + length - SUM - 1, sum, SUM);
  return line;
}

void ethd__journal_print(FILE *file, const char *kind, const char *text) {
  char *line = line_of(kind, text);
  fputs(line ? line : "", file);
  free(line);
}

ethd_status ethd__journal_append(ethd__journal *journal, const char *kind, const char *text,
                                 char message[ETHD_MESSAGE_MAX]) {
  char *line = line_of(kind, text);
  if (!line) return ethd__no_memory(message, journal->path);
  size_t length = strlen(line);
  bool written = write_all(journal->fd, line, length, journal->length) && fdatasync(journal->fd) == 0;
  int reason = errno;
  free(line);
  if (written) {
    journal->length += length;
    return ETHD_OK;
  }
  (void)!ftruncate(journal->fd, (off_t)journal->length);
  errno = reason;
  return refuse(journal->path, message);
}

void ethd__journal_close(ethd__journal *journal) {
  if (journal->fd >= 0) close(journal->fd);
  free(journal->path);
  free(journal->text);
  free(journal->lines);
  *journal = (ethd__journal){.fd = -1};
}
