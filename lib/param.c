#include "ethd/param.h"

#include <math.h>
#include <stdbool.h>

#include "error.h"
#include "line.h"

#define NAME_MAX_LENGTH 31

static bool same(const char *a, const char *b) {
  while (*a && *a == *b) a++, b++;
  return *a == *b;
}

static bool is_name(const char *name) {
  size_t n = 0;
  for (; name[n] && n <= NAME_MAX_LENGTH; n++) {
    char c = name[n];
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')) return false;
  }
  return n >= 1 && n <= NAME_MAX_LENGTH;
}

/* Words are joined by '|'; returns the end of the first one. */
static const char *word_end(const char *words) {
  while (*words && *words != '|') words++;
  return words;
}

uint32_t ethd_param_words(const ethd_param *param) {
  uint32_t bars = 0;
  for (const char *end = word_end(param->unit); *end; end = word_end(end + 1)) bars++;
  return bars ? bars + 1 : 0;
}

int ethd_param_word(const ethd_param *param, const char *word) {
  const char *at = param->unit;
  uint32_t count = ethd_param_words(param);
  for (uint32_t i = 0; i < count; i++) {
    const char *end = word_end(at);
    size_t length = (size_t)(end - at), k = 0;
    while (k < length && word[k] == at[k]) k++;
    if (k == length && !word[k]) return (int)i;
    at = end + 1;
  }
  return -1;
}

static bool has_empty_word(const char *words) {
  for (const char *end = word_end(words);; words = end + 1, end = word_end(words)) {
    if (end == words) return true;
    if (!*end) return false;
  }
}

static bool is_whole(const ethd_param *row) { return ethd_param_words(row) || same(row->unit, ETHD_WHOLE); }

static bool is_row(const ethd_param *row) {
  if (!ethd__is_line(row->unit, ETHD_BRIEF_MAX) || !ethd__is_line(row->brief, ETHD_BRIEF_MAX)) return false;
  if (!(isfinite(row->min) && islessequal(row->min, row->def) && islessequal(row->def, row->max))) return false;
  uint32_t words = ethd_param_words(row);
  if (is_whole(row) && row->def != floor(row->def)) return false;
  return !words || (!has_empty_word(row->unit) && row->min == 0 && row->max == words - 1);
}

ethd_status ethd_params_check_table(const ethd_param *params, uint32_t count, ethd_error *error) {
  if (count > ETHD_PARAMS_MAX)
    return ethd__refuse(error, ETHD_E_TABLE, "param_count", (ethd__found){count, 0, ETHD_PARAMS_MAX});
  if (count && !params) return ethd__error(error, ETHD_E_TABLE, "params");
  for (uint32_t i = 0; i < count; i++) {
    const char *name = params[i].name ? params[i].name : "";
    if (!is_name(name) || !is_row(&params[i]) || ethd_params_find(params, i, name) >= 0)
      return ethd__error(error, ETHD_E_TABLE, name);
  }
  return ETHD_OK;
}

ethd_status ethd_params_check(const ethd_param *params, uint32_t count, const double *values, ethd_error *error) {
  for (uint32_t i = 0; i < count; i++) {
    const ethd_param *row = &params[i];
    double v = values[i];
    bool inside = isgreaterequal(v, row->min) && islessequal(v, row->max); /* quiet: NaN takes no trap */
    bool whole = !is_whole(row) || v == floor(v);
    if (inside && whole) continue;
    ethd_status status = isfinite(v) ? ETHD_E_RANGE : ETHD_E_NOT_FINITE;
    return ethd__refuse(error, status, row->name, (ethd__found){v, row->min, row->max});
  }
  return ETHD_OK;
}

void ethd_params_default(const ethd_param *params, uint32_t count, double *values) {
  for (uint32_t i = 0; i < count; i++) values[i] = params[i].def;
}

int ethd_params_find(const ethd_param *params, uint32_t count, const char *name) {
  for (uint32_t i = 0; i < count; i++)
    if (same(params[i].name, name)) return (int)i;
  return -1;
}
