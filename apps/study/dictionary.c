#include "study/dictionary.h"

#include <stdio.h>
#include <stdlib.h>

#include "study/columns.h"

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

char *ethd__dictionary(const ethd__table_scope *scope) {
  char *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) return NULL;
  fputs(files, file);
  for (int i = 0; i < ETHD_TABLES; i++) {
    fprintf(file, "## %s.csv\n\n", ethd__table_names[i]);
    ethd__table_describe(file, (ethd__study_table)i, scope);
    putc('\n', file);
    if (i == ETHD_TABLE_TAPS) fputs(behind, file);
  }
  fputs(ticks, file);
  bool failed = ferror(file);
  if (!fclose(file) && !failed) return text;
  free(text);
  return NULL;
}
