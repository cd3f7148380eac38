/* What a search for gains keeps: each point's score once, whole lines alone, and in time linear in the file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "tune/journal.h"
#include "unit/rig.h"

static char message[ETHD_MESSAGE_MAX];
static char folder[64], path[128];

static void begin(void) {
  strcpy(folder, "/tmp/ethd-tune-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/scores-1-of-2.csv", folder);
}

static void end(void) {
  char command[160];
  snprintf(command, sizeof command, "rm -r %s", folder);
  ck_assert_int_eq(system(command), 0);
}

static void put_row(FILE *out, unsigned round, unsigned number, double first) {
  fprintf(out, "%u,%u,%.17g", round, number, first);
  for (size_t i = 1; i < ETHD_TUNE_FIGURE_COUNT; i++) fprintf(out, ",%zu", i);
  putc('\n', out);
}

static FILE *make_file(void) {
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  fputs("round,number", out);
  for (size_t i = 0; i < ETHD_TUNE_FIGURE_COUNT; i++) fprintf(out, ",%s", ethd__tune_figure_names[i]);
  putc('\n', out);
  return out;
}

static double first_of(const ethd__tune_score *score) {
  double first;
  ck_assert_ptr_nonnull(score);
  memcpy(&first, score, sizeof first);
  return first;
}

START_TEST(test_rows) {
  ethd__tune_journal j;
  begin();
  FILE *out = make_file();
  put_row(out, 0, 4, 0.5);
  put_row(out, 1, 4, 1.5);
  put_row(out, 0, 4, 7.5); /* a point that came twice keeps its first score */
  put_row(out, 0, 0, 2.5);
  fputs("0,2,1", out); /* cut where its process was ended */
  ck_assert_int_eq(fclose(out), 0);
  ck_assert_msg(!ethd__tune_journal_open(folder, "what", 1, 2, &j, message), "%s", message);
  ck_assert(first_of(ethd__tune_journal_find(&j, 0, 4)) == 0.5 && first_of(ethd__tune_journal_find(&j, 1, 4)) == 1.5);
  ck_assert(first_of(ethd__tune_journal_find(&j, 0, 0)) == 2.5);
  ck_assert_ptr_null(ethd__tune_journal_find(&j, 0, 2));
  ck_assert_ptr_null(ethd__tune_journal_find(&j, 4, 0));
  ethd__tune_score score;
  memset(&score, 0, sizeof score);
  ck_assert(!ethd__tune_journal_add(&j, 0, 2, &score, message));
  ck_assert(first_of(ethd__tune_journal_find(&j, 0, 2)) == 0);
  ethd__tune_journal_close(&j);
  ck_assert(!ethd__tune_journal_open(folder, "what", 1, 2, &j, message));
  ck_assert(first_of(ethd__tune_journal_find(&j, 0, 2)) == 0 && first_of(ethd__tune_journal_find(&j, 0, 4)) == 0.5);
  ethd__tune_journal_close(&j);
  end();
}
END_TEST

START_TEST(test_refused) {
  static const char *const rows[] = {"-1,0", "0,-1", "nan,0", "0,nan", "4294967295,0", "0,1e300"};
  begin();
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    ethd__tune_journal j;
    FILE *out = make_file();
    fputs(rows[i], out);
    for (size_t k = 0; k < ETHD_TUNE_FIGURE_COUNT; k++) fputs(",1", out);
    putc('\n', out);
    ck_assert_int_eq(fclose(out), 0);
    ck_assert_int_eq(ethd__tune_journal_open(folder, "what", 1, 2, &j, message), ETHD_E_SYNTAX);
    ck_assert_msg(strstr(message, "scores-1-of-2.csv:2: no score"), "%s", message);
    ethd__tune_journal_close(&j);
  }
  end();
}
END_TEST

/* CPU time of reading so many rows and finding each, s. */
static double time_of(unsigned rows) {
  ethd__tune_journal j;
  FILE *out = make_file();
  for (unsigned i = 0; i < rows; i++) put_row(out, i % 4, i / 4 * 7919 % (rows / 4), i);
  ck_assert_int_eq(fclose(out), 0);
  clock_t start = clock();
  ck_assert_msg(!ethd__tune_journal_open(folder, "what", 1, 2, &j, message), "%s", message);
  for (unsigned i = 0; i < rows; i++)
    ck_assert(first_of(ethd__tune_journal_find(&j, i % 4, i / 4 * 7919 % (rows / 4))) == i);
  ethd__tune_journal_close(&j);
  return (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* 8 times the rows: a look at all others for each would take 64 times as long. */
START_TEST(test_time_is_linear) {
  double took[2] = {INFINITY, INFINITY};
  begin();
  for (int i = 0; i < 3; i++) {
    took[0] = fmin(took[0], time_of(8000));
    took[1] = fmin(took[1], time_of(64000));
  }
  end();
  ck_assert_msg(took[1] < 24 * took[0], "8 times the rows took %.3g s, not %.3g s", took[1], 8 * took[0]);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("tune journal");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, 120);
  tcase_add_test(all, test_rows);
  tcase_add_test(all, test_refused);
  tcase_add_test(all, test_time_is_linear);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
