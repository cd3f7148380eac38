/* Creep: with the paper's conditions, a finger that pushes with F > B_d v_th keeps the ring braking and moving at F/B_d
   for ever. Two caps of the library end it: the first tick with -d_re >= eps_max, or t_max after it began. */
#include <math.h>

#include "stress/mass.h"

#define MASS 0.3
#define DAMPING 100.0
#define PERIOD 0.001

static void open_pushed(mass_rig *r, double force, double eps_max, double t_max) {
  mass_open(r, MASS, -1e-9);
  r->on.setup.arm.link1 = MASS_STRAIGHT;
  rig_set(&r->on.setup, "transition.b_d", DAMPING);
  rig_set(&r->on.setup, "transition.eps_max", eps_max);
  rig_set(&r->on.setup, "transition.t_max", t_max);
  r->measured = 1;
  r->push.x = -force;
  mass_start(r, force / DAMPING);
}

static void creep(double force) {
  mass_rig r;
  open_pushed(&r, force, (double)INFINITY, (double)INFINITY);
  int braking = 0;
  for (int k = 0; k < 5000; k++) braking += mass_tick(&r)->state == ETHD_BRAKING;
  within(braking, 5000, 0, "paper: of 5000 ticks pushed over B_d v_th, braking");
  near(r.on.trace.v_n, force / DAMPING, 1e-6, "paper: creep at F / B_d");
  mass_close(&r);
}

/* From the first tick at F/B_d: depth k T F/B_d at tick k. */
static void capped(double force, double eps_max, double t_max) {
  mass_rig r;
  open_pushed(&r, force, eps_max, t_max);
  while (mass_tick(&r)->state != ETHD_VO && r.tick < 100000) continue;
  double step = PERIOD * force / DAMPING, by_depth = ceil(eps_max / step - 1e-6), by_time = ceil(t_max / PERIOD - 1e-6);
  double ticks = fmin(by_depth, by_time);
  within((double)r.on.trace.tick, ticks, 0, "product: ticks of braking = min(eps_max B_d / F, t_max) / T");
  near(r.on.trace.eps, ticks * step, 1e-4, "product: eps there");
  mass_close(&r);
}

TEST(test_creep) {
  static const double forces[] = {2.1, 3, 6, 12, 30};
  for (int i = 0; i < 5; i++) creep(forces[i]);
  for (int i = 0; i < 5; i++) capped(forces[i], 0.006, 0.050);
  for (int i = 0; i < 5; i++) capped(forces[i], 0.0031, 0.200);
}
