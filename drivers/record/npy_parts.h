/* The header of a .npy, apart from its file. */
#ifndef ETHD_FILE_NPY_PARTS_H
#define ETHD_FILE_NPY_PARTS_H

#include "ethd/record.h"

/* Where the rows start in `text` and how many count; `path` stands for the file. [any] */
ETHD_MUST_CHECK ethd_status ethd__npy_parse(const char *text, size_t length, const char *path,
                                            const ethd_column *columns, size_t row_bytes, size_t *data, size_t *count,
                                            char message[ETHD_MESSAGE_MAX]);

/* errno of the first write that failed, 0: none did. */
int ethd__npy_reason(const ethd_npy *npy);

/* Rows that are in the file. */
uint64_t ethd__npy_rows(const ethd_npy *npy);

#endif
