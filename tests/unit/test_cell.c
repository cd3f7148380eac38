#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>

#include "ethd/cell.h"
#include "unit/rig.h"

typedef struct value {
  uint64_t number, words[13]; /* all equal to number: a torn value is seen */
} value;

static value make(uint64_t number) {
  value v = {number, {0}};
  for (int i = 0; i < 13; i++) v.words[i] = number;
  return v;
}

static int whole(const value *v) {
  for (int i = 0; i < 13; i++)
    if (v->words[i] != v->number) return 0;
  return 1;
}

TEST(test_latest) {
  ethd_cell *cell;
  value v = make(7);
  ck_assert_int_eq(ethd_cell_create(sizeof v, &cell, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_cell_take(cell, &v), ETHD_STATUS_STALE);
  ck_assert_uint_eq(v.number, 7); /* untouched */
  for (uint64_t i = 1; i <= 5; i++) {
    value w = make(i);
    ethd_cell_put(cell, &w);
  }
  ck_assert_int_eq(ethd_cell_take(cell, &v), ETHD_OK);
  ck_assert(v.number == 5 && whole(&v));
  v = make(0);
  ck_assert_int_eq(ethd_cell_take(cell, &v), ETHD_STATUS_STALE);
  ck_assert(v.number == 5 && whole(&v)); /* held */
  value w = make(6);
  ethd_cell_put(cell, &w);
  ck_assert_int_eq(ethd_cell_take(cell, &v), ETHD_OK);
  ck_assert_uint_eq(v.number, 6);
  ethd_cell_destroy(cell);
  ethd_cell_destroy(NULL);
}

TEST(test_sizes) {
  ethd_cell *cell;
  ethd_error error;
  ck_assert_int_eq(ethd_cell_create(0, &cell, &error), ETHD_E_RANGE);
  ck_assert_int_eq(ethd_cell_create(65537, &cell, &error), ETHD_E_RANGE);
  ck_assert(cell == NULL && error.found == 65537 && error.min == 1 && error.max == 65536);
  for (size_t size = 1; size <= 65536; size *= 2) {
    unsigned char *in = malloc(size), *out = malloc(size);
    for (size_t i = 0; i < size; i++) in[i] = (unsigned char)(i * 31);
    ck_assert_int_eq(ethd_cell_create(size, &cell, NULL), ETHD_OK);
    ethd_cell_put(cell, in);
    ck_assert_int_eq(ethd_cell_take(cell, out), ETHD_OK);
    ck_assert_mem_eq(in, out, size);
    ethd_cell_destroy(cell);
    free(in);
    free(out);
  }
}

#define PUTS 200000

static void *writer(void *cell) {
  for (uint64_t i = 1; i <= PUTS; i++) {
    value v = make(i);
    ethd_cell_put(cell, &v);
  }
  return NULL;
}

/* Values come whole, never go back, and the last one arrives. */
TEST(test_threads) {
  ethd_cell *cell;
  pthread_t thread;
  value v = make(0);
  uint64_t last = 0;
  ck_assert_int_eq(ethd_cell_create(sizeof v, &cell, NULL), ETHD_OK);
  ck_assert_int_eq(pthread_create(&thread, NULL, writer, cell), 0);
  while (last < PUTS) {
    if (ethd_cell_take(cell, &v) != ETHD_OK) continue;
    ck_assert(whole(&v));
    ck_assert_uint_gt(v.number, last);
    last = v.number;
  }
  pthread_join(thread, NULL);
  ethd_cell_destroy(cell);
}
