/* Journals that were cut, damaged, flipped: what was written whole is read whole, nothing else. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/journal.h"
#include "text/text.h"
#include "unit/rig.h"

static char folder[] = "/tmp/ethd-journal-XXXXXX", path[64], message[ETHD_MESSAGE_MAX];
static ethd__journal journal;

static void setup(void) {
  strcpy(folder + strlen(folder) - 6, "XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/journal", folder);
}

static void teardown(void) {
  unlink(path);
  rmdir(folder);
}

static void append(const char *kind, const char *text) {
  ck_assert_msg(!ethd__journal_append(&journal, kind, text, message), "%s", message);
}

static void write_three(void) {
  ck_assert_msg(!ethd__journal_create(path, &journal, message), "%s", message);
  append("begin", "hash 12");
  append("tap", "P01,1,test,1,#,x y");
  append("event", ",P01,1,note,\"a, b\"");
  ethd__journal_close(&journal);
}

static void whole(char **text, size_t *length) {
  ck_assert_msg(!ethd_text_read(path, 1 << 20, text, length, message), "%s", message);
}

static void put(const char *text, size_t length) {
  ck_assert_msg(!ethd_text_write(path, text, length, message), "%s", message);
}

START_TEST(test_lines_come_back) {
  write_three();
  ck_assert_msg(!ethd__journal_open(path, &journal, message), "%s", message);
  ck_assert_uint_eq(journal.count, 3);
  ck_assert(!journal.cut);
  ck_assert_str_eq(journal.lines[1].kind, "tap");
  ck_assert_str_eq(journal.lines[1].text, "P01,1,test,1,#,x y");
  append("tap", "more");
  ethd__journal_close(&journal);
  ck_assert_msg(!ethd__journal_read(path, &journal, message), "%s", message);
  ck_assert_uint_eq(journal.count, 4);
  ethd__journal_close(&journal);
}
END_TEST

/* Cut anywhere: the lines before are there, the next one is appended behind them. */
START_TEST(test_cut_anywhere) {
  char *text;
  size_t length;
  write_three();
  whole(&text, &length);
  for (size_t n = 0; n <= length; n++) {
    size_t lines = 0;
    for (size_t i = 0; i < n; i++) lines += text[i] == '\n';
    put(text, n);
    ck_assert_msg(!ethd__journal_open(path, &journal, message), "%zu: %s", n, message);
    ck_assert_uint_eq(journal.count, lines);
    ck_assert_int_eq(journal.cut, n > 0 && text[n - 1] != '\n');
    append("tap", "next");
    ethd__journal_close(&journal);
    ck_assert_msg(!ethd__journal_read(path, &journal, message), "%zu: %s", n, message);
    ck_assert_uint_eq(journal.count, lines + 1);
    ck_assert_str_eq(journal.lines[lines].text, "next");
    ethd__journal_close(&journal);
  }
  free(text);
}
END_TEST

/* A bit of any byte: of the last line, it is cut off; before it, the file is refused as it is. */
START_TEST(test_flipped_anywhere) {
  char *text, *after;
  size_t length, left, last;
  write_three();
  whole(&text, &length);
  for (last = length - 1; text[last - 1] != '\n'; last--) continue;
  for (size_t i = 0; i < length; i++) {
    text[i] ^= 1;
    put(text, length);
    ethd_status status = ethd__journal_open(path, &journal, message);
    if (i + 1 < last) {
      ck_assert_int_eq(status, ETHD_E_SYNTAX);
      whole(&after, &left);
      ck_assert(left == length && !memcmp(after, text, length));
      free(after);
    } else if (!status) {
      ck_assert_uint_le(journal.count, 2);
      ethd__journal_close(&journal);
    }
    text[i] ^= 1;
  }
  free(text);
}
END_TEST

START_TEST(test_one_at_a_time) {
  ethd__journal other;
  write_three();
  ck_assert_int_eq(ethd__journal_create(path, &other, message), ETHD_E_FILE);
  ck_assert_msg(!ethd__journal_open(path, &journal, message), "%s", message);
  ck_assert_int_eq(ethd__journal_open(path, &other, message), ETHD_E_FILE);
  ck_assert_ptr_nonnull(strstr(message, "another program"));
  ck_assert(!ethd__journal_read(path, &other, message));
  ethd__journal_close(&other);
  ethd__journal_close(&journal);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("journal");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, 120);
  tcase_add_checked_fixture(all, setup, teardown);
  tcase_add_test(all, test_lines_come_back);
  tcase_add_test(all, test_cut_anywhere);
  tcase_add_test(all, test_flipped_anywhere);
  tcase_add_test(all, test_one_at_a_time);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
