/* A file's tests: each is written once, and the main in suite.c runs them all. */
#ifndef ETHD_TESTS_SUITE_H
#define ETHD_TESTS_SUITE_H

#include <check.h>

/* A test; its body follows. TEST_LOOP: once for each _i from `from` up to, but without, `to`. TEST_SIGNAL: this signal ends
   it (0: none does). */
#define TEST(name) TEST_LOOP(name, 0, 1)
#define TEST_LOOP(name, from, to) TEST_SIGNAL(name, from, to, 0)
#define TEST_SIGNAL(name, from, to, signal)                                                                       \
  static void name##_run(int _i);                                                                                 \
  static const TTest name = {#name, name##_run, __FILE__, __LINE__};                                              \
  __attribute__((constructor)) static void name##_add(void) { suite_add(&name, (int)(from), (int)(to), signal); } \
  static void name##_run(int _i __attribute__((unused)))

/* Runs `before` and `after` with each test, in its process. */
#define FIXTURE(before, after) \
  __attribute__((constructor)) static void add_fixture(void) { suite_fixture(before, after); }

/* A file may define them. Before all tests, in the parent of their processes: 0, or the program's exit code without any test
   (77: a skip, after its reason). After all tests: the program's exit code. */
int suite_begin(void);
int suite_end(int failed);

void suite_add(const TTest *test, int from, int to, int signal);
void suite_fixture(SFun before, SFun after);

#endif
