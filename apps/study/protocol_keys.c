#include "study/protocol_keys.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"
#include "text/file_name.h"
#include "text/key.h"
#include "text/text.h"

typedef struct key_row key_row;
struct key_row {
  const char *section, *key;
  ethd_status (*set)(const ethd__entry *e, const key_row *row, void *at);
  size_t offset;
  double min, max;   /* of numbers */
  const char *words; /* of choices: "off|on" */
};

static ethd__key key_of(const ethd__entry *e) { return ethd__key_of(e->file, e->key, e->message); }

ethd_status ethd__entry_refuse(const ethd__entry *e, ethd_status status, const char *format, ...) {
  char what[ETHD_MESSAGE_MAX];
  const ethd__key key = key_of(e);
  va_list args;
  va_start(args, format);
  ethd__say_all(what, format, args);
  va_end(args);
  return ethd__key_refuse(&key, status, "%s", what);
}

static ethd_status found(const ethd__entry *e, const char *allowed) {
  const ethd__key key = key_of(e);
  return ethd__key_found(&key, ETHD_E_RANGE, allowed);
}

/* ---- kinds of values ---- */

static ethd_status read_value(const ethd__entry *e, const key_row *row, const char *unit, double *out) {
  const ethd__key key = key_of(e);
  return ethd__key_value(&key, &(ethd_param){row->key, unit, row->min, row->max, 0, ""}, out);
}

static ethd_status set_number(const ethd__entry *e, const key_row *row, void *at) {
  return read_value(e, row, "1", at);
}

/* Returns false unless the value is digits alone. Read as a double, 3e0 would be a count, and a seed would lose digits. */
static bool read_digits(const ethd__entry *e, uint64_t *out) {
  const char *text = e->key->value;
  errno = 0;
  *out = strtoumax(text, NULL, 10);
  return *text && !text[strspn(text, "0123456789")] && !errno;
}

static ethd_status set_count(const ethd__entry *e, const key_row *row, void *at) {
  char allowed[64];
  uint64_t value;
  snprintf(allowed, sizeof allowed, "a whole number from %.10g to %.10g", row->min, row->max);
  if (!read_digits(e, &value) || !ethd__is_within((double)value, row->min, row->max)) return found(e, allowed);
  *(uint32_t *)at = (uint32_t)value;
  return ETHD_OK;
}

/* An enumeration. */
static ethd_status set_choice(const ethd__entry *e, const key_row *row, void *at) {
  double value = *(unsigned *)at;
  ethd_status status = read_value(e, row, row->words, &value);
  *(unsigned *)at = (unsigned)value;
  return status;
}

static ethd_status set_switch(const ethd__entry *e, const key_row *row, void *at) {
  double value = *(bool *)at;
  ethd_status status = read_value(e, row, row->words, &value);
  *(bool *)at = value > 0;
  return status;
}

static ethd_status set_seed(const ethd__entry *e, const key_row *row, void *at) {
  (void)row;
  return read_digits(e, at) ? ETHD_OK : found(e, "a whole number from 0 to 2^64 - 1");
}

static ethd_status set_text(const ethd__entry *e, const key_row *row, void *at) {
  (void)row;
  free(*(char **)at);
  *(char **)at = strdup(e->key->value);
  return *(char **)at ? ETHD_OK : ethd__entry_refuse(e, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
}

/* The name is used in tables and file names. */
static ethd_status set_name(const ethd__entry *e, const key_row *row, void *at) {
  if (!ethd__file_word(e->key->value)) return found(e, ETHD_FILE_WORD);
  return set_text(e, row, at);
}

void ethd__word_list_free(ethd__word_list *words) {
  for (size_t i = 0; i < words->count; i++) free(words->word[i]);
  words->count = 0;
}

bool ethd__word_list_put(ethd__word_list *words, const char *word, size_t *index) {
  for (*index = 0; *index < words->count; ++*index)
    if (!strcmp(words->word[*index], word)) return true;
  if (words->count == ETHD_STUDY_WORDS || !(words->word[words->count] = strdup(word))) return false;
  words->count++;
  return true;
}

static ethd_status add_word(const ethd__entry *e, ethd__word_list *words, const char *word) {
  for (size_t i = 0; i < words->count; i++)
    if (!strcmp(words->word[i], word)) return ethd__entry_refuse(e, ETHD_E_DUPLICATE, "%s stands there twice", word);
  if (words->count == ETHD_STUDY_WORDS)
    return ethd__entry_refuse(e, ETHD_E_RANGE, "at most %d words are allowed", ETHD_STUDY_WORDS);
  char *copy = strdup(word);
  if (!copy) return ethd__entry_refuse(e, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  words->word[words->count++] = copy;
  return ETHD_OK;
}

static bool is_any(const char *word) { return *word; }

/* Words with the characters of file names; for outcomes, which are checked later, any words. */
static ethd_status set_words(const ethd__entry *e, const key_row *row, void *at) {
  bool (*is_word)(const char *) = row && !strcmp(row->section, "outcomes") ? is_any : ethd__file_word;
  ethd__word_list *words = at;
  ethd_status status = ETHD_OK;
  ETHD__FREED char *list = strdup(e->key->value);
  char *rest = list, *word;
  if (!list) return ethd__entry_refuse(e, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  ethd__word_list_free(words);
  words->line = e->key->line;
  while (!status && (word = strsep(&rest, ","))) {
    word += strspn(word, " \t");
    word[strcspn(word, " \t")] = 0;
    status = is_word(word) ? add_word(e, words, word) : found(e, "word,word.. of letters, digits, _ . + -");
  }
  return status;
}

/* ---- the keys ---- */

#define AT(name) offsetof(ethd__protocol, name)
static const key_row rows[] = {
    {"study", "name", set_name, AT(name), 0, 0, NULL},
    {"study", "seed", set_seed, AT(seed), 0, 0, NULL},
    {"study", "participants", set_count, AT(participants), 1, ETHD_STUDY_PEOPLE, NULL},
    {"study", "strategies", set_words, AT(strategies), 0, 0, NULL},
    {"study", "speeds", set_words, AT(speeds), 0, 0, NULL},
    {"study", "order", set_choice, AT(order), 0, 0, "paper|random|latin|interleaved"},
    {"study", "training", set_count, AT(training), 0, 1000, NULL},
    {"study", "taps", set_count, AT(taps), 1, 100000, NULL},
    {"study", "attempts", set_count, AT(attempts), 1, 1000000, NULL},
    {"study", "survey", set_switch, AT(survey), 0, 0, "off|on"},
    {"study", "rest", set_count, AT(rest), 0, 1000, NULL},
    {"study", "record", set_switch, AT(record), 0, 0, "none|all"},
    {"study", "conditions", set_text, AT(conditions), 0, 0, NULL},
    {"device", "config", set_text, AT(config), 0, 0, NULL},
    {"device", "plant", set_text, AT(plant), 0, 0, NULL},
    {"scene", "file", set_text, AT(scene), 0, 0, NULL},
    {"hand", "source", set_choice, AT(hands), 0, 0, "simulated|recorded|people|mouse"},
    {"hand", "motion", set_text, AT(motion), 0, 0, NULL},
    {"hand", "between", set_number, AT(between), 0, 1, NULL},
    {"hand", "hand_spread", set_number, AT(hand_spread), 0, 1, NULL},
    {"validity", "band_low", set_number, AT(band_low), 0.001, 0.2, NULL},
    {"validity", "band_high", set_number, AT(band_high), 0.001, 0.4, NULL},
    {"validity", "by", set_choice, AT(validity), 0, 0, "paper|finger"},
    {"validity", "graze", set_number, AT(graze), 0, 0.15, NULL},
    {"validity", "slack", set_number, AT(slack), 0, 0.002, NULL},
    {"validity", "lift", set_number, AT(lift), 0.001, 0.1, NULL},
    {"statistics", "margin_d_max", set_number, AT(margin_d_max), 1e-6, 0.1, NULL},
    {"statistics", "margin_v_of", set_number, AT(margin_v_of), 1e-6, 1, NULL},
    {"statistics", "margin_v_rmin", set_number, AT(margin_v_rmin), 1e-6, 1, NULL},
    {"outcomes", "primary", set_words, AT(primary), 0, 0, NULL},
    {"outcomes", "exclusions", set_text, AT(exclusions), 0, 0, NULL},
};
enum { ROWS = sizeof rows / sizeof *rows };

static const key_row *find_row(const char *section, const char *key) {
  for (int i = 0; i < ROWS; i++)
    if (!strcmp(rows[i].section, section) && (!key || !strcmp(rows[i].key, key))) return &rows[i];
  return NULL;
}

static bool has_own_words(const char *section) {
  return ethd__asking_of(section) < ETHD_ASKINGS || !strcmp(section, "pages") || !strcmp(section, "words");
}

static ethd_status set_axis(const ethd__entry *e) {
  ethd__protocol *p = e->out;
  if (p->axis_count == ETHD_STUDY_GAINS)
    return ethd__entry_refuse(e, ETHD_E_RANGE, "at most %d gains are allowed", ETHD_STUDY_GAINS);
  if (!strchr(e->key->key, '.'))
    return ethd__entry_refuse(e, ETHD_E_RANGE, "section.key of a configuration is allowed");
  ethd__axis *axis = &p->axes[p->axis_count++];
  *axis = (ethd__axis){.key = strdup(e->key->key)};
  if (!axis->key) return ethd__entry_refuse(e, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  return set_words(e, NULL, &axis->values);
}

/* The screen draws UTF-8 text from left to right, so other bytes and scripts from right to left are refused. */
static ethd_status check_words(const ethd__entry *e) {
  for (const char *at = e->key->value; *at;) {
    uint32_t letter;
    size_t n = ethd__letter_of(at, &letter);
    if (!n) return ethd__entry_refuse(e, ETHD_E_SYNTAX, "a byte %u that isn't UTF-8", (unsigned char)*at);
    if (ethd__letter_goes_left(letter))
      return ethd__entry_refuse(e, ETHD_E_RANGE,
                                "\"%.*s\" (U+%04X) is written from right to left, which no page can be", (int)n, at,
                                (unsigned)letter);
    at += n;
  }
  return ETHD_OK;
}

/* Only the default phrase's places have values. */
static ethd_status check_places(const ethd__entry *e, const char *instead_of) {
  size_t n = 0;
  const char *place = ethd__phrase_fault(e->key->value, instead_of, &n);
  char quote[ETHD_QUOTE_MAX];
  if (!place) return ETHD_OK;
  return ethd__entry_refuse(e, ETHD_E_RANGE, "found %s; places of \"%s\" are allowed", ethd__quote(place, n, quote),
                            instead_of);
}

static ethd_status add_paragraph(const ethd__entry *e, char **at) {
  char *text = NULL;
  int n = asprintf(&text, "%s%s%s", *at ? *at : "", *at ? "\n" : "", e->key->value);
  if (n < 0) return ethd__entry_refuse(e, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  free(*at);
  *at = text;
  return ETHD_OK;
}

static ethd_status set_own_words(const ethd__entry *e) {
  char **at = ethd__questionnaire_at(&e->out->questionnaire, e->key->section, e->key->key);
  const ethd__asking when = ethd__asking_of(e->key->section);
  bool asked = when < ETHD_ASKINGS, phrase = !strcmp(e->key->section, "words"), page = !asked && !phrase;
  if (!at)
    return ethd__entry_refuse(e, ETHD_E_UNKNOWN, "no key of this section; %s are allowed",
                              asked    ? "q1 to q9, q1_answers to q9_answers"
                              : phrase ? "those that ethd-study --words prints"
                                       : "consent1 to consent99, instruction1 to instruction99");
  size_t length = strlen(e->key->value);
  if (!page && length > ETHD_STUDY_WORDS_MAX)
    return ethd__entry_refuse(e, ETHD_E_RANGE, "%zu bytes; at most %d are allowed, any number in [pages]", length,
                              ETHD_STUDY_WORDS_MAX);
  ethd_status status = check_words(e);
  if (!status && phrase) status = check_places(e, ethd__phrases[at - e->out->questionnaire.phrase].words);
  if (asked) e->out->questionnaire.question[when][e->key->key[1] - '1'].line = e->key->line;
  return status ? status : page ? add_paragraph(e, at) : set_text(e, NULL, at);
}

static ethd_status unknown_key(const ethd__entry *e) {
  char list[ETHD_MESSAGE_MAX] = "";
  for (int i = 0; i < ROWS; i++)
    if (!strcmp(rows[i].section, e->key->section)) ethd__list_add(list, rows[i].key);
  return ethd__entry_refuse(e, ETHD_E_UNKNOWN, "no key of this section; %s are allowed", list);
}

ethd_status ethd__entry_set(const ethd__entry *e) {
  if (!strcmp(e->key->section, "grid")) return set_axis(e);
  if (has_own_words(e->key->section)) return set_own_words(e);
  const key_row *row = find_row(e->key->section, e->key->key);
  return row ? row->set(e, row, (char *)e->out + row->offset) : unknown_key(e);
}

bool ethd__entry_section(const char *section) {
  return !strcmp(section, "grid") || has_own_words(section) || find_row(section, NULL);
}
