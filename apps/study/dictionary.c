#include "study/dictionary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "ethd/ethd.h"

#define QUESTION_1 "When did you feel the touch, beside the moment at which the circle reached the wall on the screen?"
#define ANSWERS_1 "well before | a little before | just then | a little after | well after"
#define QUESTION_2 "What did the wall do as you touched it?"
#define ANSWERS_2                                                                                         \
  "moved clearly to the left | moved slightly to the left | stood still | moved slightly to the right | " \
  "moved clearly to the right"
#define QUESTION_3 "How did the touch feel?"
#define ANSWERS_3 "very natural | natural | neither | unnatural | very unnatural"

const ethd__question ethd__paper_questions[3] = {
    {(char *)QUESTION_1, (char *)ANSWERS_1, 0},
    {(char *)QUESTION_2, (char *)ANSWERS_2, 0},
    {(char *)QUESTION_3, (char *)ANSWERS_3, 0},
};

const char *const ethd__questions[3] = {QUESTION_1 " 1 to 5: " ANSWERS_1, QUESTION_2 " 1 to 5: " ANSWERS_2,
                                        QUESTION_3 " 1 to 5: " ANSWERS_3};

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

static void describe_question(FILE *file, const char *column, const ethd__question *q) {
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
  char *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) return NULL;
  fputs(files, file);
  for (int i = 0; i < ETHD_TABLES; i++) {
    fprintf(file, "## %s.csv\n\n", ethd__table_names[i]);
    describe_table(file, (ethd__study_table)i, scope);
    putc('\n', file);
    if (i == ETHD_TABLE_TAPS) fputs(behind, file);
  }
  fputs(ticks, file);
  bool failed = ferror(file);
  if (!fclose(file) && !failed) return text;
  free(text);
  return NULL;
}

/* ---- for programs: JSON ---- */

static void put_levels(FILE *file, const char *levels) {
  fputs(",\n    \"Levels\": {", file);
  for (const char *at = levels; *at;) {
    size_t n = strcspn(at, "|"), name = strcspn(at, "=");
    fputs(at == levels ? "\n      " : ",\n      ", file);
    ethd__json_string(file, at, name);
    fputs(": ", file);
    ethd__json_string(file, at + name + 1, n - name - 1);
    at += n + (at[n] == '|');
  }
  fputs("\n    }", file);
}

static void put_question(FILE *file, const char *column, const ethd__question *q) {
  char words[256];
  fprintf(file, ",\n  \"%s\": {\n    \"Description\": ", column);
  ethd__json_word(file, q->text);
  if (ethd__question_is_text(q)) {
    fputs("\n  }", file);
    return;
  }
  fputs(",\n    \"Levels\": {", file);
  for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
    ethd__answer_words(q, k, words, sizeof words);
    fprintf(file, "%s\n      \"%d\": ", k > 1 ? "," : "", k);
    ethd__json_word(file, words);
  }
  fputs("\n    }\n  }", file);
}

/* Prints the words that a study file lists for a column, each with its meaning between `before` and `after`. */
static void put_words(FILE *file, const ethd__word_list *list, const char *before, const char *after) {
  fputs(",\n    \"Levels\": {", file);
  for (size_t i = 0; i < list->count; i++) {
    const char *word = list->word[i];
    bool low = !strcmp(word, "low"), high = !strcmp(word, "high");
    fprintf(file, "%s\n      \"%s\": \"%s%s%s\"", i ? "," : "", word, before,
            low    ? "about 0.2"
            : high ? "about 0.4"
                   : word,
            after);
  }
  fputs("\n    }", file);
}

static void put_column(FILE *file, const ethd__column *c, const ethd__protocol *p, const char *between) {
  fprintf(file, "%s\n  \"%s\": {\n    \"Description\": ", between, c->name);
  ethd__json_word(file, c->meaning);
  if (*c->unit) {
    fputs(",\n    \"Units\": ", file);
    ethd__json_word(file, c->unit);
  }
  if (c->levels) put_levels(file, c->levels);
  if (!strcmp(c->name, "transition")) put_words(file, &p->strategies, "the transition law ", "");
  if (!strcmp(c->name, "speed")) put_words(file, &p->speeds, "", " m/s");
  fputs("\n  }", file);
}

static void put_gain(FILE *file, const ethd__axis *axis, const ethd_setup *setup) {
  ethd_setup_key key;
  const ethd_param *gain = ethd__gain_of(setup, axis->key, &key);
  char meaning[2 * ETHD_BRIEF_MAX];
  snprintf(meaning, sizeof meaning, "this gain at the point%s%s", gain ? ": " : "", gain ? gain->brief : "");
  fputs(",\n  ", file);
  ethd__json_word(file, axis->key);
  fputs(": {\n    \"Description\": ", file);
  ethd__json_word(file, meaning);
  if (gain) {
    fputs(",\n    \"Units\": ", file);
    ethd__json_word(file, gain->unit);
  }
  put_words(file, &axis->values, "the value ", "");
  fputs("\n  }", file);
}

void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__table_scope *scope) {
  const ethd__protocol *p = scope->protocol;
  const ethd__columns part[2] = {ethd__columns_first(table, scope), ethd__columns_of(table)};
  const char *between = "";
  putc('{', file);
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < part[k].count; i++, between = ",") put_column(file, &part[k].row[i], p, between);
  for (size_t i = 0; ethd__is_simulated(table, scope) && i < p->axis_count; i++)
    put_gain(file, &p->axes[i], scope->setup);
  ethd__columns_asked(table, p, file, put_question);
  fputs("\n}\n", file);
}

void ethd__dataset_describe(FILE *file, const ethd__protocol *p) {
  fputs("{\n  \"Name\": ", file);
  ethd__json_word(file, p->name);
  fputs(
      ",\n  \"DatasetType\": \"raw\",\n  \"Description\": \"A tapping study with an encounter-type haptic display. The "
      "sidecars follow BIDS; the tables are CSV.\",\n  \"GeneratedBy\": [{\"Name\": \"libethd\", \"Version\": ",
      file);
  ethd__json_word(file, ETHD_VERSION);
  fputs("}]\n}\n", file);
}
