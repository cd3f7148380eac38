/* A file's tests: each is written once, and the main in suite.c runs them all. */
#ifndef ETHD_TESTS_SUITE_H
#define ETHD_TESTS_SUITE_H

#include <check.h>

/* A test; its body follows. TEST_LOOP: once for each _i from `from` up to, but without, `to`. */
#define TEST(name) TEST_LOOP(name, 0, 1)
#define TEST_LOOP(name, from, to)                                                                         \
  static void name##_run(int _i);                                                                         \
  static const TTest name = {#name, name##_run, __FILE__, __LINE__};                                      \
  __attribute__((constructor)) static void name##_add(void) { suite_add(&name, (int)(from), (int)(to)); } \
  static void name##_run(int _i __attribute__((unused)))

/* Runs `before` and `after` with each test, in its process. */
#define FIXTURE(before, after) \
  __attribute__((constructor)) static void add_fixture(void) { suite_fixture(before, after); }

void suite_add(const TTest *test, int from, int to);
void suite_fixture(SFun before, SFun after);

#endif
