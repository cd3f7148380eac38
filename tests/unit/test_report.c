/* Sheets of words, and statistics whose values are known. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/sheet.h"
#include "report/stats.h"
#include "unit/mutate.h"
#include "unit/rig.h"

static char message[ETHD_MESSAGE_MAX];
static ethd__sheet sheet;

static ethd_status parse(const char *text) { return ethd__sheet_parse(text, strlen(text), "x.csv", &sheet, message); }

START_TEST(test_cells) {
  ck_assert_msg(!parse("a,b,c\n1,\"x, \"\"y\"\"\",\r\n,2.5,z"), "%s", message);
  ck_assert(sheet.rows == 2 && sheet.columns == 3);
  ck_assert_int_eq(ethd__sheet_column(&sheet, "c"), 2);
  ck_assert_int_eq(ethd__sheet_column(&sheet, "d"), -1);
  ck_assert_str_eq(ethd__sheet_cell(&sheet, 0, 1), "x, \"y\"");
  ck_assert_str_eq(ethd__sheet_cell(&sheet, 0, 2), "");
  ck_assert_str_eq(ethd__sheet_cell(&sheet, 1, 2), "z");
  double value;
  ck_assert(ethd__sheet_number(&sheet, 1, 1, &value) && value == 2.5);
  ck_assert(ethd__sheet_number(&sheet, 1, 0, &value) && isnan(value));
  ck_assert(ethd__sheet_number(&sheet, 1, -1, &value) && isnan(value));
  ck_assert(!ethd__sheet_number(&sheet, 1, 2, &value));
  ethd__sheet_free(&sheet);
  ck_assert(!parse("a\n"));
  ck_assert_uint_eq(sheet.rows, 0);
  ethd__sheet_free(&sheet);
  ck_assert(!parse("a,b\n1,"));
  ck_assert_str_eq(ethd__sheet_cell(&sheet, 0, 1), "");
  ethd__sheet_free(&sheet);
}
END_TEST

START_TEST(test_refused_sheets) {
  ck_assert_int_eq(parse(""), ETHD_E_SYNTAX);
  ck_assert_int_eq(parse("a,b\n1\n"), ETHD_E_SYNTAX);
  ck_assert_ptr_nonnull(strstr(message, "x.csv:2: 1 cells, the header has 2"));
  ck_assert_int_eq(parse("a,b\n1,\"2\n"), ETHD_E_SYNTAX);
  ck_assert_ptr_nonnull(strstr(message, "x.csv:2: "));
}
END_TEST

START_TEST(test_mutated_sheets) {
  static const char seed[] = "participant,reason,v\nP01,ok,0.25\nP02,\"too, slow\",\nP03,ok,1e-3\n";
  static const char *const words[] = {",", "\"", "\n", "\"\"", "\r\n", ",,", "nan", NULL};
  static char text[1024];
  for (uint64_t i = 0; i < 50000; i++) {
    size_t n = mutate(seed, sizeof seed - 1, words, i, text, sizeof text);
    if (ethd__sheet_parse(text, n, "x.csv", &sheet, message)) {
      ck_assert(!strncmp(message, "x.csv:", 6));
      continue;
    }
    for (size_t row = 0; row < sheet.rows; row++)
      for (size_t c = 0; c < sheet.columns; c++) ck_assert_ptr_nonnull(ethd__sheet_cell(&sheet, row, (int)c));
    ethd__sheet_free(&sheet);
  }
}
END_TEST

/* R: quantile(c(1, 2, 4, 8), c(.25, .5, .75)) is 1.75 3 5; sd is 3.095696 */
START_TEST(test_summary) {
  double v[] = {8, 1, 4, 2};
  ethd__summary5 s;
  ethd__summarise(v, 4, &s);
  ck_assert_double_eq(s.q1, 1.75);
  ck_assert_double_eq(s.median, 3);
  ck_assert_double_eq(s.q3, 5);
  ck_assert_double_eq(s.min, 1);
  ck_assert_double_eq(s.max, 8);
  ck_assert_double_eq(s.mean, 3.75);
  ck_assert_double_eq_tol(s.sd, 3.0956959368344519, 1e-15);
  ethd__summarise(v, 1, &s);
  ck_assert(isnan(s.sd) && s.median == 1);
  ethd__summarise(v, 0, &s);
  ck_assert(s.n == 0 && isnan(s.mean) && isnan(s.median));
}
END_TEST

/* Two people whose taps agree among themselves: the median of a draw is one of three values. */
START_TEST(test_people_are_drawn_whole) {
  double v[] = {1, 1, 1, 3, 3, 3};
  uint32_t person[] = {0, 0, 0, 1, 1, 1};
  ethd__interval i = ethd__bootstrap_median(v, person, 6, 2, 1);
  ck_assert(i.low == 1 && i.high == 3 && i.people == 2 && i.draws == ETHD_STATS_DRAWS);
  uint32_t one[] = {0, 0, 0, 0, 0, 0};
  i = ethd__bootstrap_median(v, one, 6, 1, 1);
  ck_assert(isnan(i.low) && i.people == 1);
}
END_TEST

/* A crowd of one tap each: the interval covers the true median as often as it says. */
START_TEST(test_coverage) {
  enum { RUNS = 60, N = 41 };
  int covered = 0;
  for (uint64_t run = 0; run < RUNS; run++) {
    double v[N];
    uint32_t person[N];
    for (uint32_t i = 0; i < N; i++) v[i] = draw_normal(run * N + i), person[i] = i;
    ethd__interval in = ethd__bootstrap_median(v, person, N, N, run);
    covered += in.low <= 0 && in.high >= 0;
  }
  ck_assert_int_ge(covered, 52);
  ck_assert_int_lt(covered, RUNS);
}
END_TEST

START_TEST(test_pairs) {
  const double three[] = {1, 2, 3};
  ethd__paired c;
  ethd__compare(three, 3, 1, &c);
  ck_assert(c.n == 3 && c.positive == 3 && c.mean == 2 && c.median == 2 && isnan(c.p));
  ck_assert_double_ge(c.interval.low, 1);
  ck_assert_double_le(c.interval.high, 3);
  const double six[] = {1, 2, 3, 4, 5, 6};
  ethd__compare(six, 6, 1, &c);
  ck_assert_double_eq(c.p, 2.0 / 64);
  const double mixed[] = {1, -1, 2, -2, 3, -3};
  ethd__compare(mixed, 6, 1, &c);
  ck_assert_double_eq(c.p, 1);
  double many[40];
  for (int i = 0; i < 40; i++) many[i] = 1;
  ethd__compare(many, 40, 1, &c);
  ck_assert_double_lt(c.p, 1e-4);
  ethd__compare(three, 0, 1, &c);
  ck_assert(isnan(c.mean) && c.n == 0);
}
END_TEST

START_TEST(test_resampled_nines) {
  double v[400], mean, sd;
  for (uint64_t i = 0; i < 400; i++) v[i] = draw_normal(i);
  ethd__resample(v, 400, 9, 0, 1, 1, &mean, &sd);
  ck_assert_double_gt(mean, 0.5);
  ck_assert_double_gt(sd, 0.3);
  ethd__resample(v, 400, 9, 3, 4, 1, &mean, &sd);
  ck_assert_double_eq(mean, 0);
  ck_assert_double_eq(sd, 0);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("report");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, 120);
  tcase_add_test(all, test_cells);
  tcase_add_test(all, test_refused_sheets);
  tcase_add_test(all, test_mutated_sheets);
  tcase_add_test(all, test_summary);
  tcase_add_test(all, test_people_are_drawn_whole);
  tcase_add_test(all, test_coverage);
  tcase_add_test(all, test_pairs);
  tcase_add_test(all, test_resampled_nines);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
