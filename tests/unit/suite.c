#include "unit/suite.h"

#include <errno.h>
#include <stdlib.h>

#include "unit/rig.h"

/* Tests add themselves before main. A test that hangs is ended and named before .ci/test ends all of the file's. */
static TCase *tests(void) {
  static TCase *all;
  if (all) return all;
  setenv("CK_DEFAULT_TIMEOUT", "240", 0);
  return all = tcase_create("all");
}

void suite_add(const TTest *test, int from, int to) { tcase_add_loop_test(tests(), test, from, to); }

void suite_fixture(SFun before, SFun after) { tcase_add_checked_fixture(tests(), before, after); }

int main(void) {
  Suite *suite = suite_create(program_invocation_short_name);
  suite_add_tcase(suite, tests());
  return rig_run(suite);
}
