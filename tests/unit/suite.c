#include "unit/suite.h"

#include <errno.h>
#include <stdlib.h>

/* Tests add themselves before main. A test that hangs is ended and named before .ci/test ends all of the file's. */
static TCase *tests(void) {
  static TCase *all;
  if (all) return all;
  setenv("CK_DEFAULT_TIMEOUT", "240", 0);
  return all = tcase_create("all");
}

void suite_add(const TTest *test, int from, int to, int signal) {
  tcase_add_loop_test_raise_signal(tests(), test, signal, from, to);
}

void suite_fixture(SFun before, SFun after) { tcase_add_checked_fixture(tests(), before, after); }

__attribute__((weak)) int suite_begin(void) { return 0; }

__attribute__((weak)) int suite_end(int failed) { return failed; }

int main(void) {
  int refused = suite_begin();
  if (refused) return refused;
  Suite *suite = suite_create(program_invocation_short_name);
  suite_add_tcase(suite, tests());
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_ENV);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return suite_end(failed ? EXIT_FAILURE : EXIT_SUCCESS);
}
