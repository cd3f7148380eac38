/* Sheets of words, and the taps in them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "report/data.h"
#include "report/sheet.h"
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
  ck_assert_ptr_nonnull(strstr(message, "x.csv:2: 1 cell, the header has 2"));
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

/* ---- how long the reading takes ---- */

/* A table of so many participants at so many points, a tap each. */
static void write_taps(const char *path, int points, int people) {
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  fputs("point,participant,part,transition,speed,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,delta_s_ms,eps_m,"
        "t_rvo_s,t_of_s,t_seen_s,peak_force_n,finger_radius_m,commanded_mps\n",
        out);
  for (int point = 0; point < points; point++)
    for (int person = 0; person < people; person++)
      fprintf(out, "%d,P%06d,test,offset,low,1,ok,0.2,0.1,0.001,-0.1,5,0.001,0.1,0.2,0.2,20,0.007,0.2\n", point,
              person);
  ck_assert_int_eq(fclose(out), 0);
}

/* CPU time of all points, s. */
static double time_of(const char *path, size_t points, size_t people) {
  const ethd_plant plant = {.speed_low = 0.2, .speed_high = 0.4, .band_low = 0.06, .band_high = 0.08};
  ethd__data whole, at;
  clock_t start = clock();
  ck_assert_msg(!ethd__data_read(path, &plant, 0, &whole, message), "%s", message);
  ck_assert(whole.points == points && whole.people_count == people && whole.group[0].cell.count == people);
  for (size_t point = 1; point < points; point++) {
    ck_assert_msg(!ethd__data_at(&whole, &plant, point, &at, message), "%s", message);
    ck_assert(at.people_count == people && at.group_count == 1 && at.group[0].cell.person[people - 1] == people - 1);
    ethd__data_free(&at);
  }
  ethd__data_free(&whole);
  return (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* 1x and 8x in each direction: a look at all others for every participant, or at all rows for every point, would take
   64 times as long. */
START_TEST(test_time_is_linear) {
  static const int sizes[][2][2] = {{{1, 6000}, {1, 48000}}, {{500, 4}, {4000, 4}}};
  char path[] = "/tmp/ethd-report-XXXXXX";
  double took[2] = {INFINITY, INFINITY};
  close(mkstemp(path));
  for (size_t way = 0; way < 2; way++) {
    for (int k = 0; k < 2; k++) {
      int points = sizes[way][k][0], people = sizes[way][k][1];
      took[k] = INFINITY;
      write_taps(path, points, people);
      for (int i = 0; i < 3; i++) took[k] = fmin(took[k], time_of(path, (size_t)points, (size_t)people));
    }
    ck_assert_msg(took[1] < 24 * took[0], "way %zu: 8 times the rows took %.3g s, not %.3g s", way, took[1],
                  8 * took[0]);
  }
  unlink(path);
}
END_TEST

START_TEST(test_points_stand_in_any_order) {
  const ethd_plant plant = {.speed_low = 0.2, .band_low = 0.06};
  char path[] = "/tmp/ethd-report-XXXXXX", command[256];
  ethd__data whole, at;
  close(mkstemp(path));
  write_taps(path, 3, 5);
  snprintf(command, sizeof command, "{ head -n 1 %s; tail -n +2 %s | tac; } >%s.x && mv %s.x %s", path, path, path,
           path, path);
  ck_assert_int_eq(system(command), 0);
  ck_assert(!ethd__data_read(path, &plant, 1, &whole, message));
  ck_assert(whole.points == 3 && whole.people_count == 5);
  ck_assert_str_eq(whole.people[0], "P000004");
  ck_assert(!ethd__data_at(&whole, &plant, 2, &at, message));
  ck_assert_uint_eq(at.group[0].cell.count, 5);
  ck_assert_uint_eq(at.group[0].row[0], 0);
  ethd__data_free(&at);
  ck_assert_int_eq(ethd__data_at(&whole, &plant, 3, &at, message), ETHD_E_RANGE);
  ethd__data_free(&whole);
  unlink(path);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("report");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, 120);
  tcase_add_test(all, test_cells);
  tcase_add_test(all, test_refused_sheets);
  tcase_add_test(all, test_mutated_sheets);
  tcase_add_test(all, test_time_is_linear);
  tcase_add_test(all, test_points_stand_in_any_order);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
