#include "text/key.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

ethd_status ethd__key_refuse(const ethd__key *key, ethd_status status, const char *format, ...) {
  char what[ETHD_MESSAGE_MAX];
  va_list args;
  va_start(args, format);
  ethd__say_all(what, format, args);
  va_end(args);
  if (!key->file) return ethd__say(key->message, status, "%s.%s: %s", key->section, key->key, what);
  return ethd__say(key->message, status, "%s:%d: %s.%s: %s", key->file, key->line, key->section, key->key, what);
}

ethd_status ethd__key_found(const ethd__key *key, ethd_status status, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__key_refuse(key, status, "found %s, %s is allowed", ethd__quote(key->value, strlen(key->value), quote),
                          allowed);
}

ethd_status ethd__key_range(const ethd__key *key, const ethd_param *row, bool whole) {
  char allowed[ETHD_MESSAGE_MAX];
  const char *unit = strcmp(row->unit, "1") ? row->unit : "";
  ethd__say(allowed, ETHD_OK, "%s%.10g to %.10g%s%s", whole ? "a whole number from " : "", row->min, row->max,
            *unit ? " " : "", unit);
  return ethd__key_found(key, ETHD_E_RANGE, allowed);
}

ethd_status ethd__key_value(const ethd__key *key, const ethd_param *row, bool whole, double *out) {
  double value;
  if (ethd_param_words(row)) {
    int word = ethd_param_word(row, key->value);
    if (word < 0) return ethd__key_found(key, ETHD_E_UNKNOWN, row->unit);
    *out = word;
    return ETHD_OK;
  }
  if (!ethd__number(key->value, strlen(key->value), &value) || !ethd__is_within(value, row->min, row->max) ||
      (whole && value != rint(value)))
    return ethd__key_range(key, row, whole);
  *out = value;
  return ETHD_OK;
}
