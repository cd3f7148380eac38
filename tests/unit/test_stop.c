/* Closed forms of stopping at a wall, against published figures, a second derivation and integration. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "bounds/stop.h"

/* Plants n and b, without lag. */
static const ethd__bounds_stop n = {0.1173, 5.357, 0.398, 0, 1e30, 0, 0.012 - 7.32e-3};
static const ethd__bounds_stop b = {0.1445, 5.369, 0.164, 0, 1e30, 0, 0.012 - 8.15e-3};

START_TEST(test_published_speeds) {
  ck_assert_double_eq_tol(ethd__stop_speed(&n), 0.68, 0.005);
  ck_assert_double_eq_tol(ethd__stop_speed(&b), 0.54, 0.005);
}
END_TEST

/* At the highest speed nothing is left; a little faster it is too fast. */
START_TEST(test_speed_is_the_margin_s_end) {
  ethd__bounds_stop s = n;
  s.stiffness = 640;
  s.viscous = 1.267;
  s.behind = 0.0019;
  double v = ethd__stop_speed(&s);
  ck_assert_double_eq_tol(ethd__stop_margin(&s, v), 0, 1e-12);
  ck_assert(ethd__stop_margin(&s, 1.01 * v) < 0 && ethd__stop_margin(&s, 0.99 * v) > 0);
  ck_assert_double_eq_tol(ethd__stop_lag(&s, 0.4), 0.398 / 640 + 1.267 * 0.4 / 640 + 0.4 * 0.0019, 1e-12);
  s.stiffness = 50; /* friction alone takes more than the gap */
  ck_assert(ethd__stop_speed(&s) == 0);
}
END_TEST

/* m v' = -min(F, B v) - [v > v1] f_c, from v to v_th by small steps, as the formula has it. */
static void integrate(const ethd__bounds_stop *s, const ethd__bounds_braking *k, double v, double *time, double *way) {
  const double h = 1e-7;
  *time = *way = 0;
  for (; v > k->v_th; *time += h) {
    double pull = k->damping * v, a = pull > s->force ? (s->force + s->friction) / s->mass : pull / s->mass;
    *way += v * h;
    v -= a * h;
  }
}

START_TEST(test_saturated_braking) {
  static const double speeds[] = {0.02, 0.05, 0.2, 0.4, 0.8};
  const ethd__bounds_braking k = {100, 0.020, 0, 0}, ticking = {100, 0.020, 0.001, 0.0002};
  for (int i = 0; i < 5; i++) {
    double time, way, v = speeds[i];
    integrate(&n, &k, v, &time, &way);
    ck_assert_double_eq_tol(ethd__braking_time(&n, &k, v), time, 1e-6);
    ck_assert_double_eq_tol(ethd__braking_depth(&n, &k, v), way, 1e-6);
    ck_assert_double_eq_tol(ethd__braking_time(&n, &ticking, v), time + 0.0012, 1e-6);
    ck_assert_double_eq_tol(ethd__braking_depth(&n, &ticking, v), way + v * 0.0007, 1e-6);
  }
}
END_TEST

int main(void) {
  Suite *suite = suite_create("stop");
  TCase *all = tcase_create("all");
  tcase_add_test(all, test_published_speeds);
  tcase_add_test(all, test_speed_is_the_margin_s_end);
  tcase_add_test(all, test_saturated_braking);
  suite_add_tcase(suite, all);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_ENV);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
