#include "study/columns.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/json.h"
#include "ethd/ethd.h"

/* levels: "word=what it means|..", NULL where a column has none. */
typedef struct study_column {
  const char *name, *unit, *meaning, *levels;
} study_column;

const char *const ethd__table_names[ETHD_TABLES] = {"taps", "survey", "events", "participants", "orders"};

#define PARTICIPANT {"participant", "", "P01, P02, ..", NULL}
#define BLOCK   \
  {"block", "", \
   "of the participant, from 1: a strategy at a speed, one trial of it in an interleaved order, or a training", NULL}
#define PART {"part", "", "training or test", "training=isn't analysed|test=is"}
#define HANDS                                                                                                  \
  "device=a person's finger in the device's ring|mouse=a person's pointer, which leads the simulated device's" \
  " hand|simulated=the plant's synthetic hand|recorded=a recorded movement"

/* These stand before the columns of taps in a simulation. */
static const study_column simulation[] = {
    {"study", "", "the first 12 digits of the study's hash, as versions.txt has it", NULL},
    {"point", "", "which combination of the grid, from 0; the last gain runs fastest", NULL},
};

#define REASONS                                                                                                     \
  "ok=valid|fault=the device stopped itself|early-contact=the finger touched before the ring met the wall; by the " \
  "finger's validity, before it stood at the wall or behind it|too-slow=below the band|too-fast=above the "         \
  "band|no-contact=the wall wasn't met or touched|grazing=touched too shortly|double=left the wall and came back"

static const study_column taps[] = {
    PARTICIPANT,
    BLOCK,
    PART,
    {"attempt", "", "within the block, from 1", NULL},
    {"transition", "", "the strategy", NULL},
    {"speed", "", "low, high, or m/s", NULL},
    {"seed", "", "key of the simulated finger's random numbers", NULL},
    {"tap", "", "likewise", NULL},
    {"valid", "", "whether the tap counts", "1=it does|0=it doesn't; reason says why"},
    {"reason", "", "why a tap doesn't count; ok where it does", REASONS},
    {"v_rvo_mps", "m/s", "the ring's speed along n as it meets the wall (first tick with d_re < 0)", NULL},
    {"v_of_mps", "m/s", "the ring's speed as the finger's pad first touches it after that, between two ticks", NULL},
    {"d_max_m", "m",
     "first rebound: the ring's first maximum along n minus the minimum after it, each once it has turned by 0.1 mm",
     NULL},
    {"v_rmin_mps", "m/s",
     "the ring's smallest speed at the ticks of the 0.1 s after the touch; < 0: away from the wall", NULL},
    {"delta_s_ms", "ms",
     "first braking tick to first vo tick; only strategies that brake once the ring is in the wall have it", NULL},
    {"eps_m", "m", "how far the wall was moved", NULL},
    {"t_rvo_s", "s", "of the tap: the ring meets the wall", NULL},
    {"t_of_s", "s", "of the tap: the pad touches the ring", NULL},
    {"t_seen_s", "s", "of the tap: the finger's front reaches the wall, which a screen without delay shows", NULL},
    {"peak_force_n", "N", "the largest rendered force", NULL},
    {"finger_radius_m", "m", "the finger's radius in this tap", NULL},
    {"commanded_mps", "m/s", "the speed that was drawn for this tap, or asked of a person", NULL},
    {"v_hand_mps", "m/s",
     "the hand's own speed as its path crosses the plane at which a finger touches the wall; of people in a device the "
     "finger's before the touch, carried on",
     NULL},
    {"touch_depth_m", "m", "how far the ring is behind the wall at the touch", NULL},
    {"eps_felt_m", "m", "the wall's offset 60 ms after the touch", NULL},
    {"hand", "", "who led the hand", HANDS},
    {"movement", "", "the recorded movement, a file in movements/, or movement.csv", NULL},
    {"utc", "", "when a person's tap began, UTC; simulated taps have no clock", NULL},
    {"by_ring", "", "why the tap doesn't count by the paper's validity, which judges the ring; ok where it does",
     REASONS},
    {"by_finger", "", "the same by the finger's validity, which judges hand and finger whatever the strategy", REASONS},
    {"checked", "", "what the experimenter, who looked at a valid tap, did with it; events.csv says why",
     "accepted=the tap was looked at, and stays|rejected=the tap doesn't count"},
};
static const study_column survey[] = {
    PARTICIPANT, BLOCK, {"transition", "", "the strategy", NULL}, {"speed", "", "low, high, or m/s", NULL}};
static const study_column events[] = {
    {"utc", "", "when, UTC; simulated sessions have no clock", NULL},
    PARTICIPANT,
    BLOCK,
    {"attempt", "", "of the tap that was accepted or rejected", NULL},
    {"event", "", "what happened",
     "open=the program began|screen=the window and its display|consent=the participant agreed|refuse=the participant "
     "didn't agree|pause=a pause began|note=somebody's words|abort=the participant wanted no more|undo=the abort was a "
     "mistake|withdraw=the participant withdrew|exclude=the experimenter took the participant out of the analysis|"
     "include=the experimenter put the participant back|fault=the device stopped itself|acknowledged=somebody has seen "
     "to it|accept=the experimenter accepted a valid tap|reject=the experimenter rejected it|uncheck=this was taken "
     "back|"
     "merged=from here on another station's|wish to stop=somebody "
     "ended the program|stop=the program ended|over=everything was done"},
    {"detail", "", "words for people, never read back but as a reason", NULL},
};
static const study_column participants[] = {
    PARTICIPANT,
    {"status", "", "how far the participant has come",
     "complete=every block is done|incomplete=blocks are missing|aborted=wanted no more|refused=did not agree to take "
     "part|withdrawn=withdrew|excluded=taken out by the experimenter"},
    {"analysed", "", "whether the taps belong to the analysis", "1=they do|0=they stay on record and leave it"},
    {"reason", "", "of whoever aborted, withdrew, excluded or included", NULL},
    {"hand", "", "who led the hand", HANDS},
    {"taps", "", "test taps", NULL},
    {"valid", "", "of which valid, and not rejected", NULL},
    {"accepted", "", "of which the experimenter accepted", NULL},
    {"rejected", "", "valid ones that the experimenter rejected", NULL},
    {"first_utc", "", "the first tap's begin", NULL},
    {"last_utc", "", "the last tap's begin", NULL},
};
static const study_column orders[] = {
    PARTICIPANT, BLOCK, PART, {"transition", "", "the strategy", NULL}, {"speed", "", "low, high, or m/s", NULL}};

#define ROWS(table) {table, sizeof table / sizeof *table}
static const struct {
  const study_column *row;
  size_t count;
} tables[ETHD_TABLES] = {ROWS(taps), ROWS(survey), ROWS(events), ROWS(participants), ROWS(orders)};

/* Calls `each` for the questions whose answers stand in the table. */
static void each_question(ethd__study_table table, const ethd__protocol *p, FILE *file,
                          void (*each)(FILE *file, const char *column, const ethd__question *q)) {
  for (int when = 0; when < ETHD_ASKINGS; when++) {
    const ethd__question *list = p->questionnaire.question[when];
    if (table != (when == ETHD_ASK_BLOCK ? ETHD_TABLE_SURVEY : ETHD_TABLE_PARTICIPANTS)) continue;
    for (size_t i = 0; i < ethd__question_count(list); i++) {
      char column[24];
      snprintf(column, sizeof column, "%sq%zu", ethd__asking_columns[when], i + 1);
      each(file, column, &list[i]);
    }
  }
}

static void put_name(FILE *file, const char *column, const ethd__question *q) {
  (void)q;
  fprintf(file, ",%s", column);
}

/* Whether the table belongs to a simulation, which has more columns. */
static bool is_simulated(ethd__study_table table, const ethd__table_scope *scope) {
  return table == ETHD_TABLE_TAPS && scope->setup;
}

char *ethd__simulation_header(const ethd__protocol *p) {
  char *text = NULL, *header = ethd__table_header(ETHD_TABLE_TAPS, p);
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) ethd__fail_memory();
  for (size_t i = 0; i < sizeof simulation / sizeof *simulation; i++) fprintf(file, "%s,", simulation[i].name);
  fputs(header, file);
  for (size_t i = 0; i < p->axis_count; i++) fprintf(file, ",%s", p->axes[i].key);
  bool failed = ferror(file);
  if (fclose(file) || failed) ethd__fail_memory();
  free(header);
  return text;
}

/* The gain of that name; NULL where the configuration's own laws don't have it, because it belongs to another
   strategy. */
static const ethd_param *gain_of(const ethd_setup *setup, const char *name, ethd_setup_key *key) {
  for (uint32_t i = 0; !ethd_setup_key_at(setup, i, key); i++) {
    char full[96];
    snprintf(full, sizeof full, "%s.%s", key->section, key->param.name);
    if (!strcmp(full, name)) return &key->param;
  }
  return NULL;
}

char *ethd__table_header(ethd__study_table table, const ethd__protocol *protocol) {
  char *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) ethd__fail_memory();
  for (size_t i = 0; i < tables[table].count; i++) fprintf(file, "%s%s", i ? "," : "", tables[table].row[i].name);
  each_question(table, protocol, file, put_name);
  bool failed = ferror(file);
  if (fclose(file) || failed) ethd__fail_memory();
  return text;
}

/* ---- for people ---- */

static void describe_gains(FILE *file, const ethd__table_scope *scope) {
  for (size_t i = 0; i < scope->protocol->axis_count; i++) {
    ethd_setup_key key;
    const ethd_param *gain = gain_of(scope->setup, scope->protocol->axes[i].key, &key);
    fprintf(file, "| %s | %s | this gain at the point%s%s |\n", scope->protocol->axes[i].key, gain ? gain->unit : "",
            gain ? ": " : "", gain ? gain->brief : "");
  }
}

static void describe(FILE *file, const study_column *columns, size_t count) {
  for (size_t i = 0; i < count; i++)
    fprintf(file, "| %s | %s | %s |\n", columns[i].name, columns[i].unit, columns[i].meaning);
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

void ethd__table_describe(FILE *file, ethd__study_table table, const ethd__table_scope *scope) {
  fputs("| column | unit | meaning |\n|---|---|---|\n", file);
  if (is_simulated(table, scope)) describe(file, simulation, sizeof simulation / sizeof *simulation);
  describe(file, tables[table].row, tables[table].count);
  if (is_simulated(table, scope)) describe_gains(file, scope);
  each_question(table, scope->protocol, file, describe_question);
}

/* ---- for programs ---- */

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

static void put_column(FILE *file, const study_column *c, const ethd__protocol *p, const char *between) {
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
  const ethd_param *gain = gain_of(setup, axis->key, &key);
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
  size_t before = is_simulated(table, scope) ? sizeof simulation / sizeof *simulation : 0;
  putc('{', file);
  for (size_t i = 0; i < before; i++) put_column(file, &simulation[i], p, i ? "," : "");
  for (size_t i = 0; i < tables[table].count; i++) put_column(file, &tables[table].row[i], p, before || i ? "," : "");
  for (size_t i = 0; before && i < p->axis_count; i++) put_gain(file, &p->axes[i], scope->setup);
  each_question(table, p, file, put_question);
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
