/* What the device measures: joint angles by counts, the finger by one of the sensors of sim.h. All [any, rt-safe] but
   ethd__sensors_create. */
#ifndef ETHD_SIM_SENSORS_H
#define ETHD_SIM_SENSORS_H

#include "ethd/sim.h"
#include "finger/nail.h"
#include "finger/zones.h"
#include "sim/body.h"
#include "sim/random.h"

#define ETHD__READINGS_MAX 64

/* A reading on its way. */
typedef struct ethd__sim_reading {
  int64_t sample_ns, due_ns, have; /* have: ETHD_HAVE_*; 0: the sensor saw nothing that it could use */
  ethd_vec centre, ring;
  double noise; /* m: as the sensor says; 0: it doesn't */
  double rays[16];
} ethd__sim_reading;

/* A reading is made of parts, each at its instant: one for a centre; for a frame its rays in order, and in
   the middle the instant that stands for the whole. */
typedef struct ethd__sensors {
  ethd_plant plant;
  double ring_radius, finger_radius, phase;
  ethd__sim_key key;
  ethd__zones zones; /* of a finger as the plant has it on average */
  uint32_t lit;      /* barriers */
  ethd__nail nail;
  double count_phase[2]; /* counts */
  uint32_t sample, part; /* what comes next, */
  double next;           /* s: and when */
  uint64_t taken;        /* readings complete */
  ethd__sim_reading readings[ETHD__READINGS_MAX];
} ethd__sensors;

/* What doesn't change from tap to tap. [main] */
void ethd__sensors_create(ethd__sensors *sensors, const ethd_sim_def *def);

void ethd__sensors_start(ethd__sensors *sensors, const ethd_sim_def *def, const ethd_sim_tap *tap) ETHD_RT;

/* Takes the next part: the state at its instant. */
void ethd__sensors_take(ethd__sensors *sensors, const ethd__body *body, const ethd__sim_state *state) ETHD_RT;

/* Into the sense: joint angles, from the coordinates; the newest reading that is due at its time_ns and
   wasn't at since_ns. */
void ethd__sensors_joints(const ethd__sensors *sensors, const ethd__body *body, const double x[ETHD__DOF_MAX],
                          ethd_sense *out) ETHD_RT;
void ethd__sensors_deliver(const ethd__sensors *sensors, int64_t since_ns, ethd_sense *out) ETHD_RT;

#endif
