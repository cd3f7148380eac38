/* Rest at touch: the ring meets the wall at v, `lag` behind the finger, which goes on at v. It stands
   still when the finger reaches it iff

       gap - lag >= v^2/(2a),  gap = R_r - R_f,  a = (F_sat + f_c)/m,  so up to v* = sqrt(2a (gap - lag)):

   while the ring brakes for v/a s and v^2/(2a) m, the finger moves v^2/a. Ticks are made short here and
   braking hard, so that only this is left. */
#include <math.h>

#include "stress/mass.h"

typedef struct plant {
  const char *name;
  double mass, force, friction, finger_radius;
} plant;

static const plant plants[] = {{"plant n", 0.1173, 5.357, 0.398, 7.32e-3}, {"plant b", 0.1445, 5.369, 0.164, 8.15e-3}};

#define PERIOD 1e-5 /* s */

/* Whether the finger arrives while the ring still moves. */
static int early(const plant *p, double speed, double lag) {
  const double damping = 0.5 * p->mass / PERIOD, still = 1.05 * p->force / damping;
  mass_rig r;
  mass_open(&r, p->mass, -1e-12);
  double gap = r.on.setup.ring_radius - p->finger_radius;
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  r.on.setup.period = PERIOD;
  mass_brakes(&r, damping, still);
  r.measured = r.has_finger = 1;
  r.force_limit = p->force;
  mass_start(&r, speed);
  r.push.x = p->friction;
  double ahead = lag;
  while (mass_speed(&r) > still && ahead < gap) {
    r.finger = (ethd_vec){r.on.setup.arm.link2 - mass_depth(&r) - ahead, MASS_STRAIGHT};
    mass_tick(&r);
    ahead = lag + speed * (double)r.tick * PERIOD - mass_depth(&r);
  }
  mass_close(&r);
  return ahead >= gap;
}

/* The highest speed without early contact. */
static double highest(const plant *p, double lag) {
  double low = 1e-3, high = 2;
  while (high - low > 1e-4 * low) {
    double middle = (low + high) / 2;
    if (early(p, middle, lag))
      high = middle;
    else
      low = middle;
  }
  return low;
}

TEST(test_touch) {
  static const double lags[] = {-1e-3, 0, 1e-3, 2e-3, 3e-3};
  for (size_t i = 0; i < 2; i++) {
    const plant *p = &plants[i];
    double a = (p->force + p->friction) / p->mass, gap = 0.012 - p->finger_radius;
    for (size_t k = 0; k < 5; k++)
      near(highest(p, lags[k]), sqrt(2 * a * (gap - lags[k])), 5e-3, "%s, %g mm behind: highest speed, rest at touch",
           p->name, 1e3 * lags[k]);
  }
}
