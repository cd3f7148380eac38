/* Predictions side by side are those that the simulator makes one by one, for every kind of arm; a plant that runs away
   stands still, and what is beside it is told nothing wrong of its own past. */
#include <math.h>
#include <string.h>

#include "identify/predict.h"
#include "unit/suite.h"

enum { TICKS = 250, BACK = 8 };

static double q[TICKS + BACK][2], torque[TICKS + BACK][2];
static ethd__evidence evidence;
static const ethd__shot shot = {BACK, 0, TICKS + BACK, TICKS, 0};

static void begin(bool serial) {
  evidence =
      (ethd__evidence){.arm = {.mechanism = serial ? ETHD_ARM_SERIAL : ETHD_ARM_PARALLEL, .link1 = 0.25, .link2 = 0.2},
                       .period = 1e-3,
                       .ring_radius = 0.014,
                       .q = q,
                       .torque = torque,
                       .count = TICKS + BACK};
  for (int k = 0; k < TICKS + BACK; k++)
    for (int j = 0; j < 2; j++)
      torque[k][j] = 0.3 * sin(0.021 * k + j) + 0.2 * sin(0.4 * k + 2 * j) + 0.15 * sin(1.1 * k);
}

static ethd_plant plant_of(bool elastic, double coupling) {
  ethd_plant p = {.mass = {0.12, 0.2},
                  .coupling = coupling,
                  .force_limit = 2,
                  .friction = 0.3,
                  .viscous = 0.8,
                  .delay = 0.31e-3,
                  .stiffness = (double)INFINITY};
  if (!elastic) return p;
  p.motor_mass = 0.02;
  p.stiffness = 3000;
  p.damping = 4;
  return p;
}

/* m at the end of a link of 0.25 m; the tolerance of both is 1e-10 m/s. */
static double farthest(const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < 2 * TICKS; i++) most = fmax(most, 0.25 * fabs(a[i] - b[i]));
  return most;
}

TEST_LOOP(alike, 0, 8) {
  bool serial = _i & 1, elastic = _i & 2, coupled = _i & 4;
  const double states[ETHD__ARMS][ETHD__STATE_MOST] = {
      {1.4, 0.2, 0.3, -0.2}, {1.4, 0.2, 0.3, -0.2}, {1.5, 0.2, 0, 0}, {1.4, 0.1, -0.3, 0.4, 1e-3, 0, 0, 0.01}};
  double one[2 * TICKS], all[ETHD__ARMS][2 * TICKS];
  ethd__predictor p[ETHD__ARMS];
  ethd__forecast f[ETHD__ARMS];
  begin(serial);
  for (int i = 0; i < ETHD__ARMS; i++) {
    ethd_plant plant = plant_of(elastic, coupled ? 2e-3 : 0);
    if (i == 1) plant.delay += 0.8e-3; /* of another tick */
    if (i == 2) plant.mass[1] *= 1.1;
    ethd__predictor_prepare(&evidence, &plant, 1e-10, &p[i]);
    f[i] = (ethd__forecast){&p[i], states[i], all[i]};
  }
  ethd__predict_many(f, ETHD__ARMS, &shot);
  for (int i = 0; i < ETHD__ARMS; i++) {
    ethd__predict(&p[i], &shot, states[i], one);
    ck_assert_double_lt(farthest(one, all[i]), 2e-9);
    ck_assert_double_gt(0.25 * fabs(one[2 * TICKS - 2] - one[0]), 1e-3);
  }
  ck_assert_double_gt(farthest(all[0], all[1]), 1e-5); /* a later torque is seen */
}

/* Fewer than all: the same as when the others' places are taken by itself; and again, to the bit. */
TEST(repeats) {
  double a[2 * TICKS], b[2 * TICKS];
  const double state[ETHD__STATE_MOST] = {1.4, 0.2, 0.3, -0.2};
  ethd__predictor p;
  ethd_plant plant = plant_of(true, 0);
  begin(false);
  ethd__predictor_prepare(&evidence, &plant, 1e-9, &p);
  ethd__predict_many(&(ethd__forecast){&p, state, a}, 1, &shot);
  ethd__predict_many((ethd__forecast[]){{&p, state, b}, {&p, state, b}, {&p, state, b}, {&p, state, b}}, 4, &shot);
  ck_assert_mem_eq(a, b, sizeof a);
}

TEST(runs_away) {
  double one[2 * TICKS], many[2 * TICKS];
  const double state[ETHD__STATE_MOST] = {1.4, 0.2, 0.3, -0.2};
  ethd__predictor p;
  ethd_plant plant = plant_of(false, 0);
  plant.viscous = -100; /* pushes */
  begin(false);
  for (int i = 0; i < 2 * TICKS; i++) one[i] = many[i] = (double)NAN;
  ethd__predictor_prepare(&evidence, &plant, 1e-6, &p);
  ethd__predict(&p, &shot, state, one);
  ethd__predict_many(&(ethd__forecast){&p, state, many}, 1, &shot);
  for (int i = 0; i < 2 * TICKS; i++) ck_assert(isfinite(one[i]) && isfinite(many[i]));
  ck_assert(one[2 * TICKS - 1] == one[2 * TICKS - 3] && many[2 * TICKS - 1] == many[2 * TICKS - 3]);
}
