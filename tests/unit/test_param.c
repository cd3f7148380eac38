/* Parameter tables and sentences of statuses. */
#include <math.h>
#include <string.h>

#include "ethd/param.h"
#include "unit/suite.h"

static const ethd_param good[] = {
    {"k_e", "N/m", 0, 1e6, 2500, "stiffness"},
    {"eps_max", "m", 0, INFINITY, 0.006, "cap"},
    {"derivative", "velocity|difference|none", 0, 2, 1, "of what"},
};

TEST(test_good_table) {
  ethd_error error;
  ck_assert_int_eq(ethd_params_check_table(good, 3, &error), ETHD_OK);
  ck_assert_int_eq(ethd_params_check_table(NULL, 0, NULL), ETHD_OK);
}

typedef struct bad {
  ethd_param row;
  const char *why;
} bad;

static const bad bads[] = {
    {{NULL, "1", 0, 1, 0, "b"}, "no name"},
    {{"", "1", 0, 1, 0, "b"}, "empty name"},
    {{"K", "1", 0, 1, 0, "b"}, "capital"},
    {{"a b", "1", 0, 1, 0, "b"}, "space"},
    {{"a-b", "1", 0, 1, 0, "b"}, "hyphen"},
    {{"a2345678901234567890123456789012", "1", 0, 1, 0, "b"}, "32 characters"},
    {{"x", NULL, 0, 1, 0, "b"}, "no unit"},
    {{"x", "", 0, 1, 0, "b"}, "empty unit"},
    {{"x", "1", 0, 1, 0, NULL}, "no brief"},
    {{"x", "1", 0, 1, 0, ""}, "empty brief"},
    {{"x", "1", NAN, 1, 0, "b"}, "NaN min"},
    {{"x", "1", 0, NAN, 0, "b"}, "NaN max"},
    {{"x", "1", 0, 1, NAN, "b"}, "NaN default"},
    {{"x", "1", -INFINITY, 1, 0, "b"}, "infinite min"},
    {{"x", "1", 0, 1, 2, "b"}, "default over max"},
    {{"x", "1", 0, 1, -1, "b"}, "default under min"},
    {{"x", "1", 1, 0, 1, "b"}, "max under min"},
    {{"x", "a|b", 0, 2, 0, "b"}, "max is not words - 1"},
    {{"x", "a|b", 1, 1, 1, "b"}, "min is not 0"},
    {{"x", "a|b", 0, 1, 0.5, "b"}, "default between words"},
    {{"x", "a||b", 0, 2, 0, "b"}, "empty word"},
    {{"x", "a|", 0, 1, 0, "b"}, "empty last word"},
    {{"x", "|a", 0, 1, 0, "b"}, "empty first word"},
    {{"k_e", "1", 0, 1, 0, "b"}, "a name twice"},
};

TEST(test_bad_tables) {
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    ethd_param table[2] = {good[0], bads[i].row};
    ethd_error error;
    ck_assert_msg(ethd_params_check_table(table, 2, &error) == ETHD_E_TABLE, "%s passed", bads[i].why);
    const char *name = bads[i].row.name ? bads[i].row.name : "";
    ck_assert_int_eq(error.status, ETHD_E_TABLE);
    ck_assert_int_eq(strncmp(error.name, name, sizeof error.name - 1), 0);
    ck_assert_int_eq(ethd_params_check_table(table, 2, NULL), ETHD_E_TABLE);
  }
  ethd_param many[ETHD_PARAMS_MAX + 1];
  char names[ETHD_PARAMS_MAX + 1][4] = {{0}};
  for (int i = 0; i <= ETHD_PARAMS_MAX; i++) {
    names[i][0] = (char)('a' + i);
    many[i] = (ethd_param){names[i], "1", 0, 1, 0, "b"};
  }
  ck_assert_int_eq(ethd_params_check_table(many, ETHD_PARAMS_MAX, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_params_check_table(many, ETHD_PARAMS_MAX + 1, NULL), ETHD_E_TABLE);
  ck_assert_int_eq(ethd_params_check_table(NULL, 1, NULL), ETHD_E_TABLE);
}

static ethd_status check_one(int row, double value, ethd_error *error) {
  double values[3];
  ethd_params_default(good, 3, values);
  values[row] = value;
  return ethd_params_check(good, 3, values, error);
}

TEST(test_values) {
  static const struct {
    int row;
    double value;
    ethd_status status;
  } cases[] = {
      {0, 0, ETHD_OK},
      {0, 1e6, ETHD_OK},
      {0, -1e-9, ETHD_E_RANGE},
      {0, 1.0000001e6, ETHD_E_RANGE},
      {0, NAN, ETHD_E_NOT_FINITE},
      {0, INFINITY, ETHD_E_NOT_FINITE},
      {0, -INFINITY, ETHD_E_NOT_FINITE},
      {1, INFINITY, ETHD_OK},
      {1, -INFINITY, ETHD_E_NOT_FINITE},
      {1, NAN, ETHD_E_NOT_FINITE},
      {2, 2, ETHD_OK},
      {2, 1.5, ETHD_E_RANGE},
      {2, 3, ETHD_E_RANGE},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    ethd_error error = {.status = ETHD_OK};
    int row = cases[i].row;
    ck_assert_int_eq(check_one(row, cases[i].value, &error), cases[i].status);
    if (!cases[i].status) continue;
    ck_assert_int_eq(error.status, cases[i].status);
    ck_assert_str_eq(error.name, good[row].name);
    ck_assert(error.min == good[row].min && error.max == good[row].max);
    ck_assert(error.found == cases[i].value || (isnan(error.found) && isnan(cases[i].value)));
  }
}

TEST(test_defaults_and_names) {
  double values[4] = {-1, -1, -1, -7};
  ethd_params_default(good, 3, values);
  ck_assert(values[0] == 2500 && values[1] == 0.006 && values[2] == 1 && values[3] == -7);
  ck_assert_int_eq(ethd_params_find(good, 3, "derivative"), 2);
  ck_assert_int_eq(ethd_params_find(good, 2, "derivative"), -1);
  ck_assert_int_eq(ethd_params_find(good, 3, "k_"), -1);
  ck_assert_int_eq(ethd_params_find(good, 3, "k_e2"), -1);
  ck_assert_int_eq(ethd_params_find(good, 3, ""), -1);
}

TEST(test_words) {
  ck_assert_uint_eq(ethd_param_words(&good[0]), 0);
  ck_assert_uint_eq(ethd_param_words(&good[2]), 3);
  ck_assert_int_eq(ethd_param_word(&good[2], "velocity"), 0);
  ck_assert_int_eq(ethd_param_word(&good[2], "difference"), 1);
  ck_assert_int_eq(ethd_param_word(&good[2], "none"), 2);
  ck_assert_int_eq(ethd_param_word(&good[2], "velo"), -1);
  ck_assert_int_eq(ethd_param_word(&good[2], "velocity|difference"), -1);
  ck_assert_int_eq(ethd_param_word(&good[2], "nones"), -1);
  ck_assert_int_eq(ethd_param_word(&good[2], ""), -1);
  ck_assert_int_eq(ethd_param_word(&good[0], "N/m"), -1);
}

TEST(test_sentences) {
  int names = 0;
  for (int s = -40; s <= 10; s++) {
    const char *sentence = ethd_status_sentence((ethd_status)s);
    ck_assert_ptr_nonnull(sentence);
    names += strcmp(sentence, "an unknown status") != 0;
    for (int t = -40; t < s; t++) {
      const char *other = ethd_status_sentence((ethd_status)t);
      ck_assert(strcmp(sentence, "an unknown status") == 0 || strcmp(sentence, other) != 0);
    }
  }
#define COUNT(name, value, sentence) +1
  ck_assert_int_eq(names, 0 ETHD_STATUSES(COUNT));
  ck_assert_str_eq(ethd_status_sentence(ETHD_E_RANGE), "a value is out of its range");
}
