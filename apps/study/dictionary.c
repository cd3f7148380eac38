#include "study/dictionary.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/ethd.h"

const ethd__question ethd__paper_questions[3] = {
    {(char *)"When did you feel the touch, beside the moment at which the circle reached the wall on the screen?",
     (char *)"well before | a little before | just then | a little after | well after", 0},
    {(char *)"What did the wall do as you touched it?",
     (char *)"moved clearly to the left | moved slightly to the left | stood still | moved slightly to the right | "
             "moved clearly to the right",
     0},
    {(char *)"How did the touch feel?", (char *)"very natural | natural | neither | unnatural | very unnatural", 0},
};

static const char files[] =
    "# What is in this folder\n\n"
    "A tapping study with an encounter-type haptic display, as ethd-study ran it. SI units, unless a column's\n"
    "name says otherwise; an empty cell: not defined, or not asked. Participants are numbers, nothing else.\n\n"
    "| file | holds |\n|---|---|\n"
    "| study.ini | the study file as it was read |\n"
    "| config.ini, scene.scene | the controller's configuration and walls |\n"
    "| conditions.csv | the conditions, when the study has a table of them |\n"
    "| device.plant | the simulated device and finger: plausible, fitted, not measured |\n"
    "| movement.csv | the recorded movement, when all hands follow one |\n"
    "| movements/ | the recorded movements, when hands follow several |\n"
    "| device.folder | with people in a device: where relative paths of its settings start |\n"
    "| versions.txt | program, compiler, and the hash of all files above but device.folder |\n"
    "| taps.csv | a row per tap, training too |\n"
    "| survey.csv | a row per participant and cell; simulated participants answer nothing |\n"
    "| events.csv | begin, display, consent, pauses, notes, what stopped a device and that somebody saw to it, end |\n"
    "| participants.csv | a row per participant: how far, who led the hand, whether the taps belong to the "
    "analysis, and what was asked once |\n"
    "| orders.csv | the order that was planned for each participant, as ethd-study --plan prints it |\n"
    "| taps.json and so on | what each column of a table is, with units and levels, for programs |\n"
    "| dataset_description.json | what this is and what made it |\n"
    "| study.sqlite | what happened, in order, a transaction each; the tables above are written from it, at the end of "
    "each "
    "sitting and by ethd-study --export; it needs a local disk |\n"
    "| taps/P01-03-004 | participant, block, attempt: every tick of that tap |\n"
    "| shard-i-of-n.sqlite | of a simulation: the rows of one worker; study.sqlite is all of them, merged |\n"
    "| SHA256SUMS | sums of all files, for ethd-study --verify or sha256sum -c |\n\n"
    "`ethd-report .` draws and counts; `ethd-study --resume .` goes on with a session.\n\n";

static const char behind[] =
    "n points into the wall; speeds are > 0 toward it. The haptic delay is t_of_s - t_seen_s: > 0, the touch is\n"
    "felt after it is seen.\n\n";

static const char ticks[] =
    "## A tap's folder\n\n"
    "tick.npy has a row per tick: what the controller read and what it answered. truth.npy has the same ticks as\n"
    "the simulated device knows them; with people's fingers in a device there is no such knowledge, and it has what\n"
    "the controller saw: the ring by its encoders, finger and hand by the finger's filter, the pad touching from\n"
    "validity.slack before the ring on, its force never (NaN). Both are NumPy structured arrays. config.ini, "
    "scene.scene and events.csv\n"
    "say how to repeat them: `ethd-replay --verify taps/P01-03-004` compares every field bit for bit.\n";

/* ---- for people: README.md ---- */

static void describe_gains(FILE *file, const ethd__table_scope *scope) {
  for (size_t i = 0; i < scope->protocol->axis_count; i++) {
    ethd_setup_key key;
    const ethd_param *gain = ethd__gain_of(scope->setup, scope->protocol->axes[i].key, &key);
    fprintf(file, "| %s | %s | this gain at the point%s%s |\n", scope->protocol->axes[i].key, gain ? gain->unit : "",
            gain ? ": " : "", gain ? gain->brief : "");
  }
}

static void describe(FILE *file, ethd__columns columns) {
  for (size_t i = 0; i < columns.count; i++)
    fprintf(file, "| %s | %s | %s |\n", columns.row[i].name, columns.row[i].unit, columns.row[i].meaning);
}

static void describe_question(void *file, const char *column, const ethd__question *q) {
  char words[256];
  fprintf(file, "| %s | | %s%s", column, q->text, ethd__question_is_text(q) ? " In words." : "");
  for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
    ethd__answer_words(q, k, words, sizeof words);
    fprintf(file, "%s %d %s", k > 1 ? ";" : "", k, words);
  }
  fputs(" |\n", file);
}

/* Writes rows of a Markdown table: column, unit, meaning. */
static void describe_table(FILE *file, ethd__study_table table, const ethd__table_scope *scope) {
  fputs("| column | unit | meaning |\n|---|---|---|\n", file);
  describe(file, ethd__columns_first(table, scope));
  describe(file, ethd__columns_of(table));
  if (ethd__is_simulated(table, scope)) describe_gains(file, scope);
  ethd__columns_asked(table, scope->protocol, file, describe_question);
}

char *ethd__dictionary(const ethd__table_scope *scope) {
  ethd__printed text;
  FILE *file = ethd__print_begin(&text);
  fputs(files, file);
  for (int i = 0; i < ETHD_TABLES; i++) {
    fprintf(file, "## %s.csv\n\n", ethd__table_names[i]);
    describe_table(file, (ethd__study_table)i, scope);
    putc('\n', file);
    if (i == ETHD_TABLE_TAPS) fputs(behind, file);
  }
  fputs(ticks, file);
  return ethd__print_end(&text);
}

/* ---- for programs: JSON ---- */

static void set(json_t *object, const char *key, json_t *value) {
  if (json_object_set_new(object, key, value)) ethd__fail_memory();
}

/* A column's contents; unit "", levels NULL: none. */
static json_t *entry(const char *meaning, const char *unit, json_t *levels) {
  return json_pack("{s:s, s:o*, s:o*}", "Description", meaning, "Units", *unit ? json_string(unit) : NULL, "Levels",
                   levels);
}

static json_t *levels_of(const char *levels) {
  json_t *out = json_object();
  for (const char *at = levels; *at;) {
    size_t n = strcspn(at, "|"), name = strcspn(at, "=");
    char key[24];
    snprintf(key, sizeof key, "%.*s", (int)name, at);
    set(out, key, json_stringn(at + name + 1, n - name - 1));
    at += n + (at[n] == '|');
  }
  return out;
}

/* The words that a study file lists for a column, each with its meaning between `before` and `after`. */
static json_t *levels_of_words(const ethd__word_list *list, const char *before, const char *after) {
  json_t *out = json_object();
  for (size_t i = 0; i < list->count; i++) {
    const char *word = list->word[i];
    bool low = !strcmp(word, "low"), high = !strcmp(word, "high");
    set(out, word, json_sprintf("%s%s%s", before, low ? "about 0.2" : high ? "about 0.4" : word, after));
  }
  return out;
}

static void put_question(void *sidecar, const char *column, const ethd__question *q) {
  json_t *levels = ethd__question_is_text(q) ? NULL : json_object();
  char words[256], number[12];
  for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
    ethd__answer_words(q, k, words, sizeof words);
    snprintf(number, sizeof number, "%d", k);
    set(levels, number, json_string(words));
  }
  set(sidecar, column, entry(q->text, "", levels));
}

static void put_columns(json_t *sidecar, ethd__columns columns, const ethd__protocol *p) {
  for (const ethd__column *c = columns.row; c < columns.row + columns.count; c++) {
    json_t *levels = c->levels                        ? levels_of(c->levels)
                     : !strcmp(c->name, "transition") ? levels_of_words(&p->strategies, "the transition law ", "")
                     : !strcmp(c->name, "speed")      ? levels_of_words(&p->speeds, "", " m/s")
                                                      : NULL;
    set(sidecar, c->name, entry(c->meaning, c->unit, levels));
  }
}

static void put_gain(json_t *sidecar, const ethd__axis *axis, const ethd_setup *setup) {
  ethd_setup_key key;
  const ethd_param *gain = ethd__gain_of(setup, axis->key, &key);
  char meaning[2 * ETHD_BRIEF_MAX];
  snprintf(meaning, sizeof meaning, "this gain at the point%s%s", gain ? ": " : "", gain ? gain->brief : "");
  set(sidecar, axis->key, entry(meaning, gain ? gain->unit : "", levels_of_words(&axis->values, "the value ", "")));
}

static char *text_of(json_t *json) {
  char *text = json_dumps(json, JSON_INDENT(2));
  json_decref(json);
  return text;
}

char *ethd__table_sidecar(ethd__study_table table, const ethd__table_scope *scope) {
  const ethd__protocol *p = scope->protocol;
  json_t *sidecar = json_object();
  put_columns(sidecar, ethd__columns_first(table, scope), p);
  put_columns(sidecar, ethd__columns_of(table), p);
  for (size_t i = 0; ethd__is_simulated(table, scope) && i < p->axis_count; i++)
    put_gain(sidecar, &p->axes[i], scope->setup);
  ethd__columns_asked(table, p, sidecar, put_question);
  return text_of(sidecar);
}

char *ethd__dataset_describe(const ethd__protocol *p) {
  return text_of(
      json_pack("{s:s, s:s, s:s, s:[{s:s, s:s}]}", "Name", p->name, "DatasetType", "raw", "Description",
                "A tapping study with an encounter-type haptic display. The sidecars follow BIDS; the tables are CSV.",
                "GeneratedBy", "Name", "libethd", "Version", ETHD_VERSION));
}
