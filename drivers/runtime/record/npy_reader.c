/* The rows of a .npy, a piece at a time. [main] */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "record/npy_parts.h"
#include "text/error_text.h"
#include "text/file.h"

#define HEADER_MOST ((size_t)65545) /* bytes of the longest header, with what stands before it */
#define PIECE 256u                  /* rows that are read at once */

/* Returns how many bytes from `offset` on are there, up to `most`; fewer with errno 0: the file ends. */
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

static ethd_status read_header(ethd__npy_reader *r, const ethd_column *columns, size_t size, char *message) {
  char *text = malloc(HEADER_MOST);
  r->piece = malloc(PIECE * r->row_bytes);
  if (!text || !r->piece) return free(text), ethd__no_memory(message, r->path);
  size_t wanted = size < HEADER_MOST ? size : HEADER_MOST, n = read_at(r->fd, text, wanted, 0);
  ethd_status status = errno ? ethd__say(message, ETHD_E_FILE, "%s: %s", r->path, strerror(errno))
                             : ethd__npy_parse(text, n < wanted ? n : size, r->path, columns, r->row_bytes, &r->data,
                                               &r->count, message);
  free(text);
  if (!status && ethd__file_has_hole(r->fd, (int64_t)(r->data + r->count * r->row_bytes)))
    status =
        ethd__say(message, ETHD_E_SYNTAX, "%s: has a hole: some of its %zu rows were never written", r->path, r->count);
  return status;
}

ethd_status ethd__npy_reader_open(const char *path, const ethd_column *columns, size_t row_bytes, ethd__npy_reader *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *out = (ethd__npy_reader){.path = path, .row_bytes = row_bytes, .fd = ethd__file_read(path, &info, message)};
  if (out->fd < 0) return ETHD_E_FILE;
  ethd_status status = S_ISREG(info.st_mode) ? read_header(out, columns, (size_t)info.st_size, message)
                                             : ethd__say(message, ETHD_E_FILE, "%s: isn't a regular file", path);
  if (status) ethd__npy_reader_close(out);
  return status;
}

ethd_status ethd__npy_reader_next(ethd__npy_reader *r, const void **row, char message[ETHD_MESSAGE_MAX]) {
  size_t left = r->count - r->next, within = r->next % PIECE;
  if (!left) return ETHD_STATUS_EMPTY;
  size_t wanted = (left < PIECE ? left : PIECE) * r->row_bytes;
  if (!within && read_at(r->fd, r->piece, wanted, r->data + r->next * r->row_bytes) < wanted)
    return ethd__say(message, ETHD_E_FILE, "%s: row %zu of %zu: %s", r->path, r->next, r->count,
                     errno ? strerror(errno) : "cut short while it was read");
  *row = r->piece + within * r->row_bytes;
  r->next++;
  return ETHD_OK;
}

void ethd__npy_reader_close(ethd__npy_reader *r) {
  if (r->path && r->fd >= 0) close(r->fd);
  free(r->piece);
  *r = (ethd__npy_reader){.path = NULL};
}
