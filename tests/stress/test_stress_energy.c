/* What the wall gives back to a ring that starts at rest at depth d (no damping on the way out):

     K_e d^2/2 - K_e d_N^2/2 + sum of K_e (step)^2/2        work of the held force, d_N beyond the surface

   and, since the tick's map x, v has the determinant 1 + k/2 and the trace 2 - k/2 with k = K_e T^2/m,

     x_j = d r^j (cos(j th) + c sin(j th)),  r^2 = 1 + k/2,  2 r cos th = 2 - k/2.

   offset's switch to vo begins at depth 0 of the shifted wall: nothing is stored. */
#include <math.h>

#include "stress/mass.h"

#define MASS 0.1173
#define PERIOD 0.001

static void smooth(double stiffness, double depth) {
  mass_rig r;
  mass_open(&r, MASS, -depth);
  ethd_setup_transition(&r.on.setup, &ethd_transition_smooth);
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  rig_set(&r.on.setup, "contact.k_e", stiffness);
  r.measured = 1;
  mass_start(&r, 0);
  double steps = 0, before = depth, left = depth;
  while (left > 0 && r.tick < 10000) {
    mass_tick(&r);
    left = depth + mass_depth(&r);
    steps += stiffness * (before - left) * (before - left) / 2;
    before = left;
  }
  double v = mass_speed(&r), gained = MASS * v * v / 2, stored = stiffness * depth * depth / 2;
  double k = stiffness * PERIOD * PERIOD / MASS, root = sqrt(1 + k / 2), th = acos((2 - k / 2) / (2 * root));
  double c = (1 - k / 2 - root * cos(th)) / (root * sin(th)), j = (double)r.tick;
  /* v_j follows from x_j and x_j-1, because the force of tick j - 1 was held */
  double x = depth * pow(root, j) * (cos(j * th) + c * sin(j * th));
  double past = depth * pow(root, j - 1) * (cos((j - 1) * th) + c * sin((j - 1) * th));
  double speed = (x - past) / PERIOD - k / (2 * PERIOD) * past;
  near(gained, stored - stiffness * left * left / 2 + steps, 1e-5,
       "smooth: given back = K_e (d^2 - d_N^2 + sum of steps^2)/2");
  near(gained, MASS * speed * speed / 2, 1e-5, "smooth: given back, by the closed form of the motion");
  bound(gained, stored + steps, "smooth: given back <= K_e d^2/2 + the hold's share");
  mass_close(&r);
}

/* After braking the ring keeps at most the energy that it has at the switch, and what the hold adds on the short way
   that is left. */
static void offset(double speed) {
  mass_rig r;
  mass_open(&r, MASS, -1e-9);
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  r.measured = 1;
  mass_start(&r, speed);
  while (mass_step(&r)->state != ETHD_VO) mass_move(&r);
  double K = ethd_setup_get(&r.on.setup, "contact.k_e");
  double v = mass_speed(&r), kept = MASS * v * v / 2, most = 0, steps = 0;
  double stored = r.on.trace.d_re + r.on.trace.eps;
  within(hypot(r.on.trace.fe[0], r.on.trace.fe[1]), 0, 0, "offset: force at the switch");
  within(K * stored * stored / 2, 0, 0, "offset: energy stored at the switch");
  for (int i = 0; i < 500; i++) {
    double x = mass_depth(&r);
    mass_move(&r);
    double out = x - mass_depth(&r);
    steps += K * out * out / 2;
    mass_step(&r);
    if (mass_speed(&r) < 0) most = fmax(most, MASS * mass_speed(&r) * mass_speed(&r) / 2);
  }
  bound(most, kept + steps + 1e-15, "offset: given back <= what was left + the hold's share");
  mass_close(&r);
}

/* predictive brakes before the wall. It is told of friction that isn't there. What it gives back against this friction
   before it brakes is at most m v^2/2; from then on the ring has less energy at every tick, and it stands before the
   wall takes over. */
static void ahead(double speed, double friction) {
  mass_rig r;
  mass_open(&r, MASS, 0.02);
  ethd_setup_transition(&r.on.setup, &ethd_transition_predictive);
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  r.on.setup.dynamics = (ethd_dynamics){{MASS, MASS}, friction, 0, 0};
  r.on.setup.limits.torque = 5.36 * MASS_STRAIGHT;
  r.measured = true;
  r.has_finger = true;
  mass_start(&r, speed);
  r.finger_v = (ethd_vec){-speed, 0};
  double began = NAN, most = 0, fed = 0;
  for (int i = 0; i < 1000 && r.on.trace.state != ETHD_VO; i++) {
    ethd_pose pose;
    ethd_arm_pose(&r.on.setup.arm, r.q, &pose);
    r.finger = pose.x; /* it leans on nothing */
    double before = mass_depth(&r), v = mass_speed(&r);
    mass_tick(&r);
    if (r.on.trace.state == ETHD_BRAKING && isnan(began)) began = MASS * v * v / 2;
    if (isnan(began)) fed += -r.on.trace.fe[0] * (mass_depth(&r) - before); /* along n = (-1, 0) */
    if (!isnan(began)) most = fmax(most, MASS * v * v / 2);
  }
  double v = mass_speed(&r), way = 0.015;
  bound(fed, friction * way + 1e-12, "predictive: given back before it brakes <= f_c range");
  bound(most, began + 1e-12, "predictive: most energy while it brakes <= at its begin");
  bound(MASS * v * v / 2, MASS * 0.05 * 0.05 / 2, "predictive: energy left <= m (0.05 m/s)^2/2");
  mass_close(&r);
}

TEST(test_energy) {
  static const double stiffnesses[] = {100, 2500, 20000};
  static const double depths[] = {1e-4, 1e-3, 5e-3};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) smooth(stiffnesses[i], depths[k]);
  static const double speeds[] = {0.05, 0.1, 0.2, 0.4, 0.8};
  for (int i = 0; i < 5; i++) offset(speeds[i]);
  for (int i = 1; i < 5; i++)
    for (int k = 0; k < 3; k++) ahead(speeds[i], 0.2 * k);
}
