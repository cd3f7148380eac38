/* A controller in a test: a scene as text, a setup, and ticks told as motion of ring and finger in R_0. */
#ifndef ETHD_TESTS_RIG_H
#define ETHD_TESTS_RIG_H

#include <stdint.h>

#include "ethd/control.h"
#include "unit/suite.h"

/* The paper's wall on the left: d_re = x - 0.25 with the default ring. */
#define RIG_WALL "halfplane -1 0 -0.238\n"

typedef struct rig {
  ethd_scene *scene;
  ethd_setup setup; /* to be changed before rig_start, or posted */
  ethd_control *control;
  ethd_sense sense; /* of the last tick */
  ethd_command command;
  ethd_trace trace;
  ethd_status status;
} rig;

/* Ring and finger; lengths in m. */
typedef struct motion {
  ethd_vec x, v, xf, vf;
} motion;

ethd_scene *rig_scene(const char *text);

/* The default setup with this scene (NULL: none); then rig_start makes the controller. */
void rig_open(rig *r, const char *scene);
void rig_start(rig *r);
/* Both, with this law of transitions; NULL: the default one. */
void rig_begin(rig *r, const char *scene, const ethd_transition_law *law);
void rig_close(rig *r);

/* A controller of this setup. */
ethd_control *rig_control(const ethd_setup *setup);

/* Sets a number of a setup by its name. */
void rig_set(ethd_setup *setup, const char *name, double value);

/* Joint angles and speeds, link 2 turned clockwise from link 1, and the finger as known. */
ethd_sense rig_sense(const ethd_arm *arm, const motion *m);

/* One tick; checks that the step says done. */
const ethd_trace *rig_step(rig *r, const motion *m);

/* One tick of any outcome, its status. */
ethd_status rig_try(rig *r, const ethd_sense *sense);

/* Posts r->setup; checks that it is accepted. */
void rig_post(rig *r);

/* How often a row of the fault table was counted. */
uint64_t rig_counted(const rig *r, int row);

/* The next event, kind 0 when there is none. */
ethd_event rig_poll(rig *r);

/* With the default wall: ring at d_re = d, moving at v into it, finger `ahead` m deeper and as fast. */
motion rig_at(double d, double v, double ahead);

#endif
