/* Which numbers of a plant and its controller may be varied to explain the paper, within which bounds, and why. All
   [main]. */
#ifndef ETHD__APPS_EXPLAIN_PRIOR_H
#define ETHD__APPS_EXPLAIN_PRIOR_H

#include "tap/study.h"

/* Bounds are stated before the search. "The paper" is its section 4.1: two Maxon RE-35 motors, cable capstans, links of
   0.25 m, encoders of 1000 lines, a ring of 24 mm, sixteen proximity sensors read at 300 Hz over a bus of 400 kbit/s,
   1 kHz under Xenomai. X(name, low, high, scale, unit, origin); LOG: draws are even in the logarithm. */
#define ETHD_EXPLAIN_PRIORS(X)                                                                                      \
  X(mass, 0.1, 0.5, LOG, "kg at the ring",                                                                          \
    "two links of 0.25 m, capstans and a ring; rotors of 6.8 g cm^2 times ratio^2")                                 \
  X(deceleration, 25, 100, LOG, "m/s^2, F_sat/m", "an RE-35 gives 0.1 Nm for hours and three times that briefly")   \
  X(friction, 0.03, 1.5, LOG, "N at the ring", "brushes and capstans; the paper calls it very transparent")         \
  X(viscous, 0.01, 3, LOG, "Ns/m at the ring", "likewise")                                                          \
  X(delay, 0.05e-3, 4e-3, LOG, "s from measurement to torque",                                                      \
    "a library, a servo-drive and its current loop at 1 kHz: under a tick to some")                                 \
  X(ratio, 6, 25, LOG, "of the capstan; 4000 counts a motor's turn", "what encoders and motors of the paper allow") \
  X(finger_mass, 0.015, 0.12, LOG, "kg", "a finger to a finger with a part of the hand")                            \
  X(hand_stiffness, 30, 600, LOG, "N/m", "relaxed to tense")                                                        \
  X(hand_damping, 0.5, 12, LOG, "Ns/m", "likewise")                                                                 \
  X(pad_stiffness, 3e3, 6e4, LOG, "N/m", "a fingertip's pulp at some newtons")                                      \
  X(pad_damping, 0.05, 2, LOG, "s/m", "likewise")                                                                   \
  X(finger_radius, 6e-3, 9e-3, EVEN, "m", "index fingers of adults")                                                \
  X(latency, 0.5e-3, 6e-3, LOG, "s", "sixteen readings over the paper's bus, and their polygon")                    \
  X(start, 20e-3, 100e-3, LOG, "m", "a wall some centimetres away")                                                 \
  X(overshoot, 8e-3, 100e-3, LOG, "m", "how far behind the wall a tap aims")                                        \
  X(overshoot_spread, 0.2, 0.7, EVEN, "1", "likewise")                                                              \
  X(speed_low, 0.17, 0.24, EVEN, "m/s", "0.2 was asked for")                                                        \
  X(speed_high, 0.35, 0.6, EVEN, "m/s", "0.4 was asked for, and a quarter of the taps was valid")                   \
  X(speed_spread, 0.08, 0.3, EVEN, "1", "likewise")                                                                 \
  X(band_low, 0.02, 0.06, EVEN, "m/s about 0.2", "what the paper calls a correct speed isn't said")                 \
  X(band_high, 0.03, 0.08, EVEN, "m/s about 0.4", "likewise")                                                       \
  X(cutoff, 30, 500, LOG, "Hz of the speed's low-pass", "not published")                                            \
  X(acceleration, 0.5, 100, LOG, "m/s^2 of the finger's filter", "not published")                                   \
  X(d_beta, 0.5e-3, 4e-3, LOG, "m", "R_f,max isn't published")                                                      \
  X(motor_share, 0.05, 0.6, LOG, "of the mass on the motors' side",                                                 \
    "compliant transmissions only: rotors times ratio^2")                                                           \
  X(resonance, 30, 300, LOG, "Hz, the two sides against each other", "compliant only: cables of a capstan")         \
  X(damping_ratio, 0.01, 0.5, LOG, "1", "likewise")

enum {
#define ETHD_EXPLAIN_INDEX(name, low, high, scale, unit, origin) ETHD_EXPLAIN_##name,
  ETHD_EXPLAIN_PRIORS(ETHD_EXPLAIN_INDEX)
#undef ETHD_EXPLAIN_INDEX
      ETHD_EXPLAIN_NUMBERS
};

typedef struct ethd__explain_prior {
  const char *name;
  double low, high;
  bool logarithmic;
  const char *unit, *origin;
} ethd__explain_prior;

extern ethd__explain_prior ethd__explain_priors[ETHD_EXPLAIN_NUMBERS];

/* Takes other bounds, NAME=LOW:HIGH, before anything is made. False: that isn't such a text, or no number's name, or no
   bounds of it. */
bool ethd__explain_bound(const char *text);

/* What the search doesn't vary. */
typedef struct ethd__explain_structure {
  bool compliant; /* the transmission gives way, and the encoders sit on the motors' side */
  bool tick;      /* a reading counts from where the ring is now, as X_f/r is read: its age is inside the loop */
} ethd__explain_structure;

/* Each number as a share of its bounds, 0 to 1. */
typedef struct ethd__explain_point {
  double share[ETHD_EXPLAIN_NUMBERS];
} ethd__explain_point;

double ethd__explain_value(const ethd__explain_point *point, int number);

/* Returns plant p, or n where the transmission is rigid, moved into the bounds; a search has it among its first
   points. */
ethd__explain_point ethd__explain_known(const ethd__explain_structure *structure);

#define ETHD_EXPLAIN_SETTINGS 5

/* A plant, and the keys in which its controller differs from the configuration; `gains` points into `text`. */
typedef struct ethd__explain_twin {
  ethd_plant plant;
  size_t gain_count;
  char text[ETHD_EXPLAIN_SETTINGS][32];
  ethd__gain gains[ETHD_EXPLAIN_SETTINGS];
} ethd__explain_twin;

/* Fills the plant and its keys at a point; `base` has the plant's numbers that aren't varied. */
void ethd__explain_make(const ethd_plant *base, const ethd__explain_structure *structure,
                        const ethd__explain_point *point, ethd__explain_twin *out);

/* Writes PATH.plant and PATH.ini, each number with its bounds and where they come from. */
ETHD_MUST_CHECK ethd_status ethd__explain_write(const char *path, const ethd__explain_point *point,
                                                const ethd__explain_twin *twin, char message[ETHD_MESSAGE_MAX]);

#endif
