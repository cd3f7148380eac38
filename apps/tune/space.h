/* The search space: keys of a configuration, each with a range, and points in their box. All
   [main]. */
#ifndef ETHD__APPS_TUNE_SPACE_H
#define ETHD__APPS_TUNE_SPACE_H

#include "tap/study.h"

#define ETHD_TUNE_KEYS_MAX 16
#define ETHD_TUNE_KEY_MAX 64
#define ETHD_TUNE_VALUE_MAX 32

/* The keys that are tuned unless --range says otherwise. X(name, the least share of its own value, the largest
   multiple, benefit and cost of a larger value). */
#define ETHD_TUNE_KNOWN(X)                                                                  \
  X("tracking.k_t", 0.5, 8, "less lag and fewer early contacts; it costs a rougher torque") \
  X("tracking.b_t", 0.5, 8, "a ring that oscillates less; it costs noticeable counts")      \
  X("contact.k_e", 1, 4, "a harder wall; it costs rebound")                                 \
  X("contact.b_e", 0.5, 4, "less depth on entering; it costs margin")                       \
  X("transition.b_d", 0.5, 3, "a shorter stop, until the motors saturate; it costs margin") \
  X("velocity.cutoff", 0.5, 3, "less speed lag, more margin; it costs noticeable counts")   \
  X("finger_filter.acceleration", 0.2, 20, "a finger followed sooner; it costs sensor noise")

typedef struct ethd__tune_key {
  char name[ETHD_TUNE_KEY_MAX]; /* "tracking.k_t" */
  double own, low, high;        /* the configuration's value; the range, 0 < low <= high */
} ethd__tune_key;

typedef struct ethd__tune_space {
  const ethd_config *config;
  const char *law; /* transition */
  ethd__tune_key keys[ETHD_TUNE_KEYS_MAX];
  size_t count;
} ethd__tune_space;

/* A value for each key of the space. */
typedef struct ethd__tune_point {
  double value[ETHD_TUNE_KEYS_MAX];
} ethd__tune_point;

/* Opens the space of the gains and cut-offs that the setup's laws and estimators have. Contact stiffness isn't lowered:
   a softer wall bounces less and is a worse wall. Refuses an unknown law and a setup with nothing to tune. */
ETHD_MUST_CHECK ethd_status ethd__space_open(const ethd_config *config, const char *law, ethd__tune_space *out,
                                             char message[ETHD_MESSAGE_MAX]);

/* Gives a key that the space has the range from `share` of its own value to that value. */
void ethd__space_lower(ethd__tune_space *space, const char *name, double share);

/* Reads "contact.k_e=500:4000", which sets the range of a key, or "contact.k_e=1000", which holds it; a key that the
   space lacks is added. Refuses values that the configuration refuses. */
ETHD_MUST_CHECK ethd_status ethd__space_range(ethd__tune_space *space, const char *text,
                                              char message[ETHD_MESSAGE_MAX]);

/* Returns the configuration's own point. */
ethd__tune_point ethd__space_own(const ethd__tune_space *space);

/* Returns point i of a sequence that fills the box evenly, in the logarithms of the values (the additive recurrence of
   M. Roberts, 2018: multiples of the powers of the root of x^(d+1) = x + 1). */
ethd__tune_point ethd__space_at(const ethd__tune_space *space, uint64_t i);

/* Returns a point near another: each logarithm moved by at most `spread` of its range. A function of `number`. */
ethd__tune_point ethd__space_near(const ethd__tune_space *space, const ethd__tune_point *point, double spread,
                                  uint64_t number);

/* Writes a value as text with four digits, the precision of points. */
const char *ethd__space_text(double value, char out[ETHD_TUNE_VALUE_MAX]);

/* A point as the gains of a study; gains[] points into the space and into text[]. */
typedef struct ethd__tune_gains {
  char text[ETHD_TUNE_KEYS_MAX][ETHD_TUNE_VALUE_MAX];
  ethd__gain gains[ETHD_TUNE_KEYS_MAX];
} ethd__tune_gains;

void ethd__space_gains(const ethd__tune_space *space, const ethd__tune_point *point, ethd__tune_gains *out);

/* Fills the configuration's setup at the point. */
ETHD_MUST_CHECK ethd_status ethd__space_setup(const ethd__tune_space *space, const ethd__tune_point *point,
                                              ethd_setup *out, char message[ETHD_MESSAGE_MAX]);

#endif
