#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/record.h"
#include "record/npy_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define PREFIX ETHD__NPY_PREFIX
#define COUNT_ROOM 20u /* digits of a count for which the header's padding has room */
#define HEADER_MAX 65536u
#define BUFFER_ROWS 256u
#define BYTES_MAX ((size_t)16 << 30)

struct ethd_npy {
  int fd;
  size_t row_bytes, header_bytes;
  size_t shape;   /* offset of the count in the header */
  uint64_t count; /* rows in the file */
  size_t waiting; /* rows in the buffer */
  int reason;     /* errno of the write that failed; 0 when none did */
  char *header, *buffer;
};

static bool dense(const ethd_column *columns, size_t row_bytes) {
  size_t at = 0;
  for (const ethd_column *c = columns; c->name; c++) {
    if (c->offset != at || !c->count || (c->type != 'f' && c->type != 'i')) return false;
    at += c->count * (size_t)8;
  }
  return at == row_bytes && row_bytes;
}

static size_t padded(size_t dict) { return (PREFIX + dict + COUNT_ROOM + sizeof ",), }\n" - 1 + 63) / 64 * 64; }

/* ---- writing ---- */

static bool write_at(int fd, const char *bytes, size_t length, uint64_t offset) {
  while (length) {
    ssize_t done = pwrite(fd, bytes, length, (off_t)offset);
    if (done < 0 && errno == EINTR) continue;
    if (done == 0) errno = ENOSPC;
    if (done <= 0) return false;
    bytes += done;
    length -= (size_t)done;
    offset += (uint64_t)done;
  }
  return true;
}

static bool start_header(ethd_npy *npy, const ethd_column *columns) {
  size_t dict = ethd__npy_dict(columns, npy->header + PREFIX, HEADER_MAX - PREFIX - COUNT_ROOM - 8);
  size_t total = padded(dict);
  if (!dict || total - PREFIX > 65535) return false;
  memcpy(npy->header, ETHD__NPY_MAGIC, sizeof ETHD__NPY_MAGIC - 1);
  npy->header[8] = (char)((total - PREFIX) & 255);
  npy->header[9] = (char)((total - PREFIX) >> 8);
  npy->shape = PREFIX + dict;
  npy->header_bytes = total;
  return true;
}

static bool write_header(ethd_npy *npy) {
  size_t n = npy->shape;
  n += (size_t)snprintf(npy->header + n, COUNT_ROOM + 8, "%llu,), }", (unsigned long long)npy->count);
  memset(npy->header + n, ' ', npy->header_bytes - n - 1);
  npy->header[npy->header_bytes - 1] = '\n';
  return write_at(npy->fd, npy->header, npy->header_bytes, 0);
}

static void release(ethd_npy *npy) {
  if (npy->fd >= 0) close(npy->fd);
  free(npy->header);
  free(npy->buffer);
  free(npy);
}

ethd_status ethd__npy_begin(int fd, const char *path, const ethd_column *columns, size_t row_bytes, ethd_npy **out,
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_npy *npy = calloc(1, sizeof *npy);
  *out = NULL;
  if (!npy) {
    close(fd);
    return ethd__no_memory(message, path);
  }
  *npy = (ethd_npy){.fd = fd, .row_bytes = row_bytes};
  npy->header = malloc(HEADER_MAX);
  npy->buffer = malloc(BUFFER_ROWS * row_bytes);
  ethd_status status = ETHD_OK;
  if (!npy->header || !npy->buffer || !start_header(npy, columns))
    status = ethd__no_memory(message, path);
  else if (!write_header(npy))
    status = ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
  if (status)
    release(npy);
  else
    *out = npy;
  return status;
}

ethd_status ethd_npy_create(const char *path, const ethd_column *columns, size_t row_bytes, ethd_npy **out,
                            char message[ETHD_MESSAGE_MAX]) {
  *out = NULL;
  if (!dense(columns, row_bytes)) return ethd__say(message, ETHD_E_ARGUMENT, "%s: columns that don't fill a row", path);
  int fd = ethd__file_create(path, message);
  return fd < 0 ? ETHD_E_FILE : ethd__npy_begin(fd, path, columns, row_bytes, out, message);
}

static ethd_status failed(ethd_npy *npy) {
  npy->reason = errno ? errno : EIO;
  return ETHD_E_FILE;
}

int ethd__npy_reason(const ethd_npy *npy) { return npy->reason; }

uint64_t ethd__npy_rows(const ethd_npy *npy) { return npy->count; }

/* Writes rows first, then the count that covers them, so that a reader never counts a row that isn't there. */
ethd_status ethd_npy_flush(ethd_npy *npy) {
  if (npy->reason) return ETHD_E_FILE;
  if (!npy->waiting) return ETHD_OK;
  uint64_t end = npy->header_bytes + npy->count * npy->row_bytes;
  if (!write_at(npy->fd, npy->buffer, npy->waiting * npy->row_bytes, end)) return failed(npy);
  npy->count += npy->waiting;
  npy->waiting = 0;
  return write_header(npy) ? ETHD_OK : failed(npy);
}

ethd_status ethd_npy_append(ethd_npy *npy, const void *rows, size_t count) {
  const char *from = rows;
  while (count && !npy->reason) {
    size_t room = BUFFER_ROWS - npy->waiting, n = count < room ? count : room;
    memcpy(npy->buffer + npy->waiting * npy->row_bytes, from, n * npy->row_bytes);
    npy->waiting += n;
    from += n * npy->row_bytes;
    count -= n;
    if (npy->waiting == BUFFER_ROWS && ethd_npy_flush(npy)) break;
  }
  return npy->reason ? ETHD_E_FILE : ETHD_OK;
}

ethd_status ethd_npy_close(ethd_npy *npy) {
  if (!npy) return ETHD_OK;
  ethd_status status = ethd_npy_flush(npy);
  if (close(npy->fd) != 0) status = ETHD_E_FILE;
  npy->fd = -1;
  release(npy);
  return status;
}

/* ---- reading ---- */

/* Allocates memory for the rows once header and file size agree on their number. */
static ethd_status read_rows(ethd__npy_reader *reader, char **out, char *message) {
  const size_t n = reader->row_bytes, bytes = reader->shape.count * n;
  const void *row;
  ethd_status status = ETHD_OK;
  if (bytes > BYTES_MAX)
    return ethd__say(message, ETHD_E_RANGE, "%s: %zu bytes of rows, at most %zu are allowed", reader->path, bytes,
                     BYTES_MAX);
  char *to = *out = malloc(bytes + 1);
  if (!to) return ethd__no_memory(message, reader->path);
  for (; reader->next < reader->shape.count && !(status = ethd__npy_reader_next(reader, &row, message)); to += n)
    memcpy(to, row, n);
  return status;
}

ethd_status ethd_npy_read(const char *path, const ethd_column *columns, size_t row_bytes, void **rows, size_t *count,
                          char message[ETHD_MESSAGE_MAX]) {
  ethd__npy_reader reader;
  char *bytes = NULL;
  *rows = NULL;
  *count = 0;
  if (!dense(columns, row_bytes)) return ethd__say(message, ETHD_E_ARGUMENT, "%s: columns that don't fill a row", path);
  ethd_status status = ethd__npy_reader_open(path, columns, row_bytes, &reader, message);
  if (status) return status;
  status = read_rows(&reader, &bytes, message);
  if (status) {
    free(bytes);
  } else {
    *rows = bytes;
    *count = reader.shape.count;
  }
  ethd__npy_reader_close(&reader);
  return status;
}
