/* The study: every transition law at every speed, with the same fingers for each.

   The finger of tap k is a function of (seed, k) alone, so that all laws meet the same person, and any tap can be
   repeated on its own. */
#ifndef ETHD__APPS_TAP_STUDY_H
#define ETHD__APPS_TAP_STUDY_H

#include "cli/law_fault.h"
#include "tap/loop.h"
#include "tap/placement.h"
#include "tap/trace.h"

#define ETHD_TAP_WORD_MAX 32

typedef struct ethd__speed {
  char word[ETHD_TAP_WORD_MAX]; /* the given word: low, high or a number */
  double commanded;             /* m/s: of the synthetic hand */
  double centre, band;          /* m/s: valid within centre +- band; a recording touches at centre */
  ethd__touchdown touchdown;    /* of the movement at this speed */
} ethd__speed;

/* Reads a speed. low and high are the plant's; a number V is commanded as it is and valid within 0.04 + 0.1 V, which
   gives the paper's bands at 0.2 and 0.4. False: it is neither a word nor a number from 0.01 to 2. */
bool ethd__speed_parse(const char *word, const ethd_plant *plant, ethd__speed *out);

/* A change of the configuration's setup: "contact.k_e", "2000". */
typedef struct ethd__gain {
  const char *key, *value;
} ethd__gain;

typedef struct ethd__study {
  const ethd_config *config; /* with a scene */
  ethd_plant plant;
  uint64_t seed;
  ethd__movement movement; /* count 0: the plant's synthetic hand */
  ethd__speed *speeds;
  size_t speed_count;
  const ethd__gain *gains; /* changes of the configuration; a law without such a parameter ignores it */
  size_t gain_count;
  double graze, lift; /* as in ethd__rule */
  ethd__validity validity;
  uint32_t learn; /* taps before each counted one, for laws that learn */
  bool single;
  /* computed by ethd__study_prepare */
  ethd_vec meet; /* m: the ring's centre as it meets the wall */
  ethd_vec n;    /* of the wall there */
} ethd__study;

#define ETHD_TAP_HEIGHT 0.25 /* m: y of the movement to the left */

/* Finds the wall: the first object that the ring meets when it moves to the left at ETHD_TAP_HEIGHT. Then the
   touchdowns of a movement. Refuses a scene without one, and a touch out of reach. */
ETHD_MUST_CHECK ethd_status ethd__study_prepare(ethd__study *study, char message[ETHD_MESSAGE_MAX]);

/* Moves x until a disc of this radius there meets an object. Returns the number of steps; -1: none within `outer` of
   the origin. */
int ethd__way_to_wall(const ethd_scene *scene, double radius, ethd_vec direction, double outer, ethd_vec *x,
                      ethd_nearest *near);

/* Runs taps under one law: a controller and a simulated device. */
typedef struct ethd__stage {
  const ethd__study *study;
  const char *law;
  ethd_setup setup;
  ethd_sim *sim;
  ethd_control *control;
  ethd__tap_rows rows;         /* of the last tap */
  double learned[ETHD_MEMORY]; /* by the law, at the beginning of the last tap */
  double heat[2];              /* of the motors at its beginning, see ethd_control_heat */
  ethd_path_sample *samples;
} ethd__stage;

/* Returns false for a key that the law lacks. */
bool ethd__gain_applies(const ethd__study *study, const char *law, const ethd__gain *gain);

/* Opens a stage. Its setup is the configuration's with transition `law`, the study's gains, and the narrower of its
   limits and the device's. `law` outlives the stage. */
ETHD_MUST_CHECK ethd_status ethd__stage_open(const ethd__study *study, const char *law, ethd__stage *out,
                                             char message[ETHD_MESSAGE_MAX]);
void ethd__stage_close(ethd__stage *stage);

/* Draws a tap's random numbers; its recorded path is in stage->samples until the next one. */
ETHD_MUST_CHECK ethd_status ethd__stage_draw(ethd__stage *stage, const ethd__speed *speed, uint64_t tap,
                                             ethd_sim_tap *out);

/* Returns the rule of validity for taps of this finger on this stage at this speed. */
ethd__rule ethd__stage_rule(const ethd__stage *stage, const ethd__speed *speed, double finger_radius);

/* Returns the data that convert their ticks to tables. */
ethd__view ethd__stage_view(const ethd__stage *stage, const ethd__speed *speed, double finger_radius);

typedef struct ethd__result {
  ethd__metrics metrics, finger; /* by the study's rule; by the finger's, from the pad's first touch on */
  double commanded;              /* m/s: commanded speed of this tap, random */
  double finger_radius;          /* m: radius of this tap's finger, random */
  uint32_t ticks, queried;       /* ticks; those with a query of the scene */
  ethd__law_fault law_fault;     /* the first of a tap that ethd__stage_run made */
} ethd__result;

/* Evaluates this tap's ticks, in stage->rows. */
void ethd__stage_judge(const ethd__stage *stage, const ethd__rule *rule, const ethd_sim_tap *tap, ethd__result *out);

ETHD_MUST_CHECK ethd_status ethd__stage_run(ethd__stage *stage, const ethd__speed *speed, uint64_t tap,
                                            ethd__result *out, char message[ETHD_MESSAGE_MAX]);

#endif
