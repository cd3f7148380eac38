/* A simulated end effector that takes velocities, behind by a whole number of ticks, and walls around it. */
#ifndef ETHD_TESTS_MOVER_H
#define ETHD_TESTS_MOVER_H

#include "ethd/space.h"

/* Draws a number of [a, b), and a unit vector of any direction. */
double between(double a, double b);
ethd_vec3 any_unit(void);

/* A controller of this setup. */
ethd_space *made(const ethd_space_setup *setup);

#define LATE_MAX 64

typedef struct mover {
  ethd_space *space;
  ethd_space_setup setup;
  ethd_vec3 at, v;              /* commanded */
  ethd_vec3 past[LATE_MAX + 1]; /* commanded places, the newest first: the device is `late` ticks behind */
  int late;
  int64_t tick;
  ethd_space_command command;
  ethd_space_trace trace;
  ethd_status status;
} mover;

/* Makes a controller of m->setup for an effector that stands at a place. */
void mover_open(mover *m, int late, ethd_vec3 at);

/* The instant of the next tick, ns, and that tick with a sense that has all but its instant, x and v. */
int64_t mover_now(const mover *m);
void mover_sense(mover *m, ethd_space_sense *s, const ethd_surface *near, uint32_t count);

/* One tick with a finger that is known. */
void mover_step(mover *m, ethd_vec3 finger, ethd_vec3 finger_v, const ethd_surface *near, uint32_t count);

static inline ethd_vec3 real_place(const mover *m) { return m->past[m->late]; }

/* The point of the wall n.p = c that is nearest to x. */
ethd_surface wall_at(ethd_vec3 x, ethd_vec3 n, double c, int32_t id);

#endif
