/* Runs an open device in space tick by tick, without a controller. */
#ifndef ETHD__CONFORM_SPACE_RIG_H
#define ETHD__CONFORM_SPACE_RIG_H

#include "conform/conform_rig.h"

typedef struct ethd__space_rig {
  ethd__conform_rig r;
  ethd_space_sense sense; /* the last sample */
  ethd_vec3 written;      /* the last command */
  ethd_vec3 way;          /* sum of all commands, as the device reports them, times the period */
  int stale, calls, slow;
  int64_t longest; /* ns of a call */
} ethd__space_rig;

/* As ethd__conform_rig_begin. All [main]. */
bool ethd__space_rig_begin(const ethd_conform_def *def, ethd__space_rig *s, ethd_conform_answer *a);

/* Runs for a time with a command; it rises and falls within the setup's limits. */
void ethd__space_rig_run(ethd__space_rig *s, double seconds, ethd_vec3 to);

/* Returns the effector's motion in this time along a unit vector, m, while the last command is renewed or, with `write`
   false, no command is written. */
double ethd__space_rig_moved(ethd__space_rig *s, ethd_vec3 along, bool write, double seconds);

#endif
