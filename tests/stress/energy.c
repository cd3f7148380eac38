/* What the wall gives back to a ring that starts at rest at depth d (no damping on the way out):

     K_e d^2/2 - K_e d_N^2/2 + sum of K_e (step)^2/2        work of the held force, d_N beyond the surface

   and, since the tick's map x, v has the determinant 1 + k/2 and the trace 2 - k/2 with k = K_e T^2/m,

     x_j = d r^j (cos(j th) + c sin(j th)),  r^2 = 1 + k/2,  2 r cos th = 2 - k/2.

   offset's switch to vo begins at depth 0 of the shifted wall: nothing is stored. */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

#define MASS 0.1173
#define PERIOD 0.001

static void smooth(ethd__stress_log *log, double stiffness, double depth) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, -depth);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  ethd__stress_set(&rig.setup, "contact.k_e", stiffness);
  rig.measured = 1;
  ethd__stress_rig_start(&rig, 0);
  double steps = 0, before = depth, left = depth;
  while (left > 0 && rig.tick < 10000) {
    ethd__stress_rig_tick(&rig);
    left = depth + ethd__stress_rig_depth(&rig);
    steps += stiffness * (before - left) * (before - left) / 2;
    before = left;
  }
  double v = ethd__stress_rig_speed(&rig), gained = MASS * v * v / 2, stored = stiffness * depth * depth / 2;
  double k = stiffness * PERIOD * PERIOD / MASS, r = sqrt(1 + k / 2), th = acos((2 - k / 2) / (2 * r));
  double c = (1 - k / 2 - r * cos(th)) / (r * sin(th)), j = (double)rig.tick;
  /* v_j follows from x_j and x_j-1, because the force of tick j - 1 was held */
  double x = depth * pow(r, j) * (cos(j * th) + c * sin(j * th));
  double past = depth * pow(r, j - 1) * (cos((j - 1) * th) + c * sin((j - 1) * th));
  double speed = (x - past) / PERIOD - k / (2 * PERIOD) * past;
  ethd__stress_near(log, "J", gained, stored - stiffness * left * left / 2 + steps, 1e-5,
                    "smooth: given back = K_e (d^2 - d_N^2 + sum of steps^2)/2");
  ethd__stress_near(log, "J", gained, MASS * speed * speed / 2, 1e-5,
                    "smooth: given back, by the closed form of the motion");
  ethd__stress_bound(log, "J", gained, stored + steps, "smooth: given back <= K_e d^2/2 + the hold's share");
  ethd__stress_rig_close(&rig);
}

/* After braking the ring keeps at most the energy that it has at the switch, and what the hold adds on the short way
   that is left. */
static void offset(ethd__stress_log *log, double speed) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, -1e-9);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  rig.measured = 1;
  ethd__stress_rig_start(&rig, speed);
  while (ethd__stress_rig_step(&rig)->state != ETHD_VO) ethd__stress_rig_move(&rig);
  double K = ethd_setup_get(&rig.setup, "contact.k_e");
  double v = ethd__stress_rig_speed(&rig), kept = MASS * v * v / 2, most = 0, steps = 0;
  double stored = rig.trace.d_re + rig.trace.eps;
  ethd__stress_within(log, "N", hypot(rig.trace.fe[0], rig.trace.fe[1]), 0, 0, "offset: force at the switch");
  ethd__stress_within(log, "J", K * stored * stored / 2, 0, 0, "offset: energy stored at the switch");
  for (int i = 0; i < 500; i++) {
    double x = ethd__stress_rig_depth(&rig);
    ethd__stress_rig_move(&rig);
    double out = x - ethd__stress_rig_depth(&rig);
    steps += K * out * out / 2;
    ethd__stress_rig_step(&rig);
    if (ethd__stress_rig_speed(&rig) < 0)
      most = fmax(most, MASS * ethd__stress_rig_speed(&rig) * ethd__stress_rig_speed(&rig) / 2);
  }
  ethd__stress_bound(log, "J", most, kept + steps + 1e-15, "offset: given back <= what was left + the hold's share");
  ethd__stress_rig_close(&rig);
}

/* predictive brakes before the wall. It is told of friction that isn't there. What it gives back against this friction
   before it brakes is at most m v^2/2; from then on the ring has less energy at every tick, and it stands before the
   wall takes over. */
static void ahead(ethd__stress_log *log, double speed, double friction) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, 0.02);
  ethd_setup_transition(&rig.setup, &ethd_transition_predictive);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  rig.setup.dynamics = (ethd_dynamics){{MASS, MASS}, friction, 0, 0};
  rig.setup.limits.torque = 5.36 * ETHD__STRESS_RIG_STRAIGHT;
  rig.measured = true;
  rig.has_finger = true;
  ethd__stress_rig_start(&rig, speed);
  rig.finger_v = (ethd_vec){-speed, 0};
  double began = NAN, most = 0, fed = 0;
  for (int i = 0; i < 1000 && rig.trace.state != ETHD_VO; i++) {
    ethd_pose pose;
    ethd_arm_pose(&rig.setup.arm, rig.q, &pose);
    rig.finger = pose.x; /* it leans on nothing */
    double before = ethd__stress_rig_depth(&rig), v = ethd__stress_rig_speed(&rig);
    ethd__stress_rig_tick(&rig);
    if (rig.trace.state == ETHD_BRAKING && isnan(began)) began = MASS * v * v / 2;
    if (isnan(began)) fed += -rig.trace.fe[0] * (ethd__stress_rig_depth(&rig) - before); /* along n = (-1, 0) */
    if (!isnan(began)) most = fmax(most, MASS * v * v / 2);
  }
  double v = ethd__stress_rig_speed(&rig), way = 0.015;
  ethd__stress_bound(log, "J", fed, friction * way + 1e-12, "predictive: given back before it brakes <= f_c range");
  ethd__stress_bound(log, "J", most, began + 1e-12, "predictive: most energy while it brakes <= at its begin");
  ethd__stress_bound(log, "J", MASS * v * v / 2, MASS * 0.05 * 0.05 / 2, "predictive: energy left <= m (0.05 m/s)^2/2");
  ethd__stress_rig_close(&rig);
}

/* At any depth and speed the wall only pushes out. */
static void never_pulls(ethd__stress_log *log, const ethd_contact_law *law) {
  double most = -INFINITY;
  for (double depth = 0; depth < 0.01; depth += 5e-4)
    for (double speed = -4; speed <= 4; speed += 0.25) {
      ethd__stress_rig rig;
      ethd__stress_rig_open(&rig, MASS, -depth);
      ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
      ethd_setup_contact(&rig.setup, law);
      rig.measured = 1;
      ethd__stress_rig_start(&rig, speed);
      most = fmax(most, -ethd__stress_rig_step(&rig)->fe[0]); /* along n = (-1, 0) */
      ethd__stress_rig_close(&rig);
    }
  ethd__stress_bound(log, "N", most, 0, "%s: largest pull", law->law.id);
}

static void run(ethd__stress_log *log) {
  static const double stiffnesses[] = {100, 2500, 20000};
  static const double depths[] = {1e-4, 1e-3, 5e-3};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) smooth(log, stiffnesses[i], depths[k]);
  static const double speeds[] = {0.05, 0.1, 0.2, 0.4, 0.8};
  for (int i = 0; i < 5; i++) offset(log, speeds[i]);
  for (int i = 1; i < 5; i++)
    for (int k = 0; k < 3; k++) ahead(log, speeds[i], 0.2 * k);
  never_pulls(log, &ethd_contact_kelvin_voigt);
  never_pulls(log, &ethd_contact_spring);
  never_pulls(log, &ethd_contact_hunt_crossley);
}

const ethd__stress ethd__stress_energy = {"energy", "energy that the wall gives back", run};
