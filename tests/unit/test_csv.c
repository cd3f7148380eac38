/* CSV files in and out. */
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/csv.h"
#include "text/text.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];
static char folder[] = "/tmp/ethd-csv-XXXXXX", path[64];

static void set_up(void) {
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/x.csv", folder);
}

static void tear_down(void) {
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0); /* nothing else was left behind */
  strcpy(folder, "/tmp/ethd-csv-XXXXXX");
}

static void parse(const char *text, const char *const *wanted, ethd_csv *out) {
  ethd_status status = ethd_csv_parse(text, strlen(text), "x.csv", wanted, out, message);
  ck_assert_msg(status == ETHD_OK, "%s\nrefused: %s", text, message);
}

/* ---- reading ---- */

TEST(test_numbers) {
  ethd_csv c;
  parse("t_s,x_m, y m \r\n0,-1.5,+2e-3\r\n.5,1.,nan\r\n1E+2,,  7\t\r\n", NULL, &c);
  static const double expected[] = {0, -1.5, 2e-3, 0.5, 1, NAN, 100, NAN, 7};
  ck_assert(c.rows == 3 && c.columns == 3);
  for (size_t i = 0; i < 9; i++) ck_assert(isnan(expected[i]) ? isnan(c.values[i]) : c.values[i] == expected[i]);
  ck_assert(ethd_csv_empty(&c, 2, 1) && !ethd_csv_empty(&c, 1, 2) && !ethd_csv_empty(&c, 2, 2));
  ck_assert_int_eq(ethd_csv_column(&c, "x_m"), 1);
  ck_assert_int_eq(ethd_csv_column(&c, "y m"), 2);
  ck_assert_int_eq(ethd_csv_column(&c, "z"), -1);
  ck_assert_uint_eq(ethd_csv_line(2), 4);
  ethd_csv_free(&c);
  parse("a;b\n1,5;-2.5\n", NULL, &c);
  ck_assert(c.rows == 1 && c.columns == 2 && c.values[0] == 1.5 && c.values[1] == -2.5);
  ethd_csv_free(&c);
  parse("a\tb\n\t1,5e3\n", NULL, &c);
  ck_assert(c.rows == 1 && c.columns == 2 && ethd_csv_empty(&c, 0, 0) && c.values[1] == 1500);
  ethd_csv_free(&c);
}

TEST(test_wanted_columns) {
  static const char *const wanted[] = {"b", "absent", "d", NULL};
  ethd_csv c;
  parse("\xef\xbb\xbf"
        "a,b,\"c,c\",d\nword,1,\"x, \"\"y\"\"\",2\ninf,3,,4",
        wanted, &c);
  ck_assert(c.rows == 2 && c.columns == 2);
  ck_assert(ethd_csv_column(&c, "b") == 0 && ethd_csv_column(&c, "d") == 1);
  ck_assert_int_eq(ethd_csv_column(&c, "absent"), -1);
  ck_assert(c.values[0] == 1 && c.values[1] == 2 && c.values[2] == 3 && c.values[3] == 4);
  ethd_csv_free(&c);
  parse("x,b,,x,d,0,\ny,1,,,2,z,\n", wanted, &c); /* others: nameless, alike, numbers */
  ck_assert(c.rows == 1 && c.columns == 2 && c.values[0] == 1 && c.values[1] == 2);
  ethd_csv_free(&c);
  parse("a\n\n1\n", NULL, &c); /* one column: a blank line is an empty cell */
  ck_assert(c.rows == 2 && ethd_csv_empty(&c, 0, 0) && c.values[1] == 1);
  ethd_csv_free(&c);
  parse("a,b\n", NULL, &c);
  ck_assert_uint_eq(c.rows, 0);
  ethd_csv_free(&c);
}

static const struct {
  const char *text, *says;
} bads[] = {
    {"", "x.csv: is empty; a first line that names the columns is needed"},
    {"1,2\n", "x.csv:1: found \"1\", but the first line must name the columns"},
    {"nan\n", "x.csv:1: found \"nan\", but the first line"},
    {"a,,b\n", "x.csv:1: a column without a name"},
    {"a,b,\n", "x.csv:1: a column without a name"},
    {"a,b,a\n", "x.csv:1: the column \"a\" occurs twice"},
    {"a,b\n1,2\n3\n", "x.csv:3: 1 cell, the header names 2 columns"},
    {"a,b\n1,2,3\n", "x.csv:2: 3 cells, the header names 2 columns"},
    {"a,b\n1,2,\n", "x.csv:2: 3 cells"},
    {"a,b\n1,2\n\n3,4\n", "x.csv:3: a blank line"},
    {"a,b\n1,x\n", "x.csv:2: b: found \"x\", a finite decimal number is allowed"},
    {"a,b\n1,inf\n", "x.csv:2: b: found \"inf\""},
    {"a,b\n1,-Inf\n", "x.csv:2: b: found \"-Inf\""},
    {"a,b\n1,0x1p3\n", "x.csv:2: b: found \"0x1p3\""},
    {"a,b\n1,1e999\n", "x.csv:2: b: found \"1e999\""},
    {"a,b\n1,1.5.2\n", "x.csv:2: b: found \"1.5.2\""},
    {"a,b\n1,1 2\n", "x.csv:2: b: found \"1 2\""},
    {"a,b\n1,--1\n", "x.csv:2: b: found \"--1\""},
    {"a,b\n1,\"2\n", "x.csv:2: a quote that isn't closed on its line"},
    {"a,b\n1,\"2\"3\n", "x.csv:2: text after a closing quote"},
    {"a;b\n1,5;2.5\n1,5\n", "x.csv:3: 1 cell"},
    {"a\tb\n1,5,5\t2\n", "x.csv:2: a: found \"1,5,5\""},
};

TEST(test_bad_texts) {
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    ethd_csv c;
    message[0] = 0;
    const char *says = bads[i].says;
    ck_assert_msg(ethd_csv_parse(bads[i].text, strlen(bads[i].text), "x.csv", NULL, &c, message) < 0, "passed: %s",
                  bads[i].text);
    ck_assert_msg(strncmp(message, says, strlen(says)) == 0, "%s\nsays %s", bads[i].text, message);
  }
  ethd_csv c;
  ck_assert_int_lt(ethd_csv_parse("a,b\n1,\0\n", 8, "x.csv", NULL, &c, message), 0);
  ck_assert_str_eq(message, "x.csv:2: a byte 0: this isn't text");
}

TEST(test_files) {
  ethd_csv c;
  ck_assert_int_eq(ethd_csv_read(path, &c, message), ETHD_E_FILE);
  ck_assert(strstr(message, "No such file or directory"));
  ck_assert_int_eq(ethd_csv_read(folder, &c, message), ETHD_E_FILE);
  ck_assert(strstr(message, "is a folder"));
}

/* ---- writing ---- */

TEST(test_round_trip) {
  static const double values[] = {0.1, -0.0, 1e-310, 1.7976931348623157e308, 123456789.123456789, 1.0 / 3};
  ethd_csv_out *out = ethd_csv_create(path, "a,b,c,d", message);
  ck_assert_ptr_nonnull(out);
  for (size_t i = 0; i < 6; i++) {
    ethd_csv_number(out, values[i]);
    ethd_csv_number(out, NAN);
    ethd_csv_integer(out, INT64_MIN);
    ethd_csv_number(out, (double)i);
    ethd_csv_row(out);
  }
  ck_assert_int_ne(access(path, F_OK), 0); /* not there before it is complete */
  ck_assert_int_eq(ethd_csv_close(out, message), ETHD_OK);
  ethd_csv c;
  ck_assert_msg(ethd_csv_read(path, &c, message) == ETHD_OK, "%s", message);
  for (size_t i = 0; i < 6; i++) {
    ck_assert(memcmp(&c.values[4 * i], &values[i], sizeof *values) == 0);
    ck_assert(ethd_csv_empty(&c, i, 1) && c.values[4 * i + 2] == -0x1p63);
  }
  ethd_csv_free(&c);
}

static void check_content(const char *expected) {
  char *text;
  size_t length;
  ck_assert_int_eq(ethd_text_read(path, 1000, &text, &length, message), ETHD_OK);
  ck_assert_str_eq(text, expected);
  free(text);
}

TEST(test_old_file_stays) {
  ck_assert_int_eq(ethd_text_write(path, "old", 3, message), ETHD_OK);
  ethd_csv_out *out = ethd_csv_create(path, "a,b", message);
  ethd_csv_number(out, 1);
  ethd_csv_row(out); /* a cell short */
  ck_assert_int_eq(ethd_csv_close(out, message), ETHD_E_ARGUMENT);
  check_content("old");
  out = ethd_csv_create(path, "a", message);
  ethd_csv_word(out, "say \"a,b\"\n");
  ethd_csv_row(out);
  ethd_csv_abandon(out);
  check_content("old");
  out = ethd_csv_create(path, "a", message);
  ethd_csv_word(out, "say \"a,b\"\n");
  ethd_csv_row(out);
  ck_assert_int_eq(ethd_csv_close(out, message), ETHD_OK);
  check_content("a\n\"say \"\"a,b\"\" \"\n");
}

TEST(test_no_place) {
  ck_assert_ptr_null(ethd_csv_create("/nowhere/x.csv", "a", message));
  ck_assert_str_eq(message, "/nowhere/x.csv: No such file or directory");
  ck_assert_ptr_null(ethd_csv_create(folder, "a", message));
  ck_assert(strstr(message, "is a folder"));
}

/* What isn't a file is written to, not replaced. */
TEST(test_pipe) {
  struct stat info;
  char got[4] = "";
  ck_assert_int_eq(mkfifo(path, 0600), 0);
  int reader = open(path, O_RDWR | O_NONBLOCK);
  ck_assert_int_ge(reader, 0);
  ck_assert_int_eq(ethd_text_write(path, "x", 1, message), ETHD_OK);
  ck_assert_int_eq(read(reader, got, sizeof got), 1);
  ck_assert_int_eq(got[0], 'x');
  ck_assert(lstat(path, &info) == 0 && S_ISFIFO(info.st_mode));
  close(reader);
}

/* No byte more fits: the old file stays, nothing is left beside it. */
TEST(test_no_room) {
  static char big[1 << 20];
  struct rlimit before, none;
  static const char *const sentences[] = {"File too large", "a write failed; is the disk full?"};
  char says[128];
  ck_assert_int_eq(ethd_text_write(path, "old", 3, message), ETHD_OK);
  ck_assert_int_eq(getrlimit(RLIMIT_FSIZE, &before), 0);
  none = before;
  none.rlim_cur = 0;
  signal(SIGXFSZ, SIG_IGN);
  for (size_t length = 1; length <= sizeof big; length *= 1024) { /* small: seen when it is closed */
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &none), 0);
    ethd_status status = ethd_text_write(path, big, length, message);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &before), 0);
    ck_assert_int_eq(status, ETHD_E_FILE);
    snprintf(says, sizeof says, "%s: %s", path, sentences[length > 65536]);
    ck_assert_str_eq(message, says);
    check_content("old");
  }
}

TEST(test_keeps_mode_and_link) {
  char link[80];
  struct stat info;
  snprintf(link, sizeof link, "%s/link", folder);
  ck_assert_int_eq(ethd_text_write(path, "old", 3, message), ETHD_OK);
  ck_assert(chmod(path, 0640) == 0 && symlink("x.csv", link) == 0);
  ck_assert_int_eq(ethd_text_write(link, "new", 3, message), ETHD_OK);
  check_content("new");
  ck_assert(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
  ck_assert(stat(path, &info) == 0 && (info.st_mode & 0777) == 0640);
  unlink(link);
}

TEST(test_number) {
  static const char *const good[] = {"0", "-0", "+1", "1.", ".1", "1e5", "1E-5", "inf", "-INF", "+inf", "nan", "00012"};
  static const char *const bad[] = {"",        "+",   "-",        ".",    "e5",     "1e",      "1e+", "1e5.",
                                    "0x1",     "1f",  "infinity", "-nan", "nan(1)", " 1",      "1 ",  "1_0",
                                    "1e99999", "--1", "+-1",      "inf ", "1,0",    "\xd9\xa1"};
  double value;
  for (size_t i = 0; i < sizeof good / sizeof *good; i++)
    ck_assert_msg(ethd__number(good[i], strlen(good[i]), &value), "%s", good[i]);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    ck_assert_msg(!ethd__number(bad[i], strlen(bad[i]), &value), "%s", bad[i]);
}

FIXTURE(set_up, tear_down)
