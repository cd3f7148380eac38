/* Rest at touch: the ring meets the wall at v, `lag` behind the finger, which goes on at v. It stands
   still when the finger reaches it iff

       gap - lag >= v^2/(2a),  gap = R_r - R_f,  a = (F_sat + f_c)/m,  so up to v* = sqrt(2a (gap - lag)):

   while the ring brakes for v/a s and v^2/(2a) m, the finger moves v^2/a. Ticks are made short here and
   braking hard, so that only this is left; at 1 kHz the paper's braking is noted beside it. */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

typedef struct plant {
  const char *name;
  double mass, force, friction, finger_radius;
} plant;

static const plant plants[] = {{"plant n", 0.1173, 5.357, 0.398, 7.32e-3}, {"plant b", 0.1445, 5.369, 0.164, 8.15e-3}};

typedef struct braking {
  double period, damping, still; /* s, Ns/m, m/s */
} braking;

/* Whether the finger arrives while the ring still moves. */
static int early(const plant *p, const braking *b, double speed, double lag) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, p->mass, -1e-12);
  double gap = rig.setup.ring_radius - p->finger_radius;
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  rig.setup.period = b->period;
  ethd__stress_rig_brakes(&rig, b->damping, b->still);
  rig.measured = rig.has_finger = 1;
  rig.force_limit = p->force;
  ethd__stress_rig_start(&rig, speed);
  rig.push.x = p->friction;
  double ahead = lag;
  while (ethd__stress_rig_speed(&rig) > b->still && ahead < gap) {
    rig.finger = (ethd_vec){rig.setup.arm.link2 - ethd__stress_rig_depth(&rig) - ahead, ETHD__STRESS_RIG_STRAIGHT};
    ethd__stress_rig_tick(&rig);
    ahead = lag + speed * (double)rig.tick * b->period - ethd__stress_rig_depth(&rig);
  }
  ethd__stress_rig_close(&rig);
  return ahead >= gap;
}

/* The highest speed without early contact. */
static double highest(const plant *p, const braking *b, double lag) {
  double low = 1e-3, high = 2;
  while (high - low > 1e-4 * low) {
    double middle = (low + high) / 2;
    if (early(p, b, middle, lag))
      high = middle;
    else
      low = middle;
  }
  return low;
}

static void run(ethd__stress_log *log) {
  static const double lags[] = {-1e-3, 0, 1e-3, 2e-3, 3e-3};
  for (size_t i = 0; i < 2; i++) {
    const plant *p = &plants[i];
    double a = (p->force + p->friction) / p->mass, gap = 0.012 - p->finger_radius;
    const braking ideal = {1e-5, 0.5 * p->mass / 1e-5, 1.05 * p->force / (0.5 * p->mass / 1e-5)};
    const braking paper = {1e-3, 100, 0.020};
    for (size_t k = 0; k < 5; k++)
      ethd__stress_near(log, "m/s", highest(p, &ideal, lags[k]), sqrt(2 * a * (gap - lags[k])), 5e-3,
                        "%s, %g mm behind: highest speed, rest at touch", p->name, 1e3 * lags[k]);
    ethd__stress_note(log, "%s at 1 kHz with B_d = 100 Ns/m, at rest from 0.02 m/s on: %.3f m/s, 0 mm behind", p->name,
                      highest(p, &paper, 0));
  }
}

const ethd__stress ethd__stress_touch = {"touch", "rest at touch: the highest speed without early contact", run};
