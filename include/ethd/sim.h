/* The simulated device: arm, motors, ring, encoders, proximity ring, and a finger with a hand behind it.
   Links from libethd-drivers and libethd.

   Its numbers are plausible and fitted to the paper's Table 1, not measured: say so wherever one is shown.
   Plants are data (files *.plant). The finger moves on its voluntary path; when the ring pushes it aside, the hand's
   spring and damper about that path push back. Where pad and ring meet, the force is Hunt and Crossley's. The motion is
   computed in steps of power series, each from one torque update to the next or to a change of contact; ticks and
   samples are read from them. Everything is deterministic to the bit: every random number is a function of (seed, tap,
   stream, counter). Floating-point traps of the application aren't triggered. */
#ifndef ETHD_SIM_H
#define ETHD_SIM_H

#include "ethd/config.h"

ETHD_BEGIN_DECLS

/* The sensor of the finger. */
enum {
  ETHD_READING_CENTRE, /* its centre, by an unspecified sensor */
  ETHD_READING_RAYS,   /* frames of 16 distances: the paper's ring */
  ETHD_READING_ZONES,  /* a ring of on-off light barriers (Yoshikawa and Nagura 1997) */
  ETHD_READING_NAIL,   /* one distance, to a plate on the nail (Nakagawara 2005, Fang 2009) */
  ETHD_READING_CAMERA, /* positions in R_0 */
  ETHD_READING_COUNT
};

/* The speed of the hand on its synthetic path; every plant file names one. */
enum {
  ETHD_PROFILE_CONSTANT,     /* V between two ramps */
  ETHD_PROFILE_MINIMUM_JERK, /* human reaches (Flash and Hogan 1985): x0 + D (10 s^3 - 15 s^4 + 6 s^5), s = t/T */
};

#define ETHD_SIM_DELAY_PERIODS 8

typedef struct ethd_plant {
  double mass[2];                             /* kg at the ring, x (joint 1) and y (joint 2): inertia = mass L^2 */
  double coupling;                            /* H, kg m^2: inertia coupling H cos(th2 - th1) */
  double force_limit;                         /* N: torque limit of each joint / L */
  double friction, viscous;                   /* f_c N, b_v Ns/m: torque L (f_c tanh(v / 3 mm/s) + b_v v), v = L dq */
  double delay;                               /* s, measurement to torque, at most ETHD_SIM_DELAY_PERIODS periods */
  double count;                               /* rad per encoder count at the joint; 0: ideal encoders */
  int32_t count_phase;                        /* 1: the encoder's phase is drawn per tap and joint; 0: phase 0 */
  double motor_mass;                          /* kg, part of mass on the motor's side; used if stiffness is finite */
  double stiffness, damping;                  /* transmission at the ring, N/m and Ns/m; stiffness INFINITY: rigid */
  double finger_mass;                         /* kg */
  double hand_stiffness, hand_damping;        /* N/m, Ns/m about the voluntary path, x and y alike */
  double pad_stiffness, pad_damping;          /* K N/m, c s/m: K p (1 + c p_dot) */
  double finger_radius, finger_radius_sd;     /* m */
  double rate, latency, noise;                /* Hz, s, m: proximity readings of the centre */
  int32_t reading;                            /* ETHD_READING_* */
  int32_t reference;                          /* source of the sense's `ring`: 0 true ring, 1 motor side */
  double ray_noise, ray_skew;                 /* m; s from ray 0 to ray 15, in ray order */
  double start, start_sd;                     /* D0, m before the position at which the ring would meet the wall */
  double overshoot, overshoot_spread;         /* O m, s: the finger aims O exp(s g) behind it */
  int32_t profile;                            /* ETHD_PROFILE_* */
  double ramp_up, ramp_down;                  /* s, with ETHD_PROFILE_CONSTANT */
  double lateral_sd;                          /* m, y offset */
  double speed_low, speed_high, speed_spread; /* m/s, m/s, coefficient of variation: V, of ETHD_PROFILE_MINIMUM_JERK
                                                 at the position from which `start` counts */
  int32_t metrics_side;                       /* 0: the ring's true speed; 1: the encoder's (motor) side */
  double band_low, band_high;                 /* m/s: valid within 0.2 +- band_low, 0.4 +- band_high */
  /* of the sensors that a plant file doesn't describe; ethd_plant_finger fills them */
  int32_t zones;          /* light barriers, 8 to 16 */
  double zone_reach;      /* m: a barrier is on while the finger is nearer */
  double zone_hysteresis; /* share of zone_reach between switching on and, further out, switching off */
  double nail_angle;      /* rad: direction to the sensor of the plate */
  double nail_step;       /* m: one step of its converter */
} ethd_plant;

/* Reads a plant file (INI, every key required once, strict): ETHD_E_FILE, ETHD_E_SYNTAX, ETHD_E_UNKNOWN,
   ETHD_E_DUPLICATE, ETHD_E_RANGE, ETHD_E_NOT_FINITE, ETHD_E_MEMORY; message holds one line. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_plant_load(const char *path, ethd_plant *out, char message[ETHD_MESSAGE_MAX]);

/* Puts another sensor of the finger (ETHD_READING_*) into the plant, with figures of such hardware; those of the ring
   (centre, rays) are the plant's own. sim/finger.c has the sources. [any] */
ETHD_API void ethd_plant_finger(ethd_plant *plant, int32_t reading);

/* Returns the dynamics of a plant's device, for ethd_setup.dynamics. [any] */
ETHD_API ethd_dynamics ethd_plant_dynamics(const ethd_plant *plant);

/* The hand's voluntary path: the paper's synthetic reach, or samples of a recorded movement. */
typedef struct ethd_path_sample {
  double t, x, y; /* s, m, m in R_0 */
} ethd_path_sample;

typedef struct ethd_path {
  /* synthetic (sample_count = 0): from `from` to x = to_x, starts at t = 0; `speed` V, m/s, is its largest.
     ETHD_PROFILE_CONSTANT: speed V (1 - cos)/2 over ramp_up, V, the mirror image over ramp_down.
     ETHD_PROFILE_MINIMUM_JERK: T = 15/8 D / V, D = to_x - from.x */
  ethd_vec from;
  double to_x, speed, ramp_up, ramp_down;
  int32_t profile;
  /* recorded: C1 cubic interpolation (slopes of the parabola through three samples), held at both ends, where
     its slope is 0; the samples outlive the simulation */
  const ethd_path_sample *samples;
  size_t sample_count;
} ethd_path;

/* Gives position, m, and velocity, m/s, of the path at t, s, in R_0. [any, rt-safe] */
ETHD_API void ethd_path_at(const ethd_path *path, double t, ethd_vec *x, ethd_vec *v) ETHD_RT;

/* Returns when the synthetic path or the recording ends, s. [any] */
ETHD_API double ethd_path_end(const ethd_path *path);

/* The parameters of one tap. */
typedef struct ethd_sim_tap {
  uint64_t seed, tap;   /* on which all random numbers depend */
  double finger_radius; /* m */
  double phase;         /* s: first proximity sample */
  double commanded;     /* m/s: the speed that was drawn */
  ethd_path path;
} ethd_sim_tap;

/* Draws a synthetic tap at commanded speed `speed`, m/s, toward the wall that the ring meets with its centre at
   `meet`, m in R_0 (the wall on the left). Normal draws are cut at 2 sd, the speed at 2.5. A movement of minimum jerk
   that begins or ends near the wall is slower there, so that its speed never exceeds 3 times the drawn speed. [any] */
ETHD_API void ethd_sim_draw(const ethd_plant *plant, uint64_t seed, uint64_t tap, double speed, ethd_vec meet,
                            ethd_sim_tap *out);

/* Tolerances for steps of at most a period. With the first, a tap stays within 1e-8 m of the exact solution on every
   plant; with the second, within 1e-6 m on plant n. */
#define ETHD_SIM_GOLDEN 1e-10
#define ETHD_SIM_FAST 1e-4

typedef struct ethd_sim_def {
  ethd_plant plant;
  ethd_arm arm;
  double ring_radius, period;
  double step;      /* s: longest integration step */
  double tolerance; /* m/s: a step is shortened until the last term of its power series is below this; INFINITY: all
                       steps have order 4 and length `step` */
} ethd_sim_def;

typedef struct ethd_sim ethd_sim;

/* Creates a device of this plant, which isn't started yet. ETHD_E_RANGE, ETHD_E_NOT_FINITE with the name,
   ETHD_E_MEMORY. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_sim_create(const ethd_sim_def *def, ethd_sim **out, ethd_error *error);

/* Frees the device; NULL is allowed. [main] */
ETHD_API void ethd_sim_destroy(ethd_sim *sim);

/* m/s: no hand is faster, and no plant draws a faster one. Ticks of faster paths would need more and more steps. */
#define ETHD_HAND_SPEED_MAX 200.0

/* Starts a tap at time 0 with the ring centred on the finger at the start of the path, both at rest.
   ETHD_E_UNREACHABLE: the path starts out of the arm's reach. ETHD_E_RANGE: the finger doesn't fit into the ring, a
   number of the tap is negative or not finite, or the hand is faster than ETHD_HAND_SPEED_MAX, from one sample to the
   next. ETHD_E_ARGUMENT: samples that aren't finite or whose times don't rise. A refusal changes nothing. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_sim_start(ethd_sim *sim, const ethd_sim_tap *tap);

/* Measures at the present tick; the first sense has ETHD_HAVE_START. [rt] */
ETHD_API void ethd_sim_read(ethd_sim *sim, ethd_sense *out) ETHD_RT;

/* Advances by one period: the torque, Nm, takes effect `delay` after the tick. [rt] */
ETHD_API void ethd_sim_write(ethd_sim *sim, const ethd_command *command) ETHD_RT;

/* The true state at the present tick. X as in ETHD_TRACE_FIELDS. */
#define ETHD_TRUTH_FIELDS(X)                                                        \
  X(double, t, 1, "s", "time of the tap")                                           \
  X(double, ring, 2, "m", "ring centre")                                            \
  X(double, ring_v, 2, "m/s", "ring velocity")                                      \
  X(double, motor, 2, "m", "ring centre by the motor side's angles")                \
  X(double, motor_v, 2, "m/s", "its velocity")                                      \
  X(double, finger, 2, "m", "finger centre")                                        \
  X(double, finger_v, 2, "m/s", "finger velocity")                                  \
  X(double, hand, 2, "m", "voluntary path")                                         \
  X(double, pad, 1, "m", "pad penetration |X_f - X_r| - (R_r - R_f), > 0 touching") \
  X(double, pad_force, 1, "N", "between pad and ring")

typedef struct ethd_truth {
  ETHD_TRUTH_FIELDS(ETHD_FIELD)
} ethd_truth;

/* Gives the device's true state at the present tick, not that of its sensors. [any], between ticks. */
ETHD_API void ethd_sim_truth(const ethd_sim *sim, ethd_truth *out);

ETHD_END_DECLS

#endif
