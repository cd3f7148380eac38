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

#endif
