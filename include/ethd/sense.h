/* One tick from outside: a device's measurements (sense), its command, and all intermediate results (trace). Links from
   libethd; of the controller a driver needs only this header.

     device --- sense ---> ethd_control_step --- command ---> device
                                  |
                                  '--- trace: sense and command included, a row of every recording */
#ifndef ETHD_SENSE_H
#define ETHD_SENSE_H

#include <stdint.h>

#include "ethd/fault.h"

ETHD_BEGIN_DECLS

#define ETHD_BODIES_MAX 4 /* scenes that move */

/* A sense with a number beyond these limits, or with one that isn't finite, is refused as row INPUT of the fault table.
   No mechanism reaches them, and no smaller number can overflow in a tick. */
#define ETHD_SENSE_ANGLE_MAX 6.2831853071795865e6 /* rad: a million turns */
#define ETHD_SENSE_SPEED_MAX 1e6                  /* rad/s, m/s */
#define ETHD_SENSE_LENGTH_MAX 1e6                 /* m */
#define ETHD_SENSE_FORCE_MAX 1e6                  /* Nm, N */
#define ETHD_SENSE_AGE_MAX 1.0                    /* s */

/* The contents of a sense, as bits of `have`. */
enum {
  ETHD_HAVE_DQ = 1,     /* dq: used as it is; without it the setup's velocity estimator computes it from q */
  ETHD_HAVE_FINGER = 2, /* finger, finger_v: used as they are at this tick, without fit or filter */
  ETHD_HAVE_START = 4,  /* finger: starts the filter there, at rest */
  ETHD_HAVE_CENTRE = 8, /* centre: a reading relative to the ring has arrived, taken at sample_ns */
  ETHD_HAVE_RAYS = 16,  /* rays: a frame of distances has arrived, taken at sample_ns; ignored if there is a centre */
  ETHD_HAVE_RING = 32,  /* ring: the ring's position at sample_ns, known by the device */
  ETHD_HAVE_BODY = 64,  /* ETHD_HAVE_BODY << i: body i has a new pose; else its last one holds; i < ETHD_BODIES_MAX */
  ETHD_HAVE_WORLD =
      1024, /* centre: a position in R_0, e.g. from a camera, not relative to the ring; `ring` isn't used */
  ETHD_HAVE_COMMANDED = 2048, /* commanded: it replaces the torque of the last step's command */
  ETHD_HAVE_AGE = 4096        /* age: both angles are extrapolated to time_ns by the joints' speeds */
};

/* X(type, name, count, unit, brief); every field is 8 bytes wide. */
#define ETHD_SENSE_FIELDS(X)                                                                        \
  X(int64_t, time_ns, 1, "ns", "instant of the joint sample")                                       \
  X(int64_t, have, 1, "1", "bits: what this sense holds")                                           \
  X(int64_t, missed, 1, "1", "whole periods missed since the last step")                            \
  X(int64_t, step_ns, 1, "ns", "duration of the last step as the caller measured it")               \
  X(int64_t, faults, 1, "1", "bits: rows of the fault table that device or loop saw")               \
  X(int64_t, grave, 1, "1", "bits: rows whose second reaction is due")                              \
  X(double, q, 2, "rad", "joint angles")                                                            \
  X(double, dq, 2, "rad/s", "joint speeds")                                                         \
  X(double, finger, 2, "m", "finger centre in R_0")                                                 \
  X(double, finger_v, 2, "m/s", "finger velocity in R_0")                                           \
  X(int64_t, sample_ns, 1, "ns", "instant of the reading")                                          \
  X(double, centre, 2, "m", "reading: finger centre relative to the ring's")                        \
  X(double, ring, 2, "m", "ring centre at the reading's instant")                                   \
  X(double, rays, 16, "m", "reading: 16 free distances, NaN missing")                               \
  X(double, bodies, 24, "m, rad, s", "6 of each body: x, y, angle, their speeds")                   \
  X(double, finger_noise, 1, "m", "sd of the reading, each axis; 0: as [finger_filter] noise says") \
  X(double, commanded, 2, "Nm", "torque that was really commanded since the last step")             \
  X(double, age, 2, "s", "time from each joint's sample to time_ns, >= 0")

/* X as above. The results of a tick. If no contact counts, d_re, d_fe and v_n are NaN. d_fe holds the transition law's
   ethd_ruling.argument: d_fr + eps for offset, d_fe for a law that doesn't set it. */
#define ETHD_TRACE_FIELDS(X)                                                       \
  X(int64_t, tick, 1, "1", "steps since create or reset")                          \
  X(int64_t, fault, 1, "1", "0, or the latched ethd_fault")                        \
  X(int64_t, guard, 1, "1", "bits: what the guard did")                            \
  X(int64_t, swap, 1, "1", "1: a posted setup was taken at this tick")             \
  X(int64_t, queried, 1, "1", "1: the scene was queried")                          \
  X(int64_t, contacts, 1, "1", "contacts that count")                              \
  X(int64_t, overflow, 1, "1", "contacts that found no room")                      \
  X(int64_t, object, 1, "1", "object of the deepest contact, -1 none")             \
  X(int64_t, body, 1, "1", "what the object belongs to: 0 scene, i bodies[i - 1]") \
  X(int64_t, state, 1, "1", "0 transparent, 1 braking, 2 vo")                      \
  X(double, x, 2, "m", "ring centre in R_0")                                       \
  X(double, v, 2, "m/s", "ring velocity")                                          \
  X(double, xf, 2, "m", "finger centre")                                           \
  X(double, vf, 2, "m/s", "finger velocity")                                       \
  X(double, rf, 1, "m", "finger radius of the last fit, NaN none")                 \
  X(double, qd, 2, "rad/s", "joint speeds that were used")                         \
  X(double, eps_q, 2, "rad", "J^-1 (X_f - X_r)")                                   \
  X(double, eps_q_dot, 2, "rad/s", "J^-1 (V_f - V_r)")                             \
  X(double, beta, 1, "1", "share of the tracking torque")                          \
  X(double, fe, 2, "N", "sum of the contact forces")                               \
  X(double, fd, 2, "N", "sum of the braking forces")                               \
  X(double, eps, 1, "m", "wall offset of the deepest contact")                     \
  X(double, d_re, 1, "m", "its ring distance")                                     \
  X(double, d_fe, 1, "m", "its ruling's argument, on which beta depends")          \
  X(double, v_n, 1, "m/s", "its ring speed along n")                               \
  X(double, tau_raw, 2, "Nm", "torque before the guard")                           \
  X(double, tau, 2, "Nm", "torque commanded")                                      \
  X(double, learnt, 4, "1", "the transition law's memory, where it looks ahead")

#define ETHD_FIELD_1(type, name) type name;
#define ETHD_FIELD_2(type, name) type name[2];
#define ETHD_FIELD_4(type, name) type name[4];
#define ETHD_FIELD_16(type, name) type name[16];
#define ETHD_FIELD_24(type, name) type name[24];
#define ETHD_FIELD(type, name, count, unit, brief) ETHD_FIELD_##count(type, name)

/* One snapshot of the device. Fields that `have` doesn't name are ignored. */
typedef struct ethd_sense {
  ETHD_SENSE_FIELDS(ETHD_FIELD)
} ethd_sense;

/* One whole tick: replaying `sense` gives the other fields to the bit. */
typedef struct ethd_trace {
  ethd_sense sense;
  ETHD_TRACE_FIELDS(ETHD_FIELD)
} ethd_trace;

typedef struct ethd_command {
  double torque[2]; /* Nm, joints 1 and 2 */
  int32_t safe;     /* 1: safe state and the torque is zero; the device may disable */
  int32_t reserved;
} ethd_command;

ETHD_END_DECLS

#endif
