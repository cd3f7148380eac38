/* The controller: one call per tick, a pure function of its inputs and one flat block of state. Links from libethd.

     ethd_setup setup = ethd_setup_default();            a plain value: which laws, which numbers
     ethd_control_create(&setup, &control, &error);      checks and copies
     every tick: ethd_control_step(control, &sense, &command, &trace);
     any time:   ethd_control_post(control, &setup, &error);    taken whole, between two ticks
                 ethd_control_poll(control, &event);

   Per tick: estimators (positions of ring and finger) -> scene (surfaces near the ring) -> transition (shares of
   tracking and wall) -> contact (force of the wall) -> tracking (torque that follows the finger) -> guard. */
#ifndef ETHD_CONTROL_H
#define ETHD_CONTROL_H

#include <stdint.h>

#include "ethd/arm.h"
#include "ethd/estimate.h"
#include "ethd/fault.h"
#include "ethd/guard.h"
#include "ethd/law.h"
#include "ethd/scene.h"
#include "ethd/sense.h"

ETHD_BEGIN_DECLS

#define ETHD_CONTACTS_MAX 8 /* contacts at a time; the deepest are kept, the others are counted as overflow */

/* ---- setup ---- */

/* The structs that application and library write for each other. New ones come last, a struct before its members. */
#define ETHD_SIZED(X) X(sizes) X(setup) X(trace) X(sense) X(command) X(limits) X(event) X(counters)

/* Their sizes, bytes, in the headers with which a program was compiled; `sizes` is this struct's own. */
typedef struct ethd_sizes {
#define ETHD_SIZE(name) uint32_t name;
  ETHD_SIZED(ETHD_SIZE)
#undef ETHD_SIZE
} ethd_sizes;

/* Made by ethd_setup_default, then changed field by field. */
typedef struct ethd_setup {
  uint32_t cookie; /* set by ethd_setup_default; a setup without it is refused */
  uint32_t bytes;  /* set by ethd_setup_default: the first size that isn't this library's, 0: none */
  double period;   /* T, s */
  ethd_arm arm;
  double ring_radius;       /* R_r, m: inner radius */
  double finger_radius;     /* R_f, m */
  double finger_radius_max; /* R_f,max, m; d_beta = R_r - R_f,max >= 1e-5 */

  ethd_velocity_method velocity;
  double velocity_p[ETHD_PARAMS_MAX];
  ethd_fit_method fit;
  double fit_p[ETHD_PARAMS_MAX];
  double ray_lag[ETHD_RAYS]; /* s from ray k's measurement to sample_ns, -0.01 to 0.01 */
  ethd_filter_method filter;
  double filter_p[ETHD_PARAMS_MAX];

  /* The laws outlive the controller. */
  const ethd_tracking_law *tracking;
  double tracking_p[ETHD_PARAMS_MAX];
  const ethd_contact_law *contact;
  double contact_p[ETHD_PARAMS_MAX];
  const ethd_transition_law *transition;
  double transition_p[ETHD_PARAMS_MAX];
  double swap_time;    /* s: duration of a swap's fade, 0 to 1 */
  double v_hysteresis; /* m/s: leaving begins where v < -v_hysteresis, entering where v > v_hysteresis */

  /* NULL: none. Scenes live until an event hands them back. */
  const ethd_scene *scene;                   /* stands still, in R_0 */
  const ethd_scene *bodies[ETHD_BODIES_MAX]; /* each moves as a rigid body; its pose comes with the sense */
  ethd_limits limits;
  ethd_dynamics dynamics;
} ethd_setup;

/* Returns a setup with a parallel 0.25 m arm, lowpass, kasa, ca, pd, kelvin-voigt, offset, no scene, no limits, at
   1 kHz. If a program was compiled with headers in which a struct of ETHD_SIZED has another size than in this library,
   it gets a setup that every function refuses (ETHD_E_SIZE, with the struct's name and its bytes in program and
   library); nothing else of its memory is written. Compile it again with this version's headers. [any] */
static inline ethd_setup ethd_setup_default(void);

/* Fills a setup of sizes->setup bytes, for ethd_setup_default. [any] */
ETHD_API void ethd_setup_fill(ethd_setup *setup, const ethd_sizes *sizes);

/* Checks a program's sizes against the library's: ETHD_E_SIZE as above. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_sizes_check(const ethd_sizes *sizes, ethd_error *error);

/* Choose a law or a method and set its parameters to their defaults. An invalid one (NULL, a number beyond the methods,
   a law with too many parameters) is refused later, by ethd_setup_check. A refused setup isn't changed. [any] */
ETHD_API void ethd_setup_tracking(ethd_setup *setup, const ethd_tracking_law *law);
ETHD_API void ethd_setup_contact(ethd_setup *setup, const ethd_contact_law *law);
ETHD_API void ethd_setup_transition(ethd_setup *setup, const ethd_transition_law *law);
ETHD_API void ethd_setup_velocity(ethd_setup *setup, ethd_velocity_method method);
ETHD_API void ethd_setup_fit(ethd_setup *setup, ethd_fit_method method);
ETHD_API void ethd_setup_filter(ethd_setup *setup, ethd_filter_method method);

/* ---- a setup by names, as a configuration has them ---- */

/* A part of a setup that is chosen by its id and has parameters of its own: three methods, three laws. */
typedef struct ethd_setup_part {
  const char *section, *chooser; /* "velocity", "method"; "contact", "law" */
  const ethd_method *methods;    /* the methods to choose from; NULL: a law of `kind` is chosen */
  uint32_t count;                /* of methods */
  ethd_kind kind;                /* of laws */
  uint32_t chosen, values;       /* offsets of the choice and its parameters in ethd_setup, bytes */
} ethd_setup_part;

#define ETHD_SETUP_PARTS 6
ETHD_API extern const ethd_setup_part ethd_setup_parts[ETHD_SETUP_PARTS];

/* Returns the part of a section, NULL if the section has nothing to choose. [any] */
ETHD_API const ethd_setup_part *ethd_setup_part_of(const char *section);

/* Returns the setup's choice for this part; all zero if it is a law that is NULL. [any] */
ETHD_API ethd_method ethd_setup_chosen(const ethd_setup *setup, const ethd_setup_part *part);

/* Chooses by id, with default parameters: a method ("velocity", "lsq"), or one of `laws` ("contact", "spring"),
   which end with NULL (ethd_laws, or those of a configuration). ETHD_E_UNKNOWN with the section or the id as
   name; the setup is then untouched. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_setup_choose(ethd_setup *setup, const char *section, const char *id,
                                                       const ethd_law *const *laws, ethd_error *error);

/* One number of a setup, or several under one name. */
typedef struct ethd_setup_key {
  const char *section; /* "contact" */
  ethd_param param;    /* "k_e", with its unit and range; def is NaN for limits */
  uint32_t count;      /* 1, or how many numbers the key holds: workspace 4, reach 2, joints 4, lag 16 */
} ethd_setup_key;

/* Gives the numeric keys of the chosen laws and methods one by one, with `index` from 0 on;
   ETHD_STATUS_EMPTY after the last. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_setup_key_at(const ethd_setup *setup, uint32_t index, ethd_setup_key *out);

/* Sets one number, in its key's unit (ethd_setup_key), by its name in the configuration: "contact.k_e", "ring.radius",
   "limits.torque"; the third of four is "limits.workspace[2]". A choice of words ("tracking.derivative") takes the
   word's index. ETHD_E_UNKNOWN: no such key under the chosen laws. ETHD_E_ARGUMENT: a key of several numbers without
   index, or a setup that ethd_setup_default didn't make. ETHD_E_RANGE, ETHD_E_NOT_FINITE: the value or the index isn't
   in its range, as `error` says. Relations between numbers are left to ethd_setup_check. A refusal changes nothing.
   [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_setup_set(ethd_setup *setup, const char *name, double value,
                                                    ethd_error *error);

/* Returns the number of that name in its key's unit (ethd_setup_key), NaN where ethd_setup_set would not find it.
   [main] */
ETHD_API double ethd_setup_get(const ethd_setup *setup, const char *name);

/* Returns the distance from the ring's centre, m, beyond which no contact can count while the finger is in the ring:
   2 R_r + d_beta, or more for a law that looks ahead; NaN for a setup that ethd_setup_default didn't make.
   It is the radius for ethd_scene_prune. [any] */
ETHD_API double ethd_setup_range(const ethd_setup *setup);

/* Checks all that create and post check, except the time of a stop; also the scenes' materials against the contact law.
   Names in errors are those of the configuration ("contact.k_e"): ETHD_E_RANGE, ETHD_E_NOT_FINITE, ETHD_E_ARGUMENT (a
   setup that ethd_setup_default didn't make, a law that is missing or of another kind), ETHD_E_SIZE
   (ethd_setup_default), ETHD_E_UNKNOWN (no such method; a material's key that the law doesn't have), the statuses of
   ethd_law_check, and what a law's own check returns. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_setup_check(const ethd_setup *setup, ethd_error *error);

/* ---- events ---- */

typedef enum ethd_event_kind {
  ETHD_EVENT_FAULT = 1,   /* an occurrence of a fault. code: ethd_fault; value: see fault.h */
  ETHD_EVENT_TAKEN = 2,   /* a posted setup is in force from this tick on; scene: the replaced one, if unused now */
  ETHD_EVENT_CLEARED = 3, /* faults were acknowledged */
  ETHD_EVENT_RELEASED = 4 /* scene: that of a replaced body, unused now */
} ethd_event_kind;

typedef struct ethd_event {
  ethd_event_kind kind;
  int32_t code;
  int64_t tick;
  double value;
  const ethd_scene *scene; /* [main] may free it now; NULL: none */
} ethd_event;

/* Numbers of ticks with each condition since create or reset; for faults, numbers of occurrences. */
typedef struct ethd_counters {
  uint64_t ticks, queried, swaps, contacts_lost, readings_dropped, events_dropped;
  uint64_t faults[ETHD_FAULT_COUNT];
  uint64_t guard[ETHD_GUARD_COUNT];
} ethd_counters;

/* Returns the sizes that these headers have. [any] */
static inline ethd_sizes ethd_sizes_here(void) {
#define ETHD_SIZE(name) (uint32_t)sizeof(ethd_##name),
  const ethd_sizes sizes = {ETHD_SIZED(ETHD_SIZE)};
#undef ETHD_SIZE
  return sizes;
}

static inline ethd_setup ethd_setup_default(void) {
  ethd_setup setup;
  const ethd_sizes sizes = ethd_sizes_here();
  ethd_setup_fill(&setup, &sizes);
  return setup;
}

/* ---- the controller ---- */

typedef struct ethd_control ethd_control;

/* Checks and copies the setup: the statuses of ethd_setup_check, ETHD_E_MEMORY, and ETHD_E_RANGE if limits.stop_time is
   shorter than the time in which full torque brakes a known mass from limits.speed (ethd_guard_brake_time). *out is
   NULL then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_control_create(const ethd_setup *setup, ethd_control **out,
                                                         ethd_error *error);

/* Frees the controller; NULL is allowed. The scenes stay the application's. [main] */
ETHD_API void ethd_control_destroy(ethd_control *control);

/* Checks a whole setup and posts it; the next step takes it, without a jump. At that tick the torque is the one of the
   old setup under its own limits, and the difference to the new setup's torque fades linearly to 0 over the new
   swap_time. Until then a torque may exceed a limit that became narrower, by the remaining share of the fade; a new
   torque_rate holds at once. The post waits while unpolled events leave no room for the events that return scenes.
   ETHD_STATUS_BUSY: the last post hasn't been taken yet; post again. A refusal, also one of ethd_setup_check, changes
   nothing. The period can't change (ETHD_E_ARGUMENT). A replaced scene may be posted again only after an event has
   returned it, since that event may come at any moment. Takes nothing from the heap. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_control_post(ethd_control *control, const ethd_setup *setup,
                                                       ethd_error *error);

/* Takes the next event, in order; ETHD_STATUS_EMPTY when there is none. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_control_poll(ethd_control *control, ethd_event *out);

/* Returns the period, s, of every setup that this controller has had or can get. [any, rt-safe] */
ETHD_API double ethd_control_period(const ethd_control *control) ETHD_RT;

/* Resets the state to that after create, under the setup in force; a posted one stays posted. Must not be called
   while step runs. [main] */
ETHD_API void ethd_control_reset(ethd_control *control);

/* Resets all but the motors' heat and the transition law's memory of the device, for a device that is enabled again.
   Must not be called while step runs. [main] */
ETHD_API void ethd_control_restart(ethd_control *control);

/* Gives the motors' heat by the model of limits.nominal_torque and heat_time: each motor's temperature rise over its
   surroundings, as a share of the final rise under the nominal torque. Must not be called while step runs. [main] */
ETHD_API void ethd_control_heat(const ethd_control *control, double out[2]);

/* Sets the motors' heat, in shares as ethd_control_heat gives it, for a replay that begins in the middle; a share that
   isn't a number, or is below 0, counts as 2, too hot. Must not be called while step runs. [main] */
ETHD_API void ethd_control_set_heat(ethd_control *control, const double heat[2]);

/* Gives the transition law's memory of the device (ethd_facts.memory), in the law's own units; restart keeps it, reset
   clears it. Must not be called while step runs. [main] */
ETHD_API void ethd_control_memory(const ethd_control *control, double out[ETHD_MEMORY]);

/* Sets the transition law's memory, in the law's own units, for a replay that begins in the middle. Must not be
   called while step runs. [main] */
ETHD_API void ethd_control_set_memory(ethd_control *control, const double memory[ETHD_MEMORY]);

/* Acknowledges a latched fault. If limits.clean_time is over at the next step, that step clears the fault, and the
   torque rises from zero: the laws' torque is multiplied by a share that grows from 0 to 1 over swap_time. If it isn't
   over, the acknowledgement is dropped. [any, rt-safe] */
ETHD_API void ethd_control_acknowledge(ethd_control *control) ETHD_RT;

/* Returns for how long, s, no row has called for a stop since a fault was latched; INFINITY: none is latched.
   [any, rt-safe] */
ETHD_API double ethd_control_clean_time(const ethd_control *control) ETHD_RT;

/* Runs one tick and always fills command; trace may be NULL. In any floating-point mode of the thread (rounding, traps,
   FTZ and DAZ) a tick rounds to nearest, takes subnormal numbers as 0 and has no traps, so that its bytes don't depend
   on the mode. It then restores the thread's mode; flags aren't promised. The same holds for create, post, check,
   reset, restart and rehearse, for making scenes (scene.h), and for the functions of guard.h, arm.h and the estimators,
   whose arguments may be NaN or infinite. A negative status says that this tick ends with a fault, and which:
   ETHD_E_NOT_FINITE, ETHD_E_LAW, ETHD_E_BUDGET, ETHD_E_RANGE (the guard stops the ring), ETHD_E_DEVICE (any other row
   of the fault table). The command is then zero torque with `safe` set. While a stop still brakes the ring, it is the
   stop's torque, which may be zero, without `safe`. [rt] */
ETHD_API ethd_status ethd_control_step(ethd_control *control, const ethd_sense *sense, ethd_command *command,
                                       ethd_trace *trace) ETHD_RT;

/* Runs the same tick on a copy of the state, which changes nothing and makes no event; it warms the caches before
   arming. Returns what ethd_control_step would (ETHD_E_...). [rt] */
ETHD_API ethd_status ethd_control_rehearse(ethd_control *control, const ethd_sense *sense,
                                           ethd_command *command) ETHD_RT;

/* Returns the law whose code a step runs at this moment, NULL if it is a built-in law or none. If a step doesn't
   return, it hangs in this law. [any, rt-safe] */
ETHD_API const ethd_law *ethd_control_law(const ethd_control *control) ETHD_RT;

/* Gives the counters. [any], between steps. */
ETHD_API void ethd_control_counters(const ethd_control *control, ethd_counters *out) ETHD_RT;

ETHD_END_DECLS

#endif
