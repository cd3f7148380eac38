/* Statistics whose values are known: from tables, closed forms, or counted out. tests/statistics.sh holds a whole
   report against SciPy. */
#include <math.h>
#include <string.h>

#include "statistics/clusters.h"
#include "statistics/coverage.h"
#include "statistics/dip.h"
#include "statistics/distribution.h"
#include "statistics/paired.h"
#include "unit/draw.h"
#include "unit/rig.h"

/* R: quantile(c(1, 2, 4, 8), c(.25, .5, .75)) is 1.75 3 5; sd is 3.095696 */
START_TEST(test_summary) {
  double v[] = {8, 1, 4, 2};
  ethd__summary5 s;
  ethd__summarise(v, 4, &s);
  ck_assert(s.q1 == 1.75 && s.median == 3 && s.q3 == 5 && s.min == 1 && s.max == 8 && s.mean == 3.75);
  ck_assert_double_eq_tol(s.sd, 3.0956959368344519, 1e-15);
  ethd__summarise(v, 1, &s);
  ck_assert(isnan(s.sd) && s.median == 1);
  ethd__summarise(v, 0, &s);
  ck_assert(s.n == 0 && isnan(s.mean) && isnan(s.median));
}
END_TEST

/* Tables: t(.975; 5) is 2.570581835636314, chi square's P(X > 5.991464547107979; 2) is 0.05. */
START_TEST(test_distributions) {
  ck_assert_double_eq_tol(ethd__student_quantile(0.975, 5), 2.570581835636314, 1e-13);
  ck_assert_double_eq_tol(ethd__student_below(1, 1), 0.75, 1e-15);
  ck_assert_double_eq_tol(ethd__chi_square_above(5.991464547107979, 2), 0.05, 1e-14);
  ck_assert_double_eq_tol(ethd__chi_square_above(1, 2), exp(-0.5), 1e-14);
  ck_assert_double_eq_tol(ethd__noncentral_below(0, 7, 1.2), ethd__normal_below(-1.2), 1e-13);
  ck_assert_double_eq_tol(ethd__noncentral_below(1.7, 7, 0), ethd__student_below(1.7, 7), 1e-12);
  ck_assert(isnan(ethd__student_below(NAN, 3)) && isnan(ethd__student_quantile(1, 3)));
}
END_TEST

START_TEST(test_pairs) {
  const double three[] = {1, 2, 3};
  ethd__paired c;
  ethd__compare(three, 3, 1, &c);
  ck_assert(c.n == 3 && c.positive == 3 && c.mean == 2 && c.median == 2 && c.d_z == 2 && isnan(c.p));
  ck_assert_double_eq_tol(c.interval.low, 2 - 4.302652729749464 / sqrt(3), 1e-12); /* t(.975; 2) */
  ck_assert_double_eq_tol(ethd__noncentral_below(2 * sqrt(3), 2, c.effect.low * sqrt(3)), 0.975, 1e-10);
  const double six[] = {1, 2, 3, 4, 5, 6};
  ethd__compare(six, 6, 1, &c);
  ck_assert_double_eq(c.p, 2.0 / 64);
  const double mixed[] = {1, -1, 2, -2, 3, -3};
  ethd__compare(mixed, 6, 1, &c);
  ck_assert_double_eq(c.p, 1);
  double many[70]; /* more than a word has bits */
  for (int i = 0; i < 70; i++) many[i] = 1;
  ethd__compare(many, 70, 1, &c);
  ck_assert_double_lt(c.p, 1e-4);
  ck_assert(isnan(c.d_z));
  ethd__compare(three, 0, 1, &c);
  ck_assert(isnan(c.mean) && c.n == 0);
  const double tenths[] = {0.1, 0.2, -0.3, 0.4, -0.1, 0.3}; /* sums that are equal but for rounding */
  size_t as_far = 0;
  for (int k = 0; k < 64; k++) {
    int sum = 0;
    static const int whole[] = {1, 2, -3, 4, -1, 3};
    for (int i = 0; i < 6; i++) sum += k >> i & 1 ? -whole[i] : whole[i];
    as_far += sum >= 6 || sum <= -6;
  }
  ck_assert_double_eq(ethd__sign_flip(tenths, 6, 1), (double)as_far / 64);
}
END_TEST

/* Drawn signs agree with all of them: 17 people by drawing, 16 of them and a zero exactly. */
START_TEST(test_drawn_signs) {
  double d[17];
  for (int i = 0; i < 16; i++) d[i] = 0.4 + draw_normal((uint64_t)i);
  d[16] = 0;
  double exact = ethd__sign_flip(d, 16, 1), drawn = ethd__sign_flip(d, 17, 1);
  ck_assert_double_eq_tol(drawn, exact, 4 * sqrt(exact * (1 - exact) / 20000) + 1e-4);
  ck_assert(drawn == ethd__sign_flip(d, 17, 1) && drawn != ethd__sign_flip(d, 17, 2));
}
END_TEST

START_TEST(test_equivalence) {
  const double v[] = {-1, 0, 1, 0};
  ethd__equivalence e = ethd__equivalent(v, 4, -2, 2);
  double error = sqrt(2.0 / 3) / 2;
  ck_assert_double_eq_tol(e.p, ethd__student_below(-2 / error, 3), 1e-15);
  ck_assert_double_eq_tol(e.high, ethd__student_quantile(0.95, 3) * error, 1e-14);
  ck_assert(!e.outside);
  e = ethd__equivalent(v, 4, 3, 4);
  ck_assert(e.p > 0.99 && e.outside);
  const double same[] = {1, 1, 1};
  ck_assert(ethd__equivalent(same, 3, 0, 2).p == 0 && ethd__equivalent(same, 3, 1, 2).p == 1);
  ck_assert(isnan(ethd__equivalent(v, 1, -1, 1).p));
}
END_TEST

/* All signs of the ranks, counted out. */
static double counted(const double *d, int n) {
  double size[12], rank[12], here = 0, all = 0, as_far[2] = {0, 0};
  for (int i = 0; i < n; i++) size[i] = fabs(d[i]);
  ethd__rank(size, (size_t)n, rank);
  for (int i = 0; i < n; i++) here += d[i] > 0 ? rank[i] : 0;
  for (int k = 0; k < 1 << n; k++) {
    double sum = 0;
    bool whole = true;
    for (int i = 0; i < n; i++) {
      if (d[i] == 0 && k >> i & 1) whole = false;
      if (k >> i & 1) sum += rank[i];
    }
    if (!whole) continue;
    all++, as_far[0] += sum <= here, as_far[1] += sum >= here;
  }
  return fmin(1, 2 * fmin(as_far[0], as_far[1]) / all);
}

START_TEST(test_ranks) {
  double rank[5];
  ethd__rank((double[]){3, 1, 3, 2, 3}, 5, rank);
  ck_assert(rank[0] == 4 && rank[1] == 1 && rank[2] == 4 && rank[3] == 2 && rank[4] == 4);
  const double plain[] = {1, 2, 3, 4, 5, 6}, tied[] = {1, -1, 0, 2, 2, 0, 3, 1, -2, 4};
  ck_assert_double_eq(ethd__wilcoxon(plain, 6).p, 2.0 / 64);
  ck_assert_double_eq_tol(ethd__wilcoxon(tied, 10).p, counted(tied, 10), 1e-15);
  ck_assert(ethd__wilcoxon(tied, 10).zeros == 2);
  ck_assert(isnan(ethd__wilcoxon((double[]){0, 0}, 2).p));
  double p, same[] = {1, 2, 3, 1, 2, 3, 1, 2, 3}; /* every row in the same order: (k - 1) n */
  ck_assert_double_eq_tol(ethd__friedman(same, 3, 3, &p), 6, 1e-13);
  ck_assert_double_eq_tol(p, exp(-3), 1e-14);
}
END_TEST

START_TEST(test_holm) {
  double p[] = {0.01, NAN, 0.04, 0.03, 0.005};
  ethd__holm(p, 5);
  ck_assert_double_eq_tol(p[4], 0.02, 1e-15);
  ck_assert_double_eq_tol(p[0], 0.03, 1e-15);
  ck_assert_double_eq_tol(p[3], 0.06, 1e-15);
  ck_assert_double_eq_tol(p[2], 0.06, 1e-15);
  ck_assert(isnan(p[1]));
}
END_TEST

/* SciPy: ttest_rel, ttest_ind(equal_var=False), and the formulas of the paper in NumPy for what lies between. */
START_TEST(test_samples_that_overlap) {
  const double a[] = {0.31, 0.52, -0.11, 0.44, 0.9, 0.27, 0.61}, b[] = {0.12, 0.2, 0.05, 0.17, 0.33, 0.01, 0.3};
  double first[14], second[14];
  ethd__overlap o = ethd__overlapping(a, b, 7);
  ck_assert(o.both == 7 && fabs(o.p - 0.0221530557558637) < 1e-10);
  /* 1e-9, 1e-8: SciPy's quantile of t is that far off, by its own distribution function */
  ck_assert(fabs(o.low - 0.05054119102701485) < 1e-9 && fabs(o.high - 0.45231595183012807) < 1e-9);
  for (int i = 0; i < 14; i++) first[i] = i < 7 ? a[i] : NAN, second[i] = i < 7 ? NAN : b[i - 7];
  o = ethd__overlapping(first, second, 14);
  ck_assert(o.both == 0 && o.first == 7 && o.second == 7 && fabs(o.p - 0.08462477673637601) < 1e-10);
  const double x[] = {0.31, 0.52, -0.11, 0.44, 0.9, NAN, NAN, 0.27, NAN},
               y[] = {0.12, 0.2, 0.05, NAN, NAN, 0.33, 0.01, 0.3, -0.2};
  o = ethd__overlapping(x, y, 9);
  ck_assert(o.first == 6 && o.second == 7 && o.both == 4);
  ck_assert(fabs(o.freedom - 4.744652268526766) < 1e-10 && fabs(o.p - 0.0879485727183803) < 1e-10);
  ck_assert(fabs(o.low + 0.05974726301508637) < 1e-8 && fabs(o.high - 0.6049853582531817) < 1e-8);
  ck_assert(isnan(ethd__overlapping(x, y, 1).p));
}
END_TEST

START_TEST(test_people_are_drawn_whole) {
  ethd__tapped taps[] = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {3, 4, 0}, {3, 4, 0}, {3, 4, 0}};
  ethd__clusters c;
  ck_assert(ethd__clusters_make(taps, 6, 5, &c));
  ck_assert(c.persons == 2 && ethd__clusters_here(&c, ethd__clusters_median) == 2);
  ethd__interval i = ethd__clusters_bootstrap(&c, ethd__clusters_median, 2, 1);
  ck_assert(i.low == 1 && i.high == 3 && i.draws == ETHD_CLUSTERS_DRAWS);
  ck_assert(isnan(ethd__clusters_bootstrap(&c, ethd__clusters_median, 3, 1).low));
  ethd__clusters_free(&c);
}
END_TEST

START_TEST(test_cliff) {
  ethd__tapped taps[] = {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {3, 1, 1}}; /* 2: > 1, = 2, = 2; 3: > all */
  ethd__clusters c;
  ck_assert(ethd__clusters_make(taps, 5, 2, &c));
  ck_assert_double_eq_tol(ethd__clusters_here(&c, ethd__clusters_cliff), 4.0 / 6, 1e-15);
  ethd__clusters_free(&c);
}
END_TEST

/* One heap lies within 1/(2 n) of a uniform distribution, two far ones a quarter apart from any single one. */
START_TEST(test_dip) {
  double even[10], two[40];
  for (int i = 0; i < 10; i++) even[i] = i;
  ck_assert_double_eq_tol(ethd__dip(even, 10), 0.05, 1e-15);
  for (int i = 0; i < 40; i++) two[i] = (i < 20 ? 0 : 1000) + i % 20;
  ck_assert_double_eq_tol(ethd__dip(two, 40), 0.25, 0.02);
  ck_assert_double_lt(ethd__dip_share(ethd__dip(two, 40), 40, 1), 0.002);
  ck_assert_double_eq(ethd__dip_share(ethd__dip(even, 10), 10, 1), 1);
  ck_assert(isnan(ethd__dip_share(0.2, 7, 1)));
  double ms[] = {4, 4, 4, 5, 5, 6};
  ethd__dip_spread(ms, 6, 1);
  ck_assert_double_eq_tol(ms[0], 4 - 1.0 / 3, 1e-15);
  ck_assert_double_eq_tol(ms[1], 4, 1e-15);
  ck_assert(ms[3] == 4.75 && ms[4] == 5.25 && ms[5] == 6);
}
END_TEST

/* Of single heaps the dip finds two in at most its 5 %. */
START_TEST(test_dip_of_one_heap) {
  int found = 0;
  for (uint64_t run = 0; run < 100; run++) {
    double v[60];
    for (uint64_t i = 0; i < 60; i++) v[i] = draw_normal(run * 60 + i);
    ethd__sort(v, 60);
    found += ethd__dip_share(ethd__dip(v, 60), 60, 1) < 0.05;
  }
  ck_assert_int_le(found, 5);
}
END_TEST

START_TEST(test_resampled_nines) {
  double v[400], share[2];
  for (uint64_t i = 0; i < 400; i++) v[i] = draw_normal(i);
  ethd__resample(v, 400, 9, 0, 1, 1, share);
  ck_assert(share[0] > 0.5 && share[1] > 0.3);
  ethd__resample(v, 400, 9, 3, 4, 1, share);
  ck_assert(share[0] == 0 && share[1] == 0);
}
END_TEST

/* What the report says of its intervals is what a simulation of their coverage gives again, under another seed. */
START_TEST(test_coverage) {
  enum { RUNS = 80 };
  for (size_t people = 3; people <= 12; people *= 2) {
    ethd__coverage known = *ethd__coverage_known(people), here = ethd__coverage_of(people, RUNS, 77);
    const double a[] = {known.median, known.cliff, known.mean, known.effect};
    const double b[] = {here.median, here.cliff, here.mean, here.effect};
    ck_assert_uint_eq(known.people, people);
    for (int i = 0; i < 4; i++)
      ck_assert_msg(fabs(a[i] - b[i]) < 4 * sqrt(a[i] * (1 - a[i]) / RUNS), "%zu people, interval %d: %g, not %g",
                    people, i, b[i], a[i]);
  }
  ck_assert_uint_eq(ethd__coverage_known(1000)->people, 24);
  ck_assert_uint_eq(ethd__coverage_known(5)->people, 3);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("statistics");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, 120);
  tcase_add_test(all, test_summary);
  tcase_add_test(all, test_distributions);
  tcase_add_test(all, test_pairs);
  tcase_add_test(all, test_drawn_signs);
  tcase_add_test(all, test_equivalence);
  tcase_add_test(all, test_ranks);
  tcase_add_test(all, test_holm);
  tcase_add_test(all, test_samples_that_overlap);
  tcase_add_test(all, test_people_are_drawn_whole);
  tcase_add_test(all, test_cliff);
  tcase_add_test(all, test_dip);
  tcase_add_test(all, test_dip_of_one_heap);
  tcase_add_test(all, test_resampled_nines);
  tcase_add_test(all, test_coverage);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
