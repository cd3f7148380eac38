/* Judges a point of the space by its margins and by figures of simulated taps. All [main]. */
#ifndef ETHD__APPS_TUNE_SCORE_H
#define ETHD__APPS_TUNE_SCORE_H

#include "bounds/loops.h"
#include "tune/space.h"

#define ETHD_TUNE_SPEEDS 2 /* low and high */

/* Every figure is better when it is smaller, and there is one for each speed. X(name, unit, description). They are
   means over the taps whose hand path crosses the wall at about that speed; eps, delta_s, d_max and v_touch over those
   with a touch that isn't early. */
#define ETHD_TUNE_FIGURES(X)                                                              \
  X(early, "1", "share of the taps with a touch before the ring meets the wall")          \
  X(lag, "m", "distance of ring and finger centres, rms, over the 50 ms before the wall") \
  X(eps, "m", "wall's offset 60 ms after the touch")                                      \
  X(delta_s, "ms", "time of braking; 0 for a law that doesn't brake")                     \
  X(d_max, "m", "first rebound")                                                          \
  X(v_touch, "m/s", "size of the ring's speed as the finger touches")                     \
  X(rough, "Nm", "change of the torque from tick to tick, rms, over these 50 ms and the tap's last 50 ms")

typedef struct ethd__tune_score {
#define ETHD_TUNE_FIGURE(name, unit, brief) double name[ETHD_TUNE_SPEEDS];
  ETHD_TUNE_FIGURES(ETHD_TUNE_FIGURE)
#undef ETHD_TUNE_FIGURE
  double taps, touched; /* taps at each speed; taps of both speeds with a touch */
} ethd__tune_score;

#define ETHD_TUNE_FIGURE_COUNT (sizeof(ethd__tune_score) / sizeof(double))

extern const char *const ethd__tune_figure_names[ETHD_TUNE_FIGURE_COUNT];

/* Hands that press against the ring, as shares of the plant's finger mass, hand stiffness and damping. 0: a free
   ring. */
typedef struct ethd__tune_hands {
  double shares[8];
  size_t count;
} ethd__tune_hands;

typedef struct ethd__tune_rig {
  const ethd__study *study; /* two speeds, without gains */
  const ethd__tune_space *space;
  ethd__tune_hands hands;
  ethd__bounds_margin margin;
  bool passive; /* the wall is to be passive with the device's own viscous friction (Colgate and Schenkel) */
} ethd__tune_rig;

/* Lowers the range of the damping gain of every loop that doesn't keep the margin with the configuration's own gains,
   so that the search finds gains that do. */
void ethd__score_widen(const ethd__tune_rig *rig, ethd__tune_space *space);

/* Returns whether every loop, along each axis, keeps the margin, free and with each hand's mass against the ring. It
   returns false also for a setup that the configuration refuses. */
bool ethd__score_keeps(const ethd__tune_rig *rig, const ethd__tune_point *point);

/* Runs taps 0 to taps - 1 at each speed. */
ETHD_MUST_CHECK ethd_status ethd__score_run(const ethd__tune_rig *rig, const ethd__tune_point *point, uint32_t taps,
                                            ethd__tune_score *out, char message[ETHD_MESSAGE_MAX]);

/* The result of trying a point's margins in time. */
typedef struct ethd__tune_verdict {
  bool settles;
  const char *what; /* the quantity at its margin in the last try */
  double hand;      /* the hand's share in that try */
  double swing;     /* m/s rms: speed of the ring at the end of a tap in that try */
} ethd__tune_verdict;

/* Tries the same margins on the whole device in time: taps with gains `margin.gain` times as large, with torques
   `margin.delay` later, with each hand. The point settles if the ring comes to rest in the wall in all of them. */
ETHD_MUST_CHECK ethd_status ethd__score_confirm(const ethd__tune_rig *rig, const ethd__tune_point *point,
                                                ethd__tune_verdict *out, char message[ETHD_MESSAGE_MAX]);

/* The four goals. Each is the mean logarithm of figures over those of a reference: 0 is as good, less is better. */
typedef enum ethd__tune_goal {
  ETHD_TUNE_TRACKING,
  ETHD_TUNE_BRAKE,
  ETHD_TUNE_WALL,
  ETHD_TUNE_CALM,
  ETHD_TUNE_GOALS
} ethd__tune_goal;

extern const char *const ethd__tune_goal_names[ETHD_TUNE_GOALS];

/* Fills the goals; INFINITY if too few fingers touched (under a quarter of the reference's). */
void ethd__score_goals(const ethd__tune_score *score, const ethd__tune_score *reference, double out[ETHD_TUNE_GOALS]);

#endif
