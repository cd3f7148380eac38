/* The header of a .npy: NumPy's format 1.0: "\x93NUMPY" 1 0, u16 length, a Python dict padded with spaces and ended by
   a newline so that data starts at a multiple of 64. */
#include <stdio.h>
#include <string.h>

#include "record/npy_parts.h"
#include "text/error_text.h"

#define PREFIX ETHD__NPY_PREFIX
#define ENDIAN (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? '<' : '>')
#define COLUMN_MAX 160 /* bytes of one column's text */
#define BEGIN "{'descr': ["
#define END "], 'fortran_order': False, 'shape': ("

/* Writes ('b', '<i8', (2,)) and returns its length; 0: the name is too long. */
static size_t write_column(const ethd_column *c, char out[COLUMN_MAX]) {
  char count[24] = "";
  if (c->count != 1) snprintf(count, sizeof count, ", (%u,)", c->count);
  const int n = snprintf(out, COLUMN_MAX, "('%s', '%c%c8'%s)", c->name, ENDIAN, c->type, count);
  return n > 0 && n < COLUMN_MAX ? (size_t)n : 0;
}

static bool add(char *out, size_t room, size_t *n, const char *text, size_t length) {
  if (length > room - *n) return false;
  memcpy(out + *n, text, length);
  *n += length;
  return true;
}

size_t ethd__npy_dict(const ethd_column *columns, char *out, size_t room) {
  char text[COLUMN_MAX];
  size_t n = 0;
  bool fits = add(out, room, &n, BEGIN, sizeof BEGIN - 1);
  for (const ethd_column *c = columns; fits && c->name; c++) {
    const size_t length = write_column(c, text);
    fits = length && (c == columns || add(out, room, &n, ", ", 2)) && add(out, room, &n, text, length);
  }
  return fits && add(out, room, &n, END, sizeof END - 1) ? n : 0;
}

/* ---- reading ---- */

static bool take(const char **p, const char *end, const char *text, size_t length) {
  if ((size_t)(end - *p) < length || memcmp(*p, text, length) != 0) return false;
  *p += length;
  return true;
}

/* Parses the dict up to the count, and notes which of the newer columns it lacks. False: it has other columns. */
static bool take_dict(const char **p, const char *end, ethd__npy_shape *shape) {
  char text[COLUMN_MAX + 2] = ", ";
  uint64_t newer = 1; /* the bit of the next newer column; 0: none is left */
  bool first = true, same = take(p, end, BEGIN, sizeof BEGIN - 1);
  shape->lacks = 0;
  shape->row_bytes = 0;
  for (const ethd_column *c = shape->columns; same && c->name; c++) {
    const size_t skip = first ? 2 : 0, length = write_column(c, text + 2);
    const bool there = length && take(p, end, text + skip, length + 2 - skip);
    if (there) shape->row_bytes += c->count * (size_t)8;
    if (!there) shape->lacks |= newer;
    same = there || (c->newer && newer);
    first &= !there;
    if (c->newer) newer <<= 1;
  }
  return same && !first && take(p, end, END, sizeof END - 1);
}

/* Reads "12,), }", spaces and a newline; returns false for any other text. */
static bool read_count(const char *p, const char *end, size_t *count) {
  size_t value = 0, digits = 0;
  for (; p < end && *p >= '0' && *p <= '9' && digits < 18; p++, digits++) value = value * 10 + (size_t)(*p - '0');
  if (!digits || end - p < 6 || memcmp(p, ",), }", 5) != 0) return false;
  for (p += 5; p < end - 1; p++)
    if (*p != ' ') return false;
  *count = value;
  return *p == '\n';
}

static ethd_status read_header(const char *text, size_t length, const char *path, ethd__npy_shape *shape,
                               char message[ETHD_MESSAGE_MAX]) {
  if (length < PREFIX || memcmp(text, ETHD__NPY_MAGIC, sizeof ETHD__NPY_MAGIC - 1) != 0)
    return ethd__say(message, ETHD_E_SYNTAX, "%s: no NumPy file of version 1.0", path);
  size_t header = (unsigned char)text[8] | (size_t)(unsigned char)text[9] << 8;
  if (length < PREFIX + header) return ethd__say(message, ETHD_E_SYNTAX, "%s: cut short within its header", path);
  const char *p = text + PREFIX, *end = p + header;
  if (!take_dict(&p, end, shape))
    return ethd__say(message, ETHD_E_SYNTAX, "%s: other columns than those of this version of libethd", path);
  if (!read_count(p, end, &shape->count))
    return ethd__say(message, ETHD_E_SYNTAX, "%s: its header's shape isn't one count of rows", path);
  shape->data = PREFIX + header;
  return ETHD_OK;
}

/* Rows behind the header's count were incomplete when the writer ended, so they don't count. */
ethd_status ethd__npy_parse(const char *text, size_t length, const char *path, ethd__npy_shape *shape,
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = read_header(text, length, path, shape, message);
  if (status || shape->count <= (length - shape->data) / shape->row_bytes) return status;
  return ethd__say(message, ETHD_E_SYNTAX, "%s: cut short: %zu rows of %zu are there", path,
                   (length - shape->data) / shape->row_bytes, shape->count);
}
