#include "study/people.h"

#include <math.h>

#include "ethd/maths.h"
#include "sim/random.h"

#define CUT 2.0 /* sd, as for taps */

/* Random streams of a person; those of a tap have another key. */
enum { SEED, RADIUS, PACE, REACH, STIFFNESS, DAMPING, BELOW };

uint64_t ethd__person_seed(uint64_t seed, uint32_t person) {
  const ethd__sim_key key = {seed, person};
  return (uint64_t)(ethd__uniform(key, SEED, 0) * 0x1p53);
}

uint32_t ethd__person_below(uint64_t seed, uint32_t person, uint32_t index, uint32_t count) {
  const ethd__sim_key key = {seed, person};
  return (uint32_t)(ethd__uniform(key, BELOW, index) * count);
}

ethd_plant ethd__person_plant(const ethd_plant *plant, uint64_t seed, uint32_t person, double between,
                              double hand_spread) {
  const ethd__sim_key key = {seed, person};
  ethd_plant own = *plant;
  double of = sqrt(between), within = sqrt(1 - between);
  double pace = 1 + of * plant->speed_spread * ethd__normal_cut(key, PACE, CUT);
  own.finger_radius += plant->finger_radius_sd * ethd__normal_cut(key, RADIUS, CUT);
  own.finger_radius_sd = 0;
  own.speed_low *= pace;
  own.speed_high *= pace;
  own.speed_spread *= within;
  own.overshoot *= ethd_exp(of * plant->overshoot_spread * ethd__normal_cut(key, REACH, CUT));
  own.overshoot_spread *= within;
  own.hand_stiffness *= ethd_exp(hand_spread * ethd__normal_cut(key, STIFFNESS, CUT));
  own.hand_damping *= ethd_exp(hand_spread * ethd__normal_cut(key, DAMPING, CUT));
  return own;
}
