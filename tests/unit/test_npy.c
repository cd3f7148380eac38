/* NumPy files: laid out as the format says, readable while they grow, strict when read. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/record.h"
#include "ethd/space.h"
#include "record/npy_parts.h"
#include "unit/suite.h"

typedef struct row {
  int64_t n;
  double x[16], y;
} row;

static const ethd_column columns[] = {{"n", "1", 1, 0, 'i', false},
                                      {"x", "m", 16, 8, 'f', false},
                                      {"y", "m", 1, 136, 'f', false},
                                      {NULL, NULL, 0, 0, 0, false}};
static const char dict[] =
    "{'descr': [('n', '<i8'), ('x', '<f8', (16,)), ('y', '<f8')], 'fortran_order': False, 'shape': (";

static char message[ETHD_MESSAGE_MAX];
static char path[] = "/tmp/ethd-npy-XXXXXX";

static void set_up(void) {
  int fd = mkstemp(path);
  ck_assert_int_ge(fd, 0);
  close(fd);
}

static void tear_down(void) {
  unlink(path);
  strcpy(path, "/tmp/ethd-npy-XXXXXX");
}

static row row_at(int64_t i) {
  row r = {.n = i, .y = (double)i / 3};
  for (int k = 0; k < 16; k++) r.x[k] = (double)i + k * 0.0625;
  return r;
}

static void write_rows(ethd_npy *npy, int64_t from, int64_t to) {
  for (int64_t i = from; i < to; i++) {
    row r = row_at(i);
    ck_assert_int_eq(ethd_npy_append(npy, &r, 1), ETHD_OK);
  }
}

static size_t read_file(char *out, size_t room) {
  FILE *file = fopen(path, "rb");
  ck_assert_ptr_nonnull(file);
  size_t n = fread(out, 1, room, file);
  fclose(file);
  return n;
}

static void write_file(const char *bytes, size_t length) {
  FILE *file = fopen(path, "wb");
  ck_assert_ptr_nonnull(file);
  ck_assert_uint_eq(fwrite(bytes, 1, length, file), length);
  fclose(file);
}

/* The header byte by byte, from the format's own description. */
TEST(test_layout) {
  ethd_npy *npy;
  static char file[16384];
  ck_assert_int_eq(ethd_npy_create(path, columns, sizeof(row), &npy, message), ETHD_OK);
  write_rows(npy, 0, 5);
  ck_assert_int_eq(ethd_npy_close(npy), ETHD_OK);
  size_t n = read_file(file, sizeof file);
  ck_assert(memcmp(file, "\x93NUMPY\x01\x00", 8) == 0);
  size_t header = (unsigned char)file[8] + 256u * (unsigned char)file[9];
  ck_assert_uint_eq((10 + header) % 64, 0);
  ck_assert_uint_eq(n, 10 + header + 5 * sizeof(row));
  ck_assert(memcmp(file + 10, dict, sizeof dict - 1) == 0);
  ck_assert(memcmp(file + 10 + sizeof dict - 1, "5,), }", 6) == 0);
  for (const char *p = file + 10 + sizeof dict - 1 + 6; p < file + 9 + header; p++) ck_assert_int_eq(*p, ' ');
  ck_assert_int_eq(file[9 + header], '\n');
  ck_assert_uint_ge(header - (sizeof dict - 1), 6 + 19 + 1); /* room for any count */
  for (int i = 0; i < 5; i++) {
    row r = row_at(i);
    ck_assert(memcmp(file + 10 + header + (size_t)i * sizeof r, &r, sizeof r) == 0);
  }
}

TEST(test_readable_while_it_grows) {
  ethd_npy *npy;
  void *rows;
  size_t count;
  ck_assert_int_eq(ethd_npy_create(path, columns, sizeof(row), &npy, message), ETHD_OK);
  ck_assert_int_eq(ethd_npy_read(path, columns, sizeof(row), &rows, &count, message), ETHD_OK);
  ck_assert_uint_eq(count, 0);
  free(rows);
  for (int64_t n = 1; n < 3000; n *= 3) {
    write_rows(npy, n / 3, n);
    ck_assert_int_eq(ethd_npy_flush(npy), ETHD_OK);
    ck_assert_int_eq(ethd_npy_read(path, columns, sizeof(row), &rows, &count, message), ETHD_OK);
    ck_assert_uint_eq(count, (size_t)n);
    for (int64_t i = 0; i < n; i++) {
      row r = row_at(i);
      ck_assert(memcmp((row *)rows + i, &r, sizeof r) == 0);
    }
    free(rows);
  }
  ck_assert_int_eq(ethd_npy_close(npy), ETHD_OK);
}

static void check_refused(const char *bytes, size_t length, const char *says) {
  void *rows;
  size_t count;
  char expected[ETHD_MESSAGE_MAX];
  write_file(bytes, length);
  snprintf(expected, sizeof expected, "%s: %s", path, says);
  ck_assert_int_lt(ethd_npy_read(path, columns, sizeof(row), &rows, &count, message), 0);
  ck_assert_ptr_null(rows);
  ck_assert_str_eq(message, expected);
}

TEST(test_bad_files) {
  static char file[16384], bad[16384];
  ethd_npy *npy;
  ck_assert_int_eq(ethd_npy_create(path, columns, sizeof(row), &npy, message), ETHD_OK);
  write_rows(npy, 0, 5);
  ck_assert_int_eq(ethd_npy_close(npy), ETHD_OK);
  size_t n = read_file(file, sizeof file);
  char *shape = strstr(file + 10, "5,), }");
  check_refused(file, n - 1, "cut short: 4 rows of 5 are there");
  check_refused(file, 100, "cut short within its header");
  check_refused(file, 9, "no NumPy file of version 1.0");
  check_refused("", 0, "no NumPy file of version 1.0");
  memcpy(bad, file, n);
  bad[6] = 2;
  check_refused(bad, n, "no NumPy file of version 1.0");
  memcpy(bad, file, n);
  memcpy(strstr(bad + 10, "<f8"), "<f4", 3);
  check_refused(bad, n, "other columns than those of this version of libethd");
  memcpy(bad, file, n);
  memcpy(bad + (shape - file), "5, 1)", 5);
  check_refused(bad, n, "its header's shape isn't one count of rows");
  memcpy(bad, file, n);
  memcpy(bad + (shape - file), "999999999999999999,), }", 23);
  check_refused(bad, n, "cut short: 5 rows of 999999999999999999 are there");
}

/* A file of the years before `early`, `mid` and `late`, and of those between, reads with zeros in their place. */
TEST(test_newer_columns) {
  typedef struct grown {
    double early;
    int64_t n;
    double mid[2], x, late;
  } grown;
  static const ethd_column all[] = {{"early", "m", 1, 0, 'f', true}, {"n", "1", 1, 8, 'i', false},
                                    {"mid", "m", 2, 16, 'f', true},  {"x", "m", 1, 32, 'f', false},
                                    {"late", "m", 1, 40, 'f', true}, {NULL, NULL, 0, 0, 0, false}};
  static const double first[] = {1.5, 0, 2.5, 3.5, 4.5, 5.5};
  for (unsigned has = 0; has < 32; has++) {
    ethd_column some[6];
    double rows[12], *to = rows;
    uint32_t n = 0, bytes = 0;
    for (int i = 0; i < 5; i++)
      if (has >> i & 1) some[n] = all[i], some[n].offset = bytes, bytes += 8 * all[i].count, n++;
    some[n] = all[5];
    if (!n) continue;
    for (int at = 0; at < 2; at++)
      for (int i = 0; i < 5; i++)
        for (uint32_t k = 0; has >> i & 1 && k < all[i].count; k++) *to++ = at + first[all[i].offset / 8 + k];
    for (int at = 0; at < 2 && has & 2; at++) memcpy(&rows[at * bytes / 8 + (has & 1)], &(int64_t){7 + at}, 8);
    ethd_npy *npy;
    grown *read;
    size_t count;
    ck_assert_int_eq(ethd_npy_create(path, some, bytes, &npy, message), ETHD_OK);
    ck_assert_int_eq(ethd_npy_append(npy, rows, 2), ETHD_OK);
    ck_assert_int_eq(ethd_npy_close(npy), ETHD_OK);
    const ethd_status status = ethd_npy_read(path, all, sizeof(grown), (void **)&read, &count, message);
    ck_assert_int_eq(status, (has & 10) == 10 ? ETHD_OK : ETHD_E_SYNTAX); /* n and x were always there */
    for (size_t at = 0; !status && at < 2; at++) {
      const double more = (double)at;
      ck_assert_uint_eq(count, 2);
      ck_assert_int_eq(read[at].n, 7 + (int)at);
      ck_assert(read[at].x == 4.5 + more && read[at].early == (has & 1 ? 1.5 + more : 0));
      ck_assert(read[at].late == (has & 16 ? 5.5 + more : 0));
      ck_assert(read[at].mid[0] == (has & 4 ? 2.5 + more : 0) && read[at].mid[1] == (has & 4 ? 3.5 + more : 0));
    }
    free(read);
  }
}

TEST(test_bad_columns) {
  static const ethd_column gap[] = {
      {"n", "1", 1, 0, 'i', false}, {"y", "m", 1, 136, 'f', false}, {NULL, NULL, 0, 0, 0, false}};
  ethd_npy *npy;
  ck_assert_int_eq(ethd_npy_create(path, gap, sizeof(row), &npy, message), ETHD_E_ARGUMENT);
  ck_assert_ptr_null(npy);
  ck_assert_int_eq(ethd_npy_create("/nowhere/x.npy", columns, sizeof(row), &npy, message), ETHD_E_FILE);
  ck_assert_str_eq(message, "/nowhere/x.npy: No such file or directory");
}

TEST(test_full_disk) {
  ethd_npy *npy;
  ethd_status status = ethd_npy_create("/dev/full", columns, sizeof(row), &npy, message);
  ck_assert_int_eq(status, ETHD_E_FILE);
}

/* A trace's columns cover it without a gap, in the order of its fields. */
static size_t covered(const ethd_column *all, size_t bytes) {
  size_t at = 0, count = 0;
  for (const ethd_column *c = all; c->name; c++, count++) {
    ck_assert_uint_eq(c->offset, at);
    at += c->count * (size_t)8;
    for (const ethd_column *other = all; other < c; other++) ck_assert_str_ne(other->name, c->name);
  }
  ck_assert_uint_eq(at, bytes);
  return count;
}

TEST(test_trace_columns) {
  const size_t count = covered(ethd_trace_columns, sizeof(ethd_trace));
  (void)covered(ethd_space_trace_columns, sizeof(ethd_space_trace));
  ck_assert_str_eq(ethd_trace_columns[0].name, "time_ns");
  ck_assert_str_eq(ethd_trace_columns[count - 1].name, "learnt");
  ck_assert_uint_eq(ethd_trace_columns[count - 1].offset, offsetof(ethd_trace, learnt));
}

FIXTURE(set_up, tear_down)
