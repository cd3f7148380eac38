/* The rows of a .npy, a piece at a time. [main] */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "record/npy_parts.h"
#include "text/error_text.h"
#include "text/file.h"

#define HEADER_MOST ((size_t)65545) /* bytes of the longest header and its prefix */
#define PIECE 256u                  /* rows that are read at once */

/* Returns how many bytes were read from `offset` on, up to `most`; fewer with errno 0: the file ends. */
static size_t read_at(int fd, void *to, size_t most, size_t offset) {
  size_t n = 0;
  ssize_t got = 1;
  while (n < most && got) {
    got = pread(fd, (char *)to + n, most - n, (off_t)(offset + n));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return n;
    n += (size_t)got;
  }
  errno = 0;
  return n;
}

static ethd_status read_header(ethd__npy_reader *r, size_t size, char *message) {
  ETHD__FREED char *text = malloc(HEADER_MOST);
  ethd__npy_shape *shape = &r->shape;
  if (!text) return ethd__no_memory(message, r->path);
  size_t wanted = size < HEADER_MOST ? size : HEADER_MOST, n = read_at(r->fd, text, wanted, 0);
  ethd_status status = errno ? ethd__say(message, ETHD_E_FILE, "%s: %s", r->path, strerror(errno))
                             : ethd__npy_parse(text, n < wanted ? n : size, r->path, shape, message);
  if (!status && ethd__file_has_hole(r->fd, (int64_t)(shape->data + shape->count * shape->row_bytes)))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: has a hole: some of its %zu rows were never written", r->path,
                       shape->count);
  return status;
}

static ethd_status take_memory(ethd__npy_reader *r, char *message) {
  r->piece = malloc(PIECE * r->shape.row_bytes);
  r->row = calloc(1, r->row_bytes);
  return r->piece && r->row ? ETHD_OK : ethd__no_memory(message, r->path);
}

ethd_status ethd__npy_reader_open(const char *path, const ethd_column *columns, size_t row_bytes, ethd__npy_reader *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *out = (ethd__npy_reader){.path = path, .row_bytes = row_bytes, .shape.columns = columns};
  out->fd = ethd__file_read(path, &info, message);
  if (out->fd < 0) return ETHD_E_FILE;
  ethd_status status = S_ISREG(info.st_mode) ? read_header(out, (size_t)info.st_size, message)
                                             : ethd__say(message, ETHD_E_FILE, "%s: isn't a regular file", path);
  if (!status) status = take_memory(out, message);
  if (status) ethd__npy_reader_close(out);
  return status;
}

bool ethd__npy_lacks(const ethd__npy_shape *shape, const ethd_column *column) {
  uint64_t newer = 1;
  for (const ethd_column *c = shape->columns; c < column; c++)
    if (c->newer) newer <<= 1;
  return column->newer && shape->lacks & newer;
}

/* Copies the file's columns to their offsets in a row; the other columns stay 0. */
static void widen(ethd__npy_reader *r, const char *from) {
  for (const ethd_column *c = r->shape.columns; c->name; c++) {
    const size_t n = c->count * (size_t)8;
    if (ethd__npy_lacks(&r->shape, c)) continue;
    memcpy(r->row + c->offset, from, n);
    from += n;
  }
}

ethd_status ethd__npy_reader_next(ethd__npy_reader *r, const void **row, char message[ETHD_MESSAGE_MAX]) {
  const ethd__npy_shape *shape = &r->shape;
  size_t left = shape->count - r->next, within = r->next % PIECE;
  if (!left) return ETHD_STATUS_EMPTY;
  size_t wanted = (left < PIECE ? left : PIECE) * shape->row_bytes;
  if (!within && read_at(r->fd, r->piece, wanted, shape->data + r->next * shape->row_bytes) < wanted)
    return ethd__say(message, ETHD_E_FILE, "%s: row %zu of %zu: %s", r->path, r->next, shape->count,
                     errno ? strerror(errno) : "cut short while it was read");
  *row = r->piece + within * shape->row_bytes;
  if (shape->lacks) widen(r, *row), *row = r->row;
  r->next++;
  return ETHD_OK;
}

void ethd__npy_reader_close(ethd__npy_reader *r) {
  if (r->path && r->fd >= 0) close(r->fd);
  free(r->piece);
  free(r->row);
  *r = (ethd__npy_reader){.path = NULL};
}
