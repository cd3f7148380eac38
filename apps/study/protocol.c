#include "study/protocol.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/order.h"
#include "study/protocol_keys.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- the file ---- */

static ethd_status defaults(ethd__protocol *p) {
  static const struct {
    const char *key, *value;
  } text[] = {{"name", "study"}, {"strategies", "smooth,offset"}, {"speeds", "low,high"}};
  char unsaid[ETHD_MESSAGE_MAX];
  *p = (ethd__protocol){.seed = 1,
                        .participants = 3,
                        .training = 2,
                        .taps = 3,
                        .rest = 3,
                        .attempts = 40,
                        .record = true,
                        .between = 0.5,
                        .hand_spread = 0.15,
                        .band_low = NAN,
                        .band_high = NAN,
                        .graze = 0.02,
                        .lift = 0.005,
                        .slack = 0.0004,
                        .margin_d_max = 0.3e-3,
                        .margin_v_of = 0.02,
                        .margin_v_rmin = 0.02};
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
    ethd_ini_key key = {(char *)"study", (char *)text[i].key, (char *)text[i].value, 0};
    const ethd__entry e = {"the defaults", &key, p, unsaid};
    if (ethd__entry_set(&e)) return ETHD_E_MEMORY;
  }
  return ETHD_OK;
}

static ethd_status known_sections(const ethd_ini *ini, const char *name, char *message) {
  char quote[ETHD_QUOTE_MAX];
  for (uint32_t i = 0; i < ini->section_count; i++) {
    const ethd_ini_section *s = &ini->sections[i];
    if (!ethd__entry_section(s->name))
      return ethd__say(message, ETHD_E_UNKNOWN,
                       "%s:%d: %s: unknown section; study, device, scene, hand, validity, statistics, outcomes, "
                       "before, survey, after, "
                       "pages, words, grid are allowed",
                       name, s->line, ethd__quote(s->name, strlen(s->name), quote));
  }
  return ETHD_OK;
}

/* Checks that a questionnaire is complete and that study.survey is on for it. */
static ethd_status check_questions(const ethd__entry *last, const ethd__protocol *p) {
  const char *what;
  char name[24];
  const ethd__question *fault = ethd__questionnaire_fault(&p->questionnaire, &what, name);
  if (!fault && (!p->questionnaire.own || p->survey)) return ETHD_OK;
  if (fault) return ethd__say(last->message, ETHD_E_RANGE, "%s:%d: %s: %s", last->file, fault->line, name, what);
  return ethd__say(last->message, ETHD_E_RANGE, "%s:%d: survey.q1: stands there without study.survey = on", last->file,
                   p->questionnaire.question[ETHD_ASK_BLOCK][0].line);
}

/* Whether the word is FIGURE:STRATEGY-STRATEGY:SPEED of this study. */
static bool is_outcome(const ethd__protocol *p, const char *word) {
  static const char *const figures[] = {"v_rvo", "v_of",       "d_max",  "v_rmin",      "delta_s", "eps",
                                        "delay", "peak_force", "v_hand", "touch_depth", "eps_felt"};
  for (size_t f = 0; f < sizeof figures / sizeof *figures; f++)
    for (size_t i = 0; i < p->strategies.count * p->strategies.count * p->speeds.count; i++) {
      char text[128];
      size_t a = i % p->strategies.count, b = i / p->strategies.count % p->strategies.count;
      snprintf(text, sizeof text, "%s:%s-%s:%s", figures[f], p->strategies.word[a], p->strategies.word[b],
               p->speeds.word[i / p->strategies.count / p->strategies.count]);
      if (a != b && !strcmp(text, word)) return true;
    }
  return false;
}

/* Checks the study's conditions. */
static ethd_status check_conditions(const ethd__protocol *p, char *message) {
  size_t trials = p->condition_count * (size_t)p->taps + p->speeds.count;
  if (p->order == ETHD_ORDER_INTERLEAVED && trials > ETHD_STUDY_BLOCKS)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: study.order: %zu interleaved trials and trainings; at most %d are allowed", p->path, trials,
                     ETHD_STUDY_BLOCKS);
  for (size_t i = 0; i < p->primary.count; i++) {
    char quote[ETHD_QUOTE_MAX];
    const char *word = p->primary.word[i];
    if (!is_outcome(p, word))
      return ethd__say(message, ETHD_E_UNKNOWN,
                       "%s:%d: outcomes.primary: found %s, FIGURE:STRATEGY-STRATEGY:SPEED of this study is allowed; "
                       "figures are v_rvo, v_of, d_max, v_rmin, delta_s, eps, delay, peak_force, v_hand, touch_depth, "
                       "eps_felt",
                       p->path, p->primary.line, ethd__quote(word, strlen(word), quote));
  }
  return ETHD_OK;
}

/* Checks the relations between keys. */
static ethd_status check(const ethd_ini *ini, const ethd__entry *last, ethd__protocol *p) {
  const ethd_ini_key *attempts = ethd_ini_find(ini, "study", "attempts"), *taps = ethd_ini_find(ini, "study", "taps");
  const ethd_ini_key *motion = ethd_ini_find(ini, "hand", "motion");
  ethd__entry e = *last;
  e.key = attempts ? attempts : taps;
  if (p->attempts < p->taps && !attempts) p->attempts = 40 * p->taps / 3;
  if (p->attempts < p->taps)
    return ethd__entry_refuse(&e, ETHD_E_RANGE,
                              "%" PRIu32 " attempts can't make %" PRIu32 " valid taps; at least as many are allowed",
                              p->attempts, p->taps);
  e.key = ethd_ini_find(ini, "study", "conditions");
  if (p->conditions && (p->strategies.line || p->speeds.line))
    return ethd__entry_refuse(&e, ETHD_E_RANGE, "stands there beside study.strategies or study.speeds");
  e.key = motion;
  if (motion && p->hands != ETHD_HANDS_RECORDED)
    return ethd__entry_refuse(&e, ETHD_E_RANGE, "stands there without source = recorded");
  for (size_t i = 0, points = 1; i < p->axis_count; i++) {
    points *= p->axes[i].values.count;
    e.key = ethd_ini_find(ini, "grid", p->axes[i].key);
    if (points > ETHD_STUDY_POINTS)
      return ethd__entry_refuse(&e, ETHD_E_RANGE, "over %u combinations in the grid", ETHD_STUDY_POINTS);
  }
  return ETHD_OK;
}

static ethd_status fill(const ethd_ini *ini, const char *name, ethd__protocol *p, char *message) {
  ethd_status status = known_sections(ini, name, message);
  ethd__entry e = {name, NULL, p, message};
  for (uint32_t i = 0; !status && i < ini->count; i++) {
    e.key = &ini->keys[i];
    status = ethd__entry_set(&e);
  }
  if (!status && !ethd__questionnaire_fill(&p->questionnaire)) status = ethd__no_memory(message, name);
  if (!status) status = check_questions(&e, p);
  if (!status) status = check(ini, &e, p);
  if (status || p->conditions) return status;
  for (size_t i = 0; i < p->strategies.count * p->speeds.count; i++)
    p->condition[p->condition_count++] = (ethd__condition){i % p->strategies.count, i / p->strategies.count, 0};
  return check_conditions(p, message);
}

ethd_status ethd__protocol_parse(const char *text, size_t length, const char *name, const char *folder,
                                 ethd__protocol *out, char message[ETHD_MESSAGE_MAX]) {
  ethd_ini ini;
  *out = (ethd__protocol){0};
  ethd_status status = ethd_ini_parse(text, length, name, NULL, " before survey after pages words ", &ini, message);
  if (status) return status;
  status = defaults(out);
  out->path = strdup(name);
  out->text = strndup(text, length);
  out->folder = strdup(folder);
  if (status || !out->path || !out->text || !out->folder)
    status = ethd__no_memory(message, name);
  else
    status = fill(&ini, name, out, message);
  ethd_ini_free(&ini);
  if (status) ethd__protocol_free(out);
  return status;
}

ethd_status ethd__protocol_load(const char *path, ethd__protocol *out, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *text = NULL, *folder = ethd__path_folder(path);
  size_t length;
  *out = (ethd__protocol){0};
  ethd_status status = ethd_text_read(path, ETHD_STUDY_TEXT_MAX, &text, &length, message);
  if (!status && !folder) status = ethd__no_memory(message, path);
  return status ? status : ethd__protocol_parse(text, length, path, folder, out, message);
}

/* ---- the file of conditions ---- */

static ethd_status add_condition(ethd__protocol *p, const ethd_csv *csv, size_t row, char *message) {
  char *const *cells = &csv->words[row * csv->columns];
  ethd__condition c = {.line = ethd_csv_line(row)};
  if (!ethd__word_list_put(&p->strategies, cells[ethd_csv_column(csv, "transition")], &c.strategy) ||
      !ethd__word_list_put(&p->speeds, cells[ethd_csv_column(csv, "speed")], &c.speed))
    return ethd__say(message, ETHD_E_RANGE, "%s:%zu: over %d strategies or speeds", csv->path, c.line,
                     ETHD_STUDY_WORDS);
  for (size_t i = 0; i < p->condition_count; i++)
    if (p->condition[i].strategy == c.strategy && p->condition[i].speed == c.speed)
      return ethd__say(message, ETHD_E_DUPLICATE, "%s:%zu: the condition of row %zu again; study.taps says how often",
                       csv->path, c.line, p->condition[i].line);
  p->condition[p->condition_count++] = c;
  return ETHD_OK;
}

static ethd_status take_conditions(ethd__protocol *p, const ethd_csv *csv, char *message) {
  ethd_status status = ETHD_OK;
  char quote[ETHD_QUOTE_MAX];
  for (size_t i = 0; i < csv->columns; i++)
    if (strcmp(csv->names[i], "transition") && strcmp(csv->names[i], "speed"))
      return ethd__say(message, ETHD_E_UNKNOWN, "%s:1: found the column %s; transition and speed are allowed",
                       csv->path, ethd__quote(csv->names[i], strlen(csv->names[i]), quote));
  if (csv->columns < 2 || !csv->rows)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s:%d: columns transition and speed, and a row for each condition are needed", csv->path,
                     csv->columns < 2 ? 1 : 2);
  ethd__word_list_free(&p->strategies);
  ethd__word_list_free(&p->speeds);
  for (size_t row = 0; !status && row < csv->rows; row++) status = add_condition(p, csv, row, message);
  return status ? status : check_conditions(p, message);
}

ethd_status ethd__protocol_conditions(ethd__protocol *p, const char *path, char message[ETHD_MESSAGE_MAX]) {
  ethd_csv csv;
  if (!p->conditions) return ETHD_OK;
  ethd_status status = ethd_csv_read_words(path, &csv, message);
  if (status) return status;
  p->condition_path = strdup(path);
  status = p->condition_path ? take_conditions(p, &csv, message) : ethd__no_memory(message, path);
  ethd_csv_free(&csv);
  return status;
}

void ethd__protocol_free(ethd__protocol *p) {
  char *own[] = {p->path,  p->text,   p->folder,     p->name,       p->config,        p->plant,
                 p->scene, p->motion, p->exclusions, p->conditions, p->condition_path};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) free(own[i]);
  ethd__word_list_free(&p->strategies);
  ethd__word_list_free(&p->speeds);
  ethd__word_list_free(&p->primary);
  ethd__questionnaire_free(&p->questionnaire);
  for (size_t i = 0; i < p->axis_count; i++) {
    free(p->axes[i].key);
    ethd__word_list_free(&p->axes[i].values);
  }
  *p = (ethd__protocol){0};
}

void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]) {
  int digits = 2;
  for (uint32_t n = protocol->participants; n > 99; n /= 10) digits++;
  snprintf(out, ETHD_STUDY_ID_MAX, "P%0*" PRIu32, digits, person + 1);
}

/* ---- the grid ---- */

size_t ethd__protocol_points(const ethd__protocol *p) {
  size_t points = 1;
  for (size_t i = 0; i < p->axis_count; i++) points *= p->axes[i].values.count;
  return points;
}

const char *ethd__protocol_value(const ethd__protocol *p, size_t point, size_t axis) {
  for (size_t i = p->axis_count - 1; i > axis; i--) point /= p->axes[i].values.count;
  return p->axes[axis].values.word[point % p->axes[axis].values.count];
}
