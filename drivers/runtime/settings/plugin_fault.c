#include "settings/plugin_fault.h"

#include <dlfcn.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

#define WORD_MAX 31

/* Quotes a plugin's text, which may be NULL or unterminated. */
static const char *quoted(const char *text, char out[ETHD_QUOTE_MAX]) {
  return text ? ethd__quote(text, strnlen(text, ETHD_QUOTE_MAX), out) : "NULL";
}

/* ---- a row of a table ---- */

#define NAMES "abcdefghijklmnopqrstuvwxyz0123456789_"

static void row_fault(const ethd_param *params, uint32_t i, char *what) {
  const ethd_param *row = &params[i];
  char quote[ETHD_QUOTE_MAX], place[64];
  snprintf(place, sizeof place, "row %u, %s", i + 1,
           ethd__text_is_word(row->name, WORD_MAX, NAMES) ? row->name : "whose name is wrong");
  if (!ethd__text_is_word(row->name, WORD_MAX, NAMES))
    ethd__say(what, ETHD_E_TABLE, "row %u: its name is %s, 1 to %d of a-z 0-9 _ are allowed", i + 1,
              quoted(row->name, quote), WORD_MAX);
  else if (ethd_params_find(params, i, row->name) >= 0)
    ethd__say(what, ETHD_E_TABLE, "%s: an earlier row has that name", place);
  else if (!ethd__text_is_line(row->unit, ETHD_BRIEF_MAX))
    ethd__say(what, ETHD_E_TABLE,
              "%s: its unit is %s, one line of 1 to %d printable characters is allowed (\"1\": none)", place,
              quoted(row->unit, quote), ETHD_BRIEF_MAX);
  else if (!ethd__text_is_line(row->brief, ETHD_BRIEF_MAX))
    ethd__say(what, ETHD_E_TABLE, "%s: its brief is %s, one line of 1 to %d printable characters is allowed", place,
              quoted(row->brief, quote), ETHD_BRIEF_MAX);
  else if (!(isfinite(row->min) && row->min <= row->def && row->def <= row->max))
    ethd__say(what, ETHD_E_TABLE,
              "%s: found min %g, max %g, default %g; min <= default <= max and a finite min are needed", place,
              row->min, row->max, row->def);
  else
    ethd__say(
        what, ETHD_E_TABLE,
        "%s: the words %s with min %g, max %g, default %g; no word may be empty, min is 0, max is one less than the "
        "words, the default is whole",
        place, quoted(row->unit, quote), row->min, row->max, row->def);
}

ethd_status ethd__table_fault(const ethd_param *params, uint32_t count, char what[ETHD_MESSAGE_MAX]) {
  if (count > ETHD_PARAMS_MAX)
    return ethd__say(what, ETHD_E_TABLE, "%u rows, at most %d are allowed", count, ETHD_PARAMS_MAX);
  if (count && !params) return ethd__say(what, ETHD_E_TABLE, "NULL, but %u rows are promised", count);
  for (uint32_t i = 0; i < count; i++) { /* up to the first refused row */
    if (!ethd_params_check_table(params, i + 1, NULL)) continue;
    row_fault(params, i, what);
    return ETHD_E_TABLE;
  }
  return ETHD_OK;
}

/* ---- a law ---- */

static void head_fault(const ethd_law *law, const ethd_error *error, const char *place, char *what) {
  char text[ETHD_MESSAGE_MAX], quote[ETHD_QUOTE_MAX];
  if (error->status == ETHD_E_ABI)
    ethd__say(what, error->status, "%s: its abi is %u, ETHD_ABI is %u: build it with these headers", place, law->abi,
              ETHD_ABI);
  else if (law->kind > ETHD_TRANSITION)
    ethd__say(what, error->status, "%s: its kind is %u, ETHD_TRACKING, ETHD_CONTACT and ETHD_TRANSITION are allowed",
              place, law->kind);
  else if (error->status == ETHD_E_ARGUMENT)
    ethd__say(what, error->status, "%s: its id is %s, 1 to %d of a-z 0-9 - are allowed", place, quoted(law->id, quote),
              WORD_MAX);
  else {
    ethd_error_text(NULL, error, text);
    ethd__say(what, error->status, "%s: %s", place, text);
  }
}

/* A law whose id is good. */
static void law_fault(const ethd_law *law, const ethd_error *error, char *what) {
  char row[ETHD_MESSAGE_MAX], quote[ETHD_QUOTE_MAX];
  if (error->status == ETHD_E_STATE)
    ethd__say(what, error->status, "law %s: its state has %u bytes, at most %d are allowed", law->id, law->state_size,
              ETHD_STATE_MAX);
  else if (error->status == ETHD_E_TABLE && ethd__table_fault(law->params, law->param_count, row))
    ethd__say(what, error->status, "law %s: params: %s", law->id, row);
  else if (error->status == ETHD_E_TABLE)
    ethd__say(what, error->status, "law %s: its gains aren't among its parameters", law->id);
  else if (!ethd__text_is_line(law->brief, ETHD_BRIEF_MAX))
    ethd__say(what, error->status, "law %s: its brief is %s, one line of 1 to %d printable characters is allowed",
              law->id, quoted(law->brief, quote), ETHD_BRIEF_MAX);
  else
    ethd__say(what, error->status, "law %s: it has no step", law->id);
}

static bool is_heads(const ethd_law *law, ethd_status status) {
  return status == ETHD_E_ABI || status == ETHD_E_SIZE || law->kind > ETHD_TRANSITION ||
         !ethd__text_is_word(law->id, WORD_MAX, "abcdefghijklmnopqrstuvwxyz0123456789-");
}

/* ---- the file ---- */

static void entry_fault(const ethd_plugin_entry *entry, const ethd_error *error, char *what) {
  char quote[ETHD_QUOTE_MAX], place[48];
  ethd_error wrong;
  if (!ethd__text_is_line(entry->id, WORD_MAX) || !ethd__text_is_line(entry->version, WORD_MAX)) {
    const bool id = !ethd__text_is_line(entry->id, WORD_MAX);
    ethd__say(what, error->status, "ethd_plugin: its %s is %s, 1 to %d printable characters are allowed",
              id ? "id" : "version", quoted(id ? entry->id : entry->version, quote), WORD_MAX);
    return;
  }
  if (!entry->laws) {
    ethd__say(what, error->status, "ethd_plugin: its laws are NULL");
    return;
  }
  for (uint32_t i = 0; i < entry->law_count; i++) {
    const ethd_law *law = entry->laws[i];
    if (!ethd_law_check(law, &wrong)) continue;
    snprintf(place, sizeof place, "law %u of %u", i + 1, entry->law_count);
    if (!law)
      ethd__say(what, error->status, "%s: NULL", place);
    else if (is_heads(law, wrong.status))
      head_fault(law, &wrong, place, what);
    else
      law_fault(law, &wrong, what);
    return;
  }
  ethd_error_text(NULL, error, what); /* a duplicate law: its name and the sentence suffice */
}

void ethd__plugin_fault(void *handle, const ethd_error *error, char what[ETHD_MESSAGE_MAX]) {
  const ethd_plugin_entry *entry = dlsym(handle, "ethd_plugin");
  if (!entry && dlsym(handle, "ethd_driver_plugin"))
    ethd__say(what, error->status, "a driver, not a plugin with laws: [device] driver = file:NAME.so names it");
  else if (!entry)
    ethd__say(what, error->status, "no plugin: it has no symbol ethd_plugin");
  else if (error->status == ETHD_E_ABI && entry->abi != ETHD_ABI)
    ethd__say(what, error->status,
              "it was built for version %u of the laws' interface, this is version %u: build it with "
              "these headers",
              entry->abi, ETHD_ABI);
  else if (entry->abi == ETHD_ABI && entry->size >= ETHD_PLUGIN_MIN && error->status != ETHD_E_RANGE)
    entry_fault(entry, error, what);
  else
    ethd_error_text(NULL, error, what);
}
