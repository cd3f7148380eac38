/* Figures of a tap, from its ticks alone, so that a recording gives the same figures.

     ring's front, along n      t_r/vo            d_max = peak - next valley
            ^                     |     peak
       x_e -|---------------------x---.-'-.---------
            |                  .-'         '._.-----     valley
            +--------------------------------------> t   t_of/r: first tick with the pad touching

   The touch itself lies before t_of/r. v_of is interpolated linearly between the ticks around it, at the instant at
   which the pad's depth, also interpolated linearly, is 0. t_r/vo is the first tick with the controller's d_re < 0. A
   recorded movement may start with the ring in the wall: the tap then begins once the ring is clear of the wall by more
   than d_beta, and would be clear by more than d_beta if it were centred on the hand. */
#ifndef ETHD__APPS_TAP_METRICS_H
#define ETHD__APPS_TAP_METRICS_H

#include <stdbool.h>

#include "ethd/sim.h"

#define ETHD_TAP_REBOUND 0.1       /* s after the touch: window of v_rmin */
#define ETHD_TAP_HYSTERESIS 0.1e-3 /* m: smallest reversal that ends an extremum; a smaller oscillation doesn't count */

/* Ticks of one tap, oldest first; truth[i] belongs to trace[i]. */
typedef struct ethd__tap_rows {
  ethd_trace *trace;
  ethd_truth *truth;
  size_t count, room;
} ethd__tap_rows;

/* Decides whether a tap is valid.
     paper    the ring met the wall before the finger touched it, at the speed asked for
     finger   the hand's own path crosses the wall's touch plane at that speed, and the finger didn't touch before the
              ring was there (felt.h): a law that stops the ring before the wall is judged by the same taps */
typedef enum ethd__validity { ETHD_TAP_BY_PAPER, ETHD_TAP_BY_FINGER } ethd__validity;

/* The rule of validity of a tap. */
typedef struct ethd__rule {
  ethd_vec n;         /* of the wall, into it */
  double period;      /* s */
  int32_t side;       /* side of speed and rebound: 0 the ring, 1 the motors */
  double speed, band; /* m/s: valid if the ring meets the wall at speed +- band */
  double meet;        /* m: the ring's centre along n as it meets the wall */
  double d_beta;      /* m */
  bool never_fast;    /* the recorded movement never was that fast: too slow */
  double seen;        /* m: the finger's centre along n with its pad's front at the wall */
  ethd__validity validity;
  bool carried; /* a device's tap: the hand's path isn't known, so the finger's speed before the touch is used */
  double graze; /* s: a tap whose pad touches for less in all is grazing; 0: none */
  bool single;  /* double taps don't count */
  double lift;  /* m: a finger that leaves the wall by this after its touch and comes back makes a double tap */
} ethd__rule;

/* Finds t_r/vo tick by tick. Initially all zero; gets every tick in order. */
typedef struct ethd__approach {
  size_t count, begin; /* ticks so far; the tap's first tick, once begun */
  bool begun, met;
} ethd__approach;

/* Returns true at t_r/vo, once. */
bool ethd__approach_step(ethd__approach *approach, const ethd__rule *rule, const ethd_trace *trace,
                         const ethd_truth *truth);

#define ETHD_TAP_REASONS(X)         \
  X(OK, "ok")                       \
  X(FAULT, "fault")                 \
  X(EARLY_CONTACT, "early-contact") \
  X(TOO_SLOW, "too-slow")           \
  X(TOO_FAST, "too-fast")           \
  X(NO_CONTACT, "no-contact")       \
  X(GRAZING, "grazing")             \
  X(DOUBLE, "double")

typedef enum ethd__reason {
#define ETHD_TAP_REASON(name, word) ETHD_TAP_##name,
  ETHD_TAP_REASONS(ETHD_TAP_REASON)
#undef ETHD_TAP_REASON
      ETHD_TAP_REASON_COUNT
} ethd__reason;

extern const char *const ethd__reason_words[ETHD_TAP_REASON_COUNT];

/* The figures of a tap; NaN: not defined. Speeds and depths are along n, > 0 into the wall. */
typedef struct ethd__metrics {
  ethd__reason reason;             /* by the rule's validity: one of these two */
  ethd__reason by_ring, by_finger; /* by the paper's, by the finger's */
  double v_rvo, v_of;              /* m/s: the ring's as it meets the wall, as the finger touches it */
  double v_of_tick;                /* m/s: the ring's at t_of */
  double d_max;                    /* m: first rebound of the measured side; 0: it never reverses */
  double d_max_ring;               /* m: first rebound of the true ring */
  double v_rmin;                   /* m/s: smallest after t_of */
  double delta_s;                  /* ms: first braking tick from t_r/vo on to first vo tick; NaN: it braked before */
  double eps;                      /* m: offset at that vo tick */
  double t_rvo, t_of;              /* s of the tap */
  double t_seen;                   /* s of the tap: the finger's avatar reaches the visible wall */
  double v_hand;                   /* m/s: these three as in ethd__felt */
  double touch_depth;              /* m */
  double eps_felt;                 /* m */
  double peak_force;               /* N: largest |F_e| of the tap */
  ethd_fault fault;                /* the first of the tap */
} ethd__metrics;

void ethd__metrics_of(const ethd__tap_rows *rows, const ethd__rule *rule, ethd__metrics *out);

/* Returns the tick t_r/vo; rows->count: none. */
size_t ethd__metrics_meeting(const ethd__tap_rows *rows, const ethd__rule *rule);

#endif
