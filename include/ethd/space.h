/* The controller in space: a ring, cap or plate on any arm, commanded by force or velocity. One call per tick, a pure
   function of its inputs and one flat block of state; it knows no joints. Links from libethd.

     sense, surfaces --- ethd_space_step ---> command: force or velocity, normal
                                |
                                '--- trace

   Frame R_0: right-handed, of the user's choice; m, s, N. The laws, contacts, faults, events and swaps are those of
   control.h, and `ethd_contact` is that of law.h, with the end effector's point X instead of the ring's centre:

     ring, cap   X: its centre; R_r: its inner radius
     plate       X: the desired position of the finger, R_r before the plate's face; R_r - R_f is the stand-off

   A cap's axis is the sense's `normal`, from its rim to its top. A finger whose centre is more than `rim` behind X
   along it is out of the cap, row FINGER_OUT. If x is the commanded position, this is detected late; so the source of
   the readings sets the bit of that row in `faults` itself, by ethd_cap_finger.gone (cap.h).

          X     R_r   |  d_re  |//////
          o-----------|<------>|//////     d_re = n.(P - X) - R_r
                 plate         P --> n

   A law of velocity needs the *commanded* position and speed, not the measured ones: a measured position is late by the
   device's delay, and the effector would go deeper by that distance. So for velocity commands the sense's x and v are
   the commanded ones, and ethd_facts.delay is 0: the law's inputs are never late. The device's delay is in `ability`;
   ethd-check prints how much of the gap it needs. */
#ifndef ETHD_SPACE_H
#define ETHD_SPACE_H

#include <stdint.h>

#include "ethd/control.h"
#include "ethd/surface.h"

ETHD_BEGIN_DECLS

typedef enum ethd_space_kind { ETHD_SPACE_FORCE = 0, ETHD_SPACE_VELOCITY = 1 } ethd_space_kind;
typedef enum ethd_effector { ETHD_EFFECTOR_RING = 0, ETHD_EFFECTOR_CAP = 1, ETHD_EFFECTOR_PLATE = 2 } ethd_effector;

/* ---- sense, command, trace ---- */

/* The contents of a sense, as bits of `have`. */
enum {
  ETHD_SPACE_HAVE_FINGER = 1,       /* finger, finger_v: used as they are, without filter */
  ETHD_SPACE_HAVE_READING = 2,      /* reading: a position has arrived, taken at sample_ns */
  ETHD_SPACE_HAVE_READING_V = 4,    /* reading_v, with its reading_v_noise */
  ETHD_SPACE_HAVE_EXTRAPOLATED = 8, /* the tracker has extrapolated the reading to time_ns */
  ETHD_SPACE_HAVE_NORMAL = 16,    /* normal: the plate's direction. Without it X lies before the plate in the commanded
                                       direction, and in its face until a first surface is near */
  ETHD_SPACE_HAVE_ABILITY = 32,   /* ability: of this tick, instead of the setup's */
  ETHD_SPACE_SURFACES = 64,       /* not in `have`: the value of row INPUT for the surfaces */
  ETHD_SPACE_HAVE_COMMANDED = 128 /* commanded: it replaces the last step's command */
};

#define ETHD_ABILITY 6 /* numbers of an ethd_ability */

/* X(type, name, count, unit, brief), as ETHD_SENSE_FIELDS */
#define ETHD_SPACE_SENSE_FIELDS(X)                                                                 \
  X(int64_t, time_ns, 1, "ns", "instant of x and v")                                               \
  X(int64_t, have, 1, "1", "bits: what this sense holds")                                          \
  X(int64_t, missed, 1, "1", "whole periods missed since the last step")                           \
  X(int64_t, step_ns, 1, "ns", "duration of the last step as the caller measured it")              \
  X(int64_t, faults, 1, "1", "bits: rows of the fault table that device or loop saw")              \
  X(int64_t, grave, 1, "1", "bits: rows whose second reaction is due")                             \
  X(double, x, 3, "m", "the end effector: centre of ring or cap, centre of the plate's face")      \
  X(double, v, 3, "m/s", "its velocity")                                                           \
  X(double, normal, 3, "1", "unit vector that the plate faces, away from the finger")              \
  X(double, finger, 3, "m", "finger centre")                                                       \
  X(double, finger_v, 3, "m/s", "finger velocity")                                                 \
  X(int64_t, sample_ns, 1, "ns", "instant of the reading")                                         \
  X(double, reading, 3, "m", "reading: finger centre")                                             \
  X(double, reading_v, 3, "m/s", "reading: finger velocity")                                       \
  X(double, reading_noise, 1, "m", "sd of the reading, each axis; 0: as the filter's noise says")  \
  X(double, reading_v_noise, 1, "m/s", "sd of its velocity, each axis")                            \
  X(double, ability, 6, "m/s, m/s2, s, kg, N, N", "along the nearest surface's n; NaN: not known") \
  X(double, commanded, 3, "N, m/s", "force or velocity really commanded since the last step")

#define ETHD_NEAR_MAX 16       /* surfaces within range that a tick uses, the deepest */
#define ETHD_NEAR_REFUSED (-1) /* `near` of a tick that refused its surfaces (row INPUT) */

#define ETHD_SPACE_TRACE_FIELDS(X)                                                                     \
  X(int64_t, tick, 1, "1", "steps since create or reset")                                              \
  X(int64_t, fault, 1, "1", "0, or the latched ethd_fault")                                            \
  X(int64_t, guard, 1, "1", "bits: what the guard did")                                                \
  X(int64_t, swap, 1, "1", "1: a posted setup was taken at this tick")                                 \
  X(int64_t, contacts, 1, "1", "contacts that count")                                                  \
  X(int64_t, overflow, 1, "1", "surfaces or contacts that found no room")                              \
  X(int64_t, object, 1, "1", "id of the deepest contact's surface, -1 none")                           \
  X(int64_t, state, 1, "1", "0 transparent, 1 braking, 2 vo")                                          \
  X(double, xf, 3, "m", "finger centre")                                                               \
  X(double, vf, 3, "m/s", "finger velocity")                                                           \
  X(double, beta, 1, "1", "share of tracking")                                                         \
  X(double, fe, 3, "N", "sum of the contact forces")                                                   \
  X(double, fd, 3, "N", "sum of the braking forces")                                                   \
  X(double, eps, 1, "m", "wall offset of the deepest contact")                                         \
  X(double, d_re, 1, "m", "its effector's distance")                                                   \
  X(double, d_fe, 1, "m", "its ruling's argument, on which beta depends")                              \
  X(double, v_n, 1, "m/s", "its effector's speed along n")                                             \
  X(double, speed, 1, "m/s", "along n in R_0 to which the deepest contact's ruling bounds, inf: none") \
  X(double, asked, 3, "N, m/s", "command before the guard")                                            \
  X(double, command, 3, "N, m/s", "command")                                                           \
  X(double, facing, 3, "1", "commanded normal of the plate")                                           \
  X(double, learnt, 4, "1", "the transition law's memory, where it looks ahead")                       \
  X(int64_t, near, 1, "1", "surfaces within range, ETHD_NEAR_REFUSED: refused")                        \
  X(double, near_point, 48, "m", "their points, the deepest first")                                    \
  X(double, near_n, 48, "1", "their normals")                                                          \
  X(double, near_v, 48, "m/s", "their velocities")                                                     \
  X(int64_t, near_id, 16, "1", "their ids")                                                            \
  X(int64_t, near_material, 16, "1", "their materials")

#define ETHD_FIELD_3(type, name) type name[3];
#define ETHD_FIELD_6(type, name) type name[6];
#define ETHD_FIELD_48(type, name) type name[48];

/* One snapshot. Fields that `have` doesn't name are ignored. */
typedef struct ethd_space_sense {
  ETHD_SPACE_SENSE_FIELDS(ETHD_FIELD)
} ethd_space_sense;

/* One whole tick: a step with `sense` and the `near` surfaces (with an impossible one if they were refused) gives the
   other fields to the bit, except `overflow`. record.h has its columns. */
typedef struct ethd_space_trace {
  ethd_space_sense sense;
  ETHD_SPACE_TRACE_FIELDS(ETHD_FIELD)
} ethd_space_trace;

typedef struct ethd_space_command {
  double value[3];  /* N or m/s, by the setup's kind */
  double normal[3]; /* unit vector for a plate: the nearest surface's normal, rotated no faster than turn_rate */
  int32_t kind;     /* ethd_space_kind */
  int32_t safe;     /* 1: the device must go into its safe state: zero torque, zero speed, brakes */
} ethd_space_command;

/* ---- setup ---- */

/* X(name, unit, min, max, default, brief): the numbers of a setup, all doubles. */
#define ETHD_SPACE_NUMBERS(X)                                                                                   \
  X(period, "s", 1e-5, 0.05, 1e-3, "period of the ticks")                                                       \
  X(radius, "m", 1e-4, 1, 0.0175, "R_r: inner radius of ring or cap; of a plate, stand-off and finger radius")  \
  X(finger_radius, "m", 1e-4, 1, 0.008, "R_f")                                                                  \
  X(finger_radius_max, "m", 1e-4, 1, 0.015, "R_f,max; d_beta = R_r - R_f,max")                                  \
  X(swap_time, "s", 0, 1, 0.02, "time over which the difference of a swap fades")                               \
  X(v_hysteresis, "m/s", 0, 10, 0.005, "leaving begins below minus this speed, entering above it")              \
  X(turn_rate, "rad/s", 0, INFINITY, 6, "fastest turn of the normal that a plate is to face")                   \
  X(damping, "Ns/m", 1, 1e9, 1e4, "velocity commands: a force F of the laws is the velocity F / damping")       \
  X(speed, "m/s", 0, INFINITY, INFINITY, "limit of the speed: a faster effector is stopped, a command is cut")  \
  X(acceleration, "m/s2", 0.1, INFINITY, INFINITY, "velocity commands: limit of their change, along n first")   \
  X(force, "N", 0, INFINITY, INFINITY, "force commands: limit")                                                 \
  X(force_rate, "N/s", 0, INFINITY, INFINITY, "force commands: limit of their change")                          \
  X(x_min, "m", -INFINITY, INFINITY, -INFINITY, "workspace of the effector, x of the sense")                    \
  X(x_max, "m", -INFINITY, INFINITY, INFINITY, "")                                                              \
  X(y_min, "m", -INFINITY, INFINITY, -INFINITY, "")                                                             \
  X(y_max, "m", -INFINITY, INFINITY, INFINITY, "")                                                              \
  X(z_min, "m", -INFINITY, INFINITY, -INFINITY, "")                                                             \
  X(z_max, "m", -INFINITY, INFINITY, INFINITY, "")                                                              \
  X(reach_x, "m", -1e6, 1e6, 0, "centre of the ball that is the workspace, too")                                \
  X(reach_y, "m", -1e6, 1e6, 0, "")                                                                             \
  X(reach_z, "m", -1e6, 1e6, 0, "")                                                                             \
  X(reach, "m", 0, INFINITY, INFINITY, "its radius")                                                            \
  X(energy, "J", 1e-9, INFINITY, INFINITY, "energy that a contact may release before it is damped")             \
  X(step_time, "s", 1e-9, INFINITY, INFINITY, "time budget of one step")                                        \
  X(gap, "s", 1e-9, INFINITY, INFINITY, "longest time between two steps, by periods and by stamps")             \
  X(finger_age, "s", 1e-4, INFINITY, INFINITY, "age of the finger's reading at which tracking fades out")       \
  X(finger_lost, "s", 1e-4, INFINITY, INFINITY, "age of the finger's reading at which the effector is stopped") \
  X(clean_time, "s", 0, 1e6, 0, "time without a fault that an acknowledgement requires")                        \
  X(stop_time, "s", 1e-3, 10, 0.1, "longest stop, after which a force is removed")                              \
  X(rim, "m", 0, INFINITY, INFINITY, "cap: distance of finger and X along the axis at which the finger is out")

#define ETHD_SPACE_COUNT(name, unit, min, max, def, brief) +1
#define ETHD_SPACE_NUMBER_COUNT (0 ETHD_SPACE_NUMBERS(ETHD_SPACE_COUNT))

/* Their rows; an empty brief continues that of the row before. */
ETHD_API extern const ethd_param ethd_space_numbers[ETHD_SPACE_NUMBER_COUNT];

/* The device's ability along a contact's normal. NaN: not known. */
typedef struct ethd_ability {
  double speed;        /* m/s */
  double acceleration; /* m/s^2 */
  double delay;        /* s from a command to its motion */
  double mass;         /* kg */
  double force;        /* N */
  double friction;     /* N */
} ethd_ability;

/* Returns an ability whose numbers are all unknown (NaN). [any, rt-safe] */
ETHD_API ethd_ability ethd_ability_unknown(void) ETHD_RT;

/* Made by ethd_space_setup_default, then changed field by field. */
typedef struct ethd_space_setup {
  uint32_t cookie; /* set by ethd_space_setup_default; a setup without it is refused */
  uint32_t bytes;  /* sizeof as compiled, set by the same */
  ethd_space_kind kind;
  ethd_effector effector;
  int32_t latch; /* 1: faults latch until acknowledged; 0: each tick is judged alone (replay) */
  int32_t reserved;
#define ETHD_SPACE_NUMBER(name, unit, min, max, def, brief) double name;
  ETHD_SPACE_NUMBERS(ETHD_SPACE_NUMBER)
#undef ETHD_SPACE_NUMBER
  ethd_filter_method filter; /* of the finger's readings */
  double filter_p[ETHD_PARAMS_MAX];
  /* The laws outlive the controller. Tracking needs `force` or `velocity`, by the kind. */
  const ethd_tracking_law *tracking;
  double tracking_p[ETHD_PARAMS_MAX];
  const ethd_contact_law *contact;
  double contact_p[ETHD_PARAMS_MAX];
  const ethd_transition_law *transition;
  double transition_p[ETHD_PARAMS_MAX];
  ethd_ability ability;
  uint32_t materials; /* rows of material_p: the contact law's parameters on a surface of that material */
  double material_p[ETHD_MATERIALS_MAX][ETHD_PARAMS_MAX];
} ethd_space_setup;

/* Fills `bytes` bytes of a setup, for ethd_space_setup_default. [any] */
ETHD_API void ethd_space_setup_fill(ethd_space_setup *setup, uint32_t bytes);

/* Returns a setup with a ring under velocity commands at 1 kHz, laws follow, kelvin-voigt and approach, filter ca, the
   defaults of ETHD_SPACE_NUMBERS, an unknown ability and no material. [any] */
static inline ethd_space_setup ethd_space_setup_default(void) {
  ethd_space_setup setup;
  ethd_space_setup_fill(&setup, (uint32_t)sizeof setup);
  return setup;
}

/* Choose a law and set its parameters to their defaults, as ethd_setup_tracking does. [any] */
ETHD_API void ethd_space_tracking(ethd_space_setup *setup, const ethd_tracking_law *law);
ETHD_API void ethd_space_contact(ethd_space_setup *setup, const ethd_contact_law *law);
ETHD_API void ethd_space_transition(ethd_space_setup *setup, const ethd_transition_law *law);

/* Checks everything that create and post check: ETHD_E_RANGE, ETHD_E_NOT_FINITE with the number's name;
   ETHD_E_ARGUMENT (not made by ethd_space_setup_default, an unknown kind or effector, a law that is missing, of another
   kind, or without an entry for the setup's kind), ETHD_E_SIZE (compiled with other headers), ETHD_E_UNKNOWN (filter),
   and the statuses of ethd_law_check. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_check(const ethd_space_setup *setup, ethd_error *error);

/* Takes a device's limits that are stricter than the setup's: speed, workspace (x and y), energy, step_time, gap,
   finger_age, finger_lost, clean_time and stop_time. Those of joints and torques the device keeps itself
   (ethd_guard_joints). [any] */
ETHD_API void ethd_space_narrow(ethd_space_setup *setup, const ethd_limits *limits);

/* ---- a setup by names, as a configuration has them ---- */

#define ETHD_SPACE_PARTS 4
/* The parts chosen by id: finger_filter, tracking, contact, transition, with their offsets in ethd_space_setup. */
ETHD_API extern const ethd_setup_part ethd_space_parts[ETHD_SPACE_PARTS];

/* As ethd_setup_part_of, ethd_setup_chosen and ethd_setup_choose, with their errors (ETHD_E_...). [any] */
ETHD_API const ethd_setup_part *ethd_space_part_of(const char *section);
ETHD_API ethd_method ethd_space_chosen(const ethd_space_setup *setup, const ethd_setup_part *part);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_choose(ethd_space_setup *setup, const char *section, const char *id,
                                                       const ethd_law *const *laws, ethd_error *error);

/* As ethd_setup_key_at, ethd_setup_set and ethd_setup_get, in the key's unit, with their errors (ETHD_E_...). Names are
   "space.radius" for the numbers of ETHD_SPACE_NUMBERS, "ability.delay" for those of the ability (NaN: not known),
   "space.command" and "space.effector" for kind and effector; parameters as in the plane, "contact.k_e". [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_key_at(const ethd_space_setup *setup, uint32_t index,
                                                       ethd_setup_key *out);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_set(ethd_space_setup *setup, const char *name, double value,
                                                    ethd_error *error);
ETHD_API double ethd_space_get(const ethd_space_setup *setup, const char *name);

/* ---- the controller: as the functions ethd_control_ of the same names, for space ---- */

typedef struct ethd_space ethd_space;

/* Checks and copies the setup: the statuses of ethd_space_check, ETHD_E_MEMORY. *out is NULL then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_create(const ethd_space_setup *setup, ethd_space **out,
                                                       ethd_error *error);

/* Frees the controller; NULL is allowed. [main] */
ETHD_API void ethd_space_destroy(ethd_space *space);

/* Checks a whole setup and posts it; the next step takes it, without a jump: the command's difference fades over the
   new swap_time. ETHD_STATUS_BUSY: the last post hasn't been taken yet. The period and the kind of command can't change
   (ETHD_E_ARGUMENT). A refusal changes nothing. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_post(ethd_space *space, const ethd_space_setup *setup,
                                                     ethd_error *error);

/* Takes the next event, in order; ETHD_STATUS_EMPTY when there is none. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_space_poll(ethd_space *space, ethd_event *out);

/* Returns the period, s, of every setup that this controller has had or can get. [any, rt-safe] */
ETHD_API double ethd_space_period(const ethd_space *space) ETHD_RT;

/* Returns the kind of its commands, the same in every setup. [any, rt-safe] */
ETHD_API ethd_space_kind ethd_space_commands(const ethd_space *space) ETHD_RT;

/* Resets the state to that after create, under the setup in force. Must not be called while step runs. [main] */
ETHD_API void ethd_space_reset(ethd_space *space);

/* Resets all but the transition law's memory of the device, for a device that is enabled again. Must not be called
   while step runs. [main] */
ETHD_API void ethd_space_restart(ethd_space *space);

/* Acknowledges a latched fault, as ethd_control_acknowledge does. [any, rt-safe] */
ETHD_API void ethd_space_acknowledge(ethd_space *space) ETHD_RT;

/* Returns for how long, s, no row has called for a stop since a fault was latched; INFINITY: none is latched.
   [any, rt-safe] */
ETHD_API double ethd_space_clean_time(const ethd_space *space) ETHD_RT;

/* Runs one tick with `count` surfaces, local minima of the distance from X to the objects near it, in any order: those
   farther than a contact reaches are skipped. Always fills command; trace may be NULL. Points of one id whose normals
   differ by less than 15 deg are one contact, the deepest. A contact goes on at the surface of its id nearest to its
   last point, within R_r; if no id fits, at the nearest one with the same normal within 15 deg. Row INPUT of the fault
   table: a number that isn't finite or possible (sense.h), a normal whose length isn't 1 within 1e-6, more than
   ETHD_SURFACES_MAX surfaces, an unknown material. Returns as ethd_control_step does (ETHD_E_...). After a row whose
   reaction is STOP, a velocity command goes to zero with `acceleration`, without a limit of time, and a force command
   brakes as guard.h says; then `safe` is set. After ZERO the command is zero at once, with `safe`. [rt] */
ETHD_API ethd_status ethd_space_step(ethd_space *space, const ethd_space_sense *sense, const ethd_surface *surfaces,
                                     uint32_t count, ethd_space_command *command, ethd_space_trace *trace) ETHD_RT;

/* Runs the same tick on a copy of the state, as ethd_control_rehearse does. Returns what ethd_space_step would
   (ETHD_E_...). [rt] */
ETHD_API ethd_status ethd_space_rehearse(ethd_space *space, const ethd_space_sense *sense, const ethd_surface *surfaces,
                                         uint32_t count, ethd_space_command *command) ETHD_RT;

/* Returns the law whose code a step runs at this moment, as ethd_control_law does. [any, rt-safe] */
ETHD_API const ethd_law *ethd_space_law(const ethd_space *space) ETHD_RT;

/* Gives the counters. [any], between steps. */
ETHD_API void ethd_space_counters(const ethd_space *space, ethd_counters *out) ETHD_RT;

ETHD_END_DECLS

#endif
