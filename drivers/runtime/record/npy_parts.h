/* The header of a .npy, apart from its file. */
#ifndef ETHD__RECORD_NPY_PARTS_H
#define ETHD__RECORD_NPY_PARTS_H

#include "ethd/record.h"

/* Finds where the rows start in `text` and how many count; messages call the file `path`. [any] */
ETHD_MUST_CHECK ethd_status ethd__npy_parse(const char *text, size_t length, const char *path,
                                            const ethd_column *columns, size_t row_bytes, size_t *data, size_t *count,
                                            char message[ETHD_MESSAGE_MAX]);

/* Does what ethd_npy_create does in an empty file, which is closed with it or if this fails. [main] */
ETHD_MUST_CHECK ethd_status ethd__npy_begin(int fd, const char *path, const ethd_column *columns, size_t row_bytes,
                                            ethd_npy **out, char message[ETHD_MESSAGE_MAX]);

/* Returns errno of the first write that failed, 0 if none did. */
int ethd__npy_reason(const ethd_npy *npy);

/* Returns how many rows are in the file. */
uint64_t ethd__npy_rows(const ethd_npy *npy);

/* Reads rows in their order. Its memory doesn't grow with the file. */
typedef struct ethd__npy_reader {
  const char *path; /* the caller's, which outlives it; NULL: it isn't open */
  int fd;
  size_t row_bytes, data; /* data: where the first row is */
  size_t count, next;     /* rows in the file, and how many have been given */
  char *piece;
} ethd__npy_reader;

/* Opens a file as ethd_npy_read does; the file must be a regular one. [main] */
ETHD_MUST_CHECK ethd_status ethd__npy_reader_open(const char *path, const ethd_column *columns, size_t row_bytes,
                                                  ethd__npy_reader *out, char message[ETHD_MESSAGE_MAX]);

/* Gives the next row, which is valid until the next call; ETHD_STATUS_EMPTY after the last. [main] */
ETHD_MUST_CHECK ethd_status ethd__npy_reader_next(ethd__npy_reader *reader, const void **row,
                                                  char message[ETHD_MESSAGE_MAX]);
void ethd__npy_reader_close(ethd__npy_reader *reader);

#endif
