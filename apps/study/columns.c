#include "study/columns.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

const char *const ethd__table_names[ETHD_TABLES] = {"taps", "survey", "events", "participants", "orders"};

#define PARTICIPANT {"participant", "", "P01, P02, ..", NULL}
#define BLOCK   \
  {"block", "", \
   "of the participant, from 1: a strategy at a speed, one trial of it in an interleaved order, or a training", NULL}
#define PART {"part", "", "training or test", "training=isn't analysed|test=is"}
#define HANDS                                                                                                  \
  "device=a person's finger in the device's ring|mouse=a person's pointer, which leads the simulated device's" \
  " hand|simulated=the plant's synthetic hand|recorded=a recorded movement"

/* A simulation's table of taps has these columns first. */
static const ethd__column simulation[] = {
    {"study", "", "the first 12 digits of the study's hash, as versions.txt has it", NULL},
    {"point", "", "which combination of the grid, from 0; the last gain runs fastest", NULL},
};

#define REASONS                                                                                                     \
  "ok=valid|fault=the device stopped itself|early-contact=the finger touched before the ring met the wall; by the " \
  "finger's validity, before it stood at the wall or behind it|too-slow=below the band|too-fast=above the "         \
  "band|no-contact=the wall wasn't met or touched|grazing=touched too shortly|double=left the wall and came back"

static const ethd__column taps[] = {
    PARTICIPANT,
    BLOCK,
    PART,
    {"attempt", "", "within the block, from 1", NULL},
    {"transition", "", "the strategy", NULL},
    {"speed", "", "low, high, or m/s", NULL},
    {"seed", "", "key of the simulated finger's random numbers", NULL},
    {"tap", "", "its second key", NULL},
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
static const ethd__column survey[] = {
    PARTICIPANT, BLOCK, {"transition", "", "the strategy", NULL}, {"speed", "", "low, high, or m/s", NULL}};
static const ethd__column events[] = {
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
static const ethd__column participants[] = {
    PARTICIPANT,
    {"status", "", "how far the participant has come",
     "complete=every block is done|incomplete=blocks are missing|aborted=wanted no more|refused=did not agree to take "
     "part|withdrawn=withdrew|excluded=taken out by the experimenter"},
    {"analysed", "", "whether the taps belong to the analysis", "1=they do|0=they stay on record and leave it"},
    {"reason", "", "of whoever aborted, withdrew, excluded or included", NULL},
    {"hand", "", "who led the hand", HANDS},
    {"taps", "", "test taps", NULL},
    {"valid", "", "valid test taps that weren't rejected", NULL},
    {"accepted", "", "valid test taps that the experimenter accepted", NULL},
    {"rejected", "", "valid test taps that the experimenter rejected", NULL},
    {"first_utc", "", "the first tap's begin", NULL},
    {"last_utc", "", "the last tap's begin", NULL},
};
static const ethd__column orders[] = {
    PARTICIPANT, BLOCK, PART, {"transition", "", "the strategy", NULL}, {"speed", "", "low, high, or m/s", NULL}};

#define ROWS(table) {table, sizeof table / sizeof *table}
static const ethd__columns tables[ETHD_TABLES] = {ROWS(taps), ROWS(survey), ROWS(events), ROWS(participants),
                                                  ROWS(orders)};

bool ethd__is_simulated(ethd__study_table table, const ethd__table_scope *scope) {
  return table == ETHD_TABLE_TAPS && scope->setup;
}

ethd__columns ethd__columns_first(ethd__study_table table, const ethd__table_scope *scope) {
  return ethd__is_simulated(table, scope) ? (ethd__columns)ROWS(simulation) : (ethd__columns){0};
}

ethd__columns ethd__columns_of(ethd__study_table table) { return tables[table]; }

void ethd__columns_asked(ethd__study_table table, const ethd__protocol *p, void *user,
                         void (*each)(void *user, const char *column, const ethd__question *q)) {
  for (int when = 0; when < ETHD_ASKINGS; when++) {
    const ethd__question *list = p->questionnaire.question[when];
    if (table != (when == ETHD_ASK_BLOCK ? ETHD_TABLE_SURVEY : ETHD_TABLE_PARTICIPANTS)) continue;
    for (size_t i = 0; i < ethd__question_count(list); i++) {
      char column[24];
      snprintf(column, sizeof column, "%sq%zu", ethd__asking_columns[when], i + 1);
      each(user, column, &list[i]);
    }
  }
}

static void put_name(void *file, const char *column, const ethd__question *q) {
  (void)q;
  fprintf(file, ",%s", column);
}

char *ethd__table_header(ethd__study_table table, const ethd__protocol *protocol) {
  ethd__printed text;
  FILE *file = ethd__print_begin(&text);
  for (size_t i = 0; i < tables[table].count; i++) fprintf(file, "%s%s", i ? "," : "", tables[table].row[i].name);
  ethd__columns_asked(table, protocol, file, put_name);
  return ethd__print_end(&text);
}

char *ethd__simulation_header(const ethd__protocol *p) {
  ethd__printed text;
  ETHD__FREED char *header = ethd__table_header(ETHD_TABLE_TAPS, p);
  FILE *file = ethd__print_begin(&text);
  for (size_t i = 0; i < sizeof simulation / sizeof *simulation; i++) fprintf(file, "%s,", simulation[i].name);
  fputs(header, file);
  for (size_t i = 0; i < p->axis_count; i++) fprintf(file, ",%s", p->axes[i].key);
  return ethd__print_end(&text);
}

const ethd_param *ethd__gain_of(const ethd_setup *setup, const char *name, ethd_setup_key *key) {
  for (uint32_t i = 0; !ethd_setup_key_at(setup, i, key); i++) {
    char full[96];
    snprintf(full, sizeof full, "%s.%s", key->section, key->param.name);
    if (!strcmp(full, name)) return &key->param;
  }
  return NULL;
}
