#include "study/columns.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/ethd.h"

/* levels: "word=what it means|..", NULL where a column has none. */
typedef struct study_column {
  const char *name, *unit, *meaning, *levels;
} study_column;

const char *const ethd__table_names[ETHD_TABLES] = {"taps", "survey", "events", "participants", "orders"};

#define PARTICIPANT {"participant", "", "P01, P02, ..", NULL}
#define BLOCK {"block", "", "of the participant, from 1: a strategy at a speed, or a training", NULL}
#define PART {"part", "", "training or test", "training=isn't analysed|test=is"}
#define HANDS                                                                                                  \
  "device=a person's finger in the device's ring|mouse=a person's pointer, which leads the simulated device's" \
  " hand|simulated=the plant's synthetic hand|recorded=a recorded movement"

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
    {"reason", "", "why a tap doesn't count; ok where it does",
     "ok=valid|fault=the device stopped itself|early-contact=the finger touched before the ring met the "
     "wall|too-slow=below "
     "the band|too-fast=above the band|no-contact=the wall wasn't met or touched|grazing=touched too "
     "shortly|double=left "
     "the wall and came back"},
    {"v_rvo_mps", "m/s", "the ring's speed along n as it meets the wall (first tick with d_re < 0)", NULL},
    {"v_of_mps", "m/s", "the ring's speed as the finger's pad first touches it after that", NULL},
    {"d_max_m", "m", "first rebound: the ring's first maximum along n minus the minimum after it", NULL},
    {"v_rmin_mps", "m/s", "the ring's smallest speed in the 0.1 s after the touch; < 0: away from the wall", NULL},
    {"delta_s_ms", "ms", "first braking tick to first vo tick; only strategies that brake have it", NULL},
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
};
static const study_column survey[] = {
    PARTICIPANT, BLOCK, {"transition", "", "the strategy", NULL}, {"speed", "", "low, high, or m/s", NULL}};
static const study_column events[] = {
    {"utc", "", "when, UTC; simulated sessions have no clock", NULL},
    PARTICIPANT,
    BLOCK,
    {"event", "", "what happened",
     "open=the program began|screen=the window and its display|consent=the participant agreed|refuse=the participant "
     "didn't agree|pause=a pause began|note=somebody's words|abort=the participant wanted no more|undo=the abort was a "
     "mistake|withdraw=the participant withdrew|exclude=the experimenter took the participant out of the analysis|"
     "include=the experimenter put the participant back|fault=the device stopped itself|acknowledged=somebody has seen "
     "to it|cut=a line that a crash had torn was cut off|merged=from here on another station's|wish to stop=somebody "
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
    {"valid", "", "of which valid", NULL},
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

static size_t questions_of(ethd__study_table table, const ethd__protocol *p) {
  return table == ETHD_TABLE_SURVEY ? ethd__question_count(&p->questionnaire) : 0;
}

char *ethd__table_header(ethd__study_table table, const ethd__protocol *protocol) {
  char *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) ethd__fail_memory();
  for (size_t i = 0; i < tables[table].count; i++) fprintf(file, "%s%s", i ? "," : "", tables[table].row[i].name);
  for (size_t i = 0; i < questions_of(table, protocol); i++) fprintf(file, ",q%zu", i + 1);
  bool failed = ferror(file);
  if (fclose(file) || failed) ethd__fail_memory();
  return text;
}

/* ---- for people ---- */

void ethd__table_describe(FILE *file, ethd__study_table table, const ethd__protocol *p) {
  fputs("| column | unit | meaning |\n|---|---|---|\n", file);
  for (size_t i = 0; i < tables[table].count; i++) {
    const study_column *c = &tables[table].row[i];
    fprintf(file, "| %s | %s | %s |\n", c->name, c->unit, c->meaning);
  }
  for (size_t i = 0; i < questions_of(table, p); i++) {
    const ethd__question *q = &p->questionnaire.question[i];
    char words[256];
    fprintf(file, "| q%zu | | %s%s", i + 1, q->text, ethd__question_is_text(q) ? " In words." : "");
    for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
      ethd__answer_words(q, k, words, sizeof words);
      fprintf(file, "%s %d %s", k > 1 ? ";" : "", k, words);
    }
    fputs(" |\n", file);
  }
}

/* ---- for programs ---- */

static void put_string(FILE *file, const char *text, size_t n) {
  putc('"', file);
  for (size_t i = 0; i < n && text[i]; i++) {
    unsigned char c = (unsigned char)text[i];
    if (c == '"' || c == '\\') putc('\\', file);
    if (c < ' ')
      fprintf(file, "\\u%04x", c);
    else
      putc(c, file);
  }
  putc('"', file);
}

static void put_word(FILE *file, const char *text) { put_string(file, text, strlen(text)); }

static void put_levels(FILE *file, const char *levels) {
  fputs(",\n    \"Levels\": {", file);
  for (const char *at = levels; *at;) {
    size_t n = strcspn(at, "|"), name = strcspn(at, "=");
    fputs(at == levels ? "\n      " : ",\n      ", file);
    put_string(file, at, name);
    fputs(": ", file);
    put_string(file, at + name + 1, n - name - 1);
    at += n + (at[n] == '|');
  }
  fputs("\n    }", file);
}

static void put_question(FILE *file, size_t number, const ethd__question *q) {
  char words[256];
  fprintf(file, ",\n  \"q%zu\": {\n    \"Description\": ", number);
  put_word(file, q->text);
  if (ethd__question_is_text(q)) {
    fputs("\n  }", file);
    return;
  }
  fputs(",\n    \"Levels\": {", file);
  for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
    ethd__answer_words(q, k, words, sizeof words);
    fprintf(file, "%s\n      \"%d\": ", k > 1 ? "," : "", k);
    put_word(file, words);
  }
  fputs("\n    }\n  }", file);
}

void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__protocol *p) {
  putc('{', file);
  for (size_t i = 0; i < tables[table].count; i++) {
    const study_column *c = &tables[table].row[i];
    fprintf(file, "%s\n  \"%s\": {\n    \"Description\": ", i ? "," : "", c->name);
    put_word(file, c->meaning);
    if (*c->unit) {
      fputs(",\n    \"Units\": ", file);
      put_word(file, c->unit);
    }
    if (c->levels) put_levels(file, c->levels);
    fputs("\n  }", file);
  }
  for (size_t i = 0; i < questions_of(table, p); i++) put_question(file, i + 1, &p->questionnaire.question[i]);
  fputs("\n}\n", file);
}

void ethd__dataset_describe(FILE *file, const ethd__protocol *p) {
  fputs("{\n  \"Name\": ", file);
  put_word(file, p->name);
  fputs(
      ",\n  \"DatasetType\": \"raw\",\n  \"Description\": \"A tapping study with an encounter-type haptic display. The "
      "sidecars follow BIDS; the tables are CSV.\",\n  \"GeneratedBy\": [{\"Name\": \"libethd\", \"Version\": ",
      file);
  put_word(file, ETHD_VERSION);
  fputs("}]\n}\n", file);
}
