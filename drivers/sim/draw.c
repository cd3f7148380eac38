#include "ethd/maths.h"
#include "ethd/sim.h"
#include "sim/random.h"

#define CUT 2.0       /* sd */
#define CUT_SPEED 2.5 /* sd */
#define SLOWED 3.0    /* largest ratio of a minimum-jerk movement's top speed to its speed at the wall */

/* Returns the largest speed of a movement of minimum jerk over its speed after this share of its length. */
static double largest(double share) {
  double low = 0, high = 1;
  for (int i = 0; i < 53; i++) {
    double s = (low + high) / 2;
    if (s * s * s * (10 + s * (6 * s - 15)) < share)
      low = s;
    else
      high = s;
  }
  double speed = 16 * low * low * (1 - low) * (1 - low);
  return speed * SLOWED > 1 ? 1 / speed : SLOWED;
}

void ethd_sim_draw(const ethd_plant *plant, uint64_t seed, uint64_t tap, double speed, ethd_vec meet,
                   ethd_sim_tap *out) {
  ethd__sim_key key = {seed, tap};
  double start = plant->start + plant->start_sd * ethd__normal_cut(key, ETHD__STREAM_START, CUT);
  double spread = plant->overshoot_spread * ethd__normal_cut(key, ETHD__STREAM_OVERSHOOT, CUT);
  double lateral = plant->lateral_sd * ethd__normal_cut(key, ETHD__STREAM_LATERAL, CUT);
  double radius = plant->finger_radius_sd * ethd__normal_cut(key, ETHD__STREAM_RADIUS, CUT);
  double pace = plant->speed_spread * ethd__normal_cut(key, ETHD__STREAM_SPEED, CUT_SPEED);
  *out = (ethd_sim_tap){.seed = seed, .tap = tap};
  out->finger_radius = plant->finger_radius + radius;
  out->phase = ethd__uniform(key, ETHD__STREAM_PHASE, 0) / plant->rate;
  out->commanded = speed * (1 + pace);
  out->path = (ethd_path){.from = {meet.x + start, meet.y + lateral},
                          .to_x = meet.x - plant->overshoot * ethd_exp(spread),
                          .speed = out->commanded,
                          .profile = plant->profile,
                          .ramp_up = plant->ramp_up,
                          .ramp_down = plant->ramp_down};
  if (plant->profile == ETHD_PROFILE_CONSTANT) return;
  double share = start / (out->path.from.x - out->path.to_x);
  out->path.speed = fmin(ETHD_HAND_SPEED_MAX, out->commanded * largest(share));
}
