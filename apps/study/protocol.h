/* A study file: participants, device, number of taps, and validity of a tap. INI, strict; all [main].

     [study]                              [hand]
     name = paper                         source = simulated      recorded, people, mouse
     seed = 1                             motion = FOLDER         of recorded movements
     participants = 3                     between = 0.5           share of the plant's variance between people
     strategies = smooth,offset           hand_spread = 0.15      of stiffness and damping, ln, between people
     speeds = low,high
     order = paper     see order.h        [validity]
     training = 2      per speed          by = paper              finger: by the finger alone, for any law
     taps = 3          valid ones         band_low = 0.06         m/s about 0.2; the plant's without
     attempts = 40     at most, a cell    band_high = 0.08        m/s about 0.4
     survey = off      on                 graze = 0.02            s of touch that a tap needs at least
     record = all      none               lift = 0.005            m off the wall and back: a double tap
     rest = 3          blocks, 0: never   slack = 0.0004          m: so near to the ring people's fingers touch it
     conditions = FILE.csv                columns transition and speed, a row for each condition, in the place of
                                          strategies and speeds; each combination is a condition

     [device]                             [grid]                  --simulate: every combination
     config = q.ini                       contact.k_e = 1000,2500
     plant = q
                                          [scene]
                                          file = room.scene       in place of the configuration's

                                          [before], [survey], [after], [pages],
                                          [words]: see questionnaire.h

     [statistics]                         largest difference of equivalent strategies:
     margin_d_max = 0.0003                m: what the paper's sensors resolve
     margin_v_of = 0.02                   m/s: the paper's v_th, below which the ring counts as static
     margin_v_rmin = 0.02

     [outcomes]                           the study's hypotheses: ethd-report tests these alone as one family
     primary = d_max:smooth-offset:high   FIGURE:STRATEGY-STRATEGY:SPEED[,..], figures as in the report's pairs.csv
     exclusions = TEXT                    the exclusions, in words

   source = recorded follows recorded movements, people are fingers in a device, mouse a pointer on the screen. With
   people, the configuration's [device] is opened as ethd-run does; the plant then only says how fast low and high are.
   All keys have defaults: the figures above, and strategies, speeds and order of the paper.
   Files are looked for beside the study file, then among those installed with the programs. */
#ifndef ETHD__APPS_STUDY_PROTOCOL_H
#define ETHD__APPS_STUDY_PROTOCOL_H

#include <stdbool.h>

#include "ethd/config.h"
#include "study/questionnaire.h"
#include "tap/metrics.h"

#define ETHD_STUDY_WORDS 8 /* strategies, speeds, values of a gain */
#define ETHD_STUDY_GAINS 6 /* keys of a grid */
#define ETHD_STUDY_CONDITIONS (ETHD_STUDY_WORDS * ETHD_STUDY_WORDS)
#define ETHD_STUDY_PEOPLE 1000000u
#define ETHD_STUDY_POINTS 100000u /* of a grid */
#define ETHD_STUDY_ID_MAX 16
#define ETHD_STUDY_TEXT_MAX ((size_t)1 << 20)

typedef enum ethd__order { ETHD_ORDER_PAPER, ETHD_ORDER_RANDOM, ETHD_ORDER_LATIN, ETHD_ORDER_INTERLEAVED } ethd__order;

/* Sources of hands: the simulated device, on a synthetic or a recorded path; people, on any device; the mouse. */
typedef enum ethd__hands { ETHD_HANDS_SIMULATED, ETHD_HANDS_RECORDED, ETHD_HANDS_PEOPLE, ETHD_HANDS_MOUSE } ethd__hands;

typedef struct ethd__word_list {
  char *word[ETHD_STUDY_WORDS];
  size_t count;
  int line; /* of the file, 0: the default */
} ethd__word_list;

typedef struct ethd__condition {
  size_t strategy, speed; /* of the protocol */
  size_t line;            /* of the file of conditions */
} ethd__condition;

typedef struct ethd__axis {
  char *key; /* section.key */
  ethd__word_list values;
} ethd__axis;

typedef struct ethd__protocol {
  char *path, *text, *folder;                   /* unchanged; relative paths start at folder */
  char *name, *config, *plant, *scene, *motion; /* NULL: not given; the name is never NULL */
  uint64_t seed;
  uint32_t participants, training, taps, attempts, rest;
  ethd__word_list strategies, speeds, primary;
  char *conditions, *condition_path; /* the key's path; the file, unchanged; NULL: all combinations */
  ethd__condition condition[ETHD_STUDY_CONDITIONS];
  size_t condition_count;
  char *exclusions; /* NULL: not given */
  ethd__order order;
  ethd__hands hands;
  bool survey, record;
  double between, hand_spread;
  double band_low, band_high; /* m/s, NaN: the plant's */
  double graze, lift, slack;
  double margin_d_max, margin_v_of, margin_v_rmin; /* m, m/s: of equivalence, for the report */
  ethd__validity validity;
  ethd__questionnaire questionnaire;
  ethd__axis axes[ETHD_STUDY_GAINS];
  size_t axis_count;
} ethd__protocol;

ETHD_MUST_CHECK ethd_status ethd__protocol_load(const char *path, ethd__protocol *out, char message[ETHD_MESSAGE_MAX]);

/* Does the same with text, which messages call `name`. */
ETHD_MUST_CHECK ethd_status ethd__protocol_parse(const char *text, size_t length, const char *name, const char *folder,
                                                 ethd__protocol *out, char message[ETHD_MESSAGE_MAX]);

/* Reads the study's conditions if it has a file of them; `path` is its path. Until then such a study has no
   conditions. */
ETHD_MUST_CHECK ethd_status ethd__protocol_conditions(ethd__protocol *protocol, const char *path,
                                                      char message[ETHD_MESSAGE_MAX]);

void ethd__protocol_free(ethd__protocol *protocol);

/* Writes P01, P02, .. with as many digits as the number of participants needs, two at least. */
void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]);

/* Returns the number of combinations of the grid, 1 without one. */
size_t ethd__protocol_points(const ethd__protocol *protocol);

/* Returns the value of an axis at a combination; the last axis varies fastest. */
const char *ethd__protocol_value(const ethd__protocol *protocol, size_t point, size_t axis);

#endif
