/* Reaches through a flat wall to a plate on a simulated arm with velocity commands; a headset measures the finger.

       finger |<-- gap -->| plate          wall         the plate goes before the finger, and is to stand at the
         o                |------------->  |/////  n    wall when the finger comes

   The arm starts at its table's posture and goes to the finger, which rests until it reaches. The hand isn't stopped by
   the plate. All lengths m, in the arm's R_0. [main] */
#ifndef ETHD__APPS_TAP_REACH_H
#define ETHD__APPS_TAP_REACH_H

#include <stdbool.h>

#include "arm/simulated.h"
#include "tap/placement.h"
#include "tap/study.h"

#define ETHD_REACH_FINGER 0.008 /* m, radius of the finger */
#define ETHD_REACH_EARLY 1e-3   /* m: a touch farther before the wall than this is early */

/* A recorded movement, also its z where it has one: `rise` has z in the place of y. */
typedef struct ethd__recorded {
  ethd__movement path, rise;
} ethd__recorded;

/* The conditions of the taps. */
typedef struct ethd__reaches {
  ethd__arm_table table; /* with the studied delay */
  ethd_vec3 n;           /* unit vector into the wall */
  double wall;           /* m: n.P of its points P */
  double gap;            /* m, from the finger's front to the plate */
  double rate, bias;     /* of the headset: Hz; m along n: its error, > 0 too deep */
  uint64_t seed;
  const ethd_law *const *laws; /* that can be chosen, ended by NULL; NULL: the library's */
  const ethd__gain *gains;     /* changes of the setup, "transition.effort", "0.7", except keys that a law lacks */
  size_t gain_count;
  const ethd__recorded *recorded; /* tap k has movement k modulo their number; NULL: drawn reaches */
  size_t recorded_count;
  /* computed by ethd__reaches_prepare */
  ethd_vec3 at;               /* m: the plate's target place */
  double speed, acceleration; /* m/s, m/s^2: limits of the commands */
} ethd__reaches;

/* Normalises n and finds the plate's target place: in the wall before the posture. Refuses a wall, or a path to it, out
   of the arm's reach (ETHD_E_UNREACHABLE), and a singular posture there (ETHD_E_RANGE); messages call the table
   `name`. */
ETHD_MUST_CHECK ethd_status ethd__reaches_prepare(ethd__reaches *reaches, const char *name,
                                                  char message[ETHD_MESSAGE_MAX]);

/* Reads a movement, also its column z_m if it has one, as ethd__movement_load does. */
ETHD_MUST_CHECK ethd_status ethd__recorded_load(const char *path, const ethd__movement_form *form, ethd__recorded *out,
                                                char message[ETHD_MESSAGE_MAX]);
void ethd__recorded_free(ethd__recorded *recorded);

/* One tick of a table: positions along n from the wall, m, speeds along n, m/s. */
typedef struct ethd__reach_row {
  double t; /* s */
  double plate, commanded, finger;
  double v_plate, v_commanded, v_finger;
  int64_t state;
} ethd__reach_row;

typedef struct ethd__reach_rows {
  ethd__reach_row *row;
  size_t count, room, touch; /* touch: the row of the touch */
} ethd__reach_rows;

/* One tap. It is valid if the finger touches the plate at the wall, at the required speed and without a fault. */
typedef struct ethd__reach {
  ethd__reason reason; /* OK, FAULT, TOO_SLOW (a recorded hand is never fast enough), NO_CONTACT, EARLY_CONTACT */
  double felt, speed;  /* of the plate at the first touch: m behind the wall, m/s along n; NaN: no touch */
  ethd_fault fault;    /* the controller's first, which ends the tap */
} ethd__reach;

/* Runs taps under one law. */
typedef struct ethd__reach_rig {
  const ethd__reaches *reaches;
  ethd_space_setup setup;
  ethd_space *space;
  ethd__arm_sim sim;
} ethd__reach_rig;

/* Opens a rig with this transition law. ETHD_E_UNKNOWN: no such law; the errors of ethd_space_set and
   ethd_space_create. */
ETHD_MUST_CHECK ethd_status ethd__reach_open(const ethd__reaches *reaches, const char *law, ethd__reach_rig *out,
                                             char message[ETHD_MESSAGE_MAX]);
void ethd__reach_close(ethd__reach_rig *rig);

/* Runs tap k, a function of the study, the law, `speed` (m/s, of the finger at the wall) and k alone. rows NULL: not
   recorded. ETHD_E_MEMORY: no room for rows. */
ETHD_MUST_CHECK ethd_status ethd__reach_run(ethd__reach_rig *rig, double speed, uint64_t k, ethd__reach *out,
                                            ethd__reach_rows *rows);

#endif
