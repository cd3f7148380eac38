/* The device's measurements: joint angles in counts, and the finger by one of the sensors of sim.h. All [any, rt-safe]
   except ethd__sensors_create. */
#ifndef ETHD__SIM_SENSORS_H
#define ETHD__SIM_SENSORS_H

#include "ethd/sim.h"
#include "finger/nail.h"
#include "finger/zones.h"
#include "sim/body.h"
#include "sim/random.h"

#define ETHD__READINGS_MAX 64

/* A reading that was sampled and isn't delivered yet. */
typedef struct ethd__sim_reading {
  int64_t sample_ns, due_ns, have; /* have: ETHD_HAVE_*; 0: no usable reading */
  ethd_vec centre, ring;
  double noise; /* m: as the sensor reports; 0: not reported */
  double rays[16];
} ethd__sim_reading;

/* A reading consists of parts, each sampled at its own instant. A centre has one part. A frame has its rays in order;
   the instant in their middle is the frame's. */
typedef struct ethd__sensors {
  ethd_plant plant;
  double ring_radius, finger_radius, phase;
  ethd__sim_key key;
  ethd__zones zones; /* for the plant's mean finger radius */
  uint32_t lit;      /* which barriers are lit */
  ethd__nail nail;
  double count_phase[2]; /* counts */
  uint32_t sample, part; /* the next part, */
  double next;           /* s: and the instant of its sampling */
  uint64_t taken;        /* complete readings */
  ethd__sim_reading readings[ETHD__READINGS_MAX];
} ethd__sensors;

/* Sets the constants of all taps. [main] */
void ethd__sensors_create(ethd__sensors *sensors, const ethd_sim_def *def);

void ethd__sensors_start(ethd__sensors *sensors, const ethd_sim_def *def, const ethd_sim_tap *tap) ETHD_RT;

/* Samples the next part from the state at its instant. */
void ethd__sensors_take(ethd__sensors *sensors, const ethd__body *body, const ethd__sim_state *state) ETHD_RT;

/* Fill the sense: the joint angles, from the coordinates; the newest reading that is due at its time_ns and wasn't due
   at since_ns. */
void ethd__sensors_joints(const ethd__sensors *sensors, const ethd__body *body, const double x[ETHD__DOF_MAX],
                          ethd_sense *out) ETHD_RT;
void ethd__sensors_deliver(const ethd__sensors *sensors, int64_t since_ns, ethd_sense *out) ETHD_RT;

#endif
