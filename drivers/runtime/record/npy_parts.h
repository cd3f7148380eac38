/* The header of a .npy, apart from its file. */
#ifndef ETHD__RECORD_NPY_PARTS_H
#define ETHD__RECORD_NPY_PARTS_H

#include "ethd/record.h"

#define ETHD__NPY_MAGIC "\x93NUMPY\x01\x00"
#define ETHD__NPY_PREFIX ((size_t)10) /* bytes before the dict */

/* The position and the columns of the rows in a file. */
typedef struct ethd__npy_shape {
  const ethd_column *columns; /* the caller's table */
  size_t data, count;         /* offset of the first row, and number of rows */
  size_t row_bytes;           /* of the file */
  uint64_t lacks;             /* bit i: the file lacks the i-th newer column of the table */
} ethd__npy_shape;

/* Writes the dict up to the count, and returns its length; 0: no room. [any] */
size_t ethd__npy_dict(const ethd_column *columns, char *out, size_t room);

/* Reads the header in `text` of a file of `length` bytes, whose columns are shape->columns but for newer ones that it
   may lack; messages call the file `path`. [any] */
ETHD_MUST_CHECK ethd_status ethd__npy_parse(const char *text, size_t length, const char *path, ethd__npy_shape *shape,
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
  ethd__npy_shape shape;
  size_t row_bytes; /* of a returned row */
  size_t next;      /* number of rows returned so far */
  char *piece, *row;
} ethd__npy_reader;

/* Opens a file as ethd_npy_read does; the file must be a regular one. [main] */
ETHD_MUST_CHECK ethd_status ethd__npy_reader_open(const char *path, const ethd_column *columns, size_t row_bytes,
                                                  ethd__npy_reader *out, char message[ETHD_MESSAGE_MAX]);

/* Gives the next row, which is valid until the next call, with zeros where the file lacks a column; ETHD_STATUS_EMPTY
   after the last. [main] */
ETHD_MUST_CHECK ethd_status ethd__npy_reader_next(ethd__npy_reader *reader, const void **row,
                                                  char message[ETHD_MESSAGE_MAX]);

/* Returns true if the file lacks the table's column. [any] */
bool ethd__npy_lacks(const ethd__npy_shape *shape, const ethd_column *column);
void ethd__npy_reader_close(ethd__npy_reader *reader);

#endif
