/* Creep: with the paper's conditions, a finger that pushes with F > B_d v_th keeps the ring braking and moving at F/B_d
   for ever. Two caps of the library end it: the first tick with -d_re >= eps_max, or t_max after it began. */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

#define MASS 0.3
#define DAMPING 100.0
#define PERIOD 0.001

static void open_pushed(ethd__stress_rig *rig, double force, double eps_max, double t_max) {
  ethd__stress_rig_open(rig, MASS, -1e-9);
  rig->setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  ethd__stress_set(&rig->setup, "transition.b_d", DAMPING);
  ethd__stress_set(&rig->setup, "transition.eps_max", eps_max);
  ethd__stress_set(&rig->setup, "transition.t_max", t_max);
  rig->measured = 1;
  rig->push.x = -force;
  ethd__stress_rig_start(rig, force / DAMPING);
}

static void creep(ethd__stress_log *log, double force) {
  ethd__stress_rig rig;
  open_pushed(&rig, force, (double)INFINITY, (double)INFINITY);
  int braking = 0;
  for (int k = 0; k < 5000; k++) braking += ethd__stress_rig_tick(&rig)->state == ETHD_BRAKING;
  ethd__stress_within(log, "ticks", braking, 5000, 0, "paper: of 5000 ticks pushed over B_d v_th, braking");
  ethd__stress_near(log, "m/s", rig.trace.v_n, force / DAMPING, 1e-6, "paper: creep at F / B_d");
  ethd__stress_rig_close(&rig);
}

/* From the first tick at F/B_d: depth k T F/B_d at tick k. */
static void capped(ethd__stress_log *log, double force, double eps_max, double t_max) {
  ethd__stress_rig rig;
  open_pushed(&rig, force, eps_max, t_max);
  while (ethd__stress_rig_tick(&rig)->state != ETHD_VO && rig.tick < 100000) continue;
  double step = PERIOD * force / DAMPING, by_depth = ceil(eps_max / step - 1e-6), by_time = ceil(t_max / PERIOD - 1e-6);
  double ticks = fmin(by_depth, by_time);
  ethd__stress_within(log, "ticks", (double)rig.trace.tick, ticks, 0,
                      "product: ticks of braking = min(eps_max B_d / F, t_max) / T");
  ethd__stress_near(log, "m", rig.trace.eps, ticks * step, 1e-4, "product: eps there");
  ethd__stress_rig_close(&rig);
}

static void run(ethd__stress_log *log) {
  static const double forces[] = {2.1, 3, 6, 12, 30};
  for (int i = 0; i < 5; i++) creep(log, forces[i]);
  for (int i = 0; i < 5; i++) capped(log, forces[i], 0.006, 0.050);
  for (int i = 0; i < 5; i++) capped(log, forces[i], 0.0031, 0.200);
}

const ethd__stress ethd__stress_creep = {"creep", "creep while braking, and its end by the caps", run};
