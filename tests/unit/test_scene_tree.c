/* Trees agree with brute force. make stress asks the same a hundred times as often. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "scene_brute.h"
#include "scene_objects.h"

enum { QUERIES = 6000 };

START_TEST(test_kind) {
  scene_seed(1000 + (uint64_t)_i);
  scene_check_kind(&scene_kinds[_i], 1, QUERIES);
}
END_TEST

/* The tolerance grows with the scene, whose numbers are rounded alike. */
START_TEST(test_size) {
  static const double sizes[] = {0x1p-30, 0x1p-10, 0x1p10, 0x1p19};
  scene_seed(2000 + (uint64_t)_i);
  for (int i = 0; i < 4; i++) scene_check_kind(&scene_kinds[_i], sizes[i], QUERIES / 10);
}
END_TEST

static Suite *suite(void) {
  Suite *s = suite_create("scene_tree");
  TCase *c = tcase_create("scene_tree");
  tcase_set_timeout(c, 60);
  tcase_add_loop_test(c, test_kind, 0, scene_kind_count);
  tcase_add_loop_test(c, test_size, 0, scene_kind_count);
  suite_add_tcase(s, c);
  return s;
}

int main(void) {
  SRunner *r = srunner_create(suite());
  srunner_run_all(r, CK_NORMAL);
  int failed = srunner_ntests_failed(r);
  srunner_free(r);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
