/* A static press: in vo the ring rests F/K_e beyond x_eps, and eps stays what it was, to the bit. */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

#define MASS 0.3
#define TICKS 6000

/* Brakes from 0.2 m/s, then F pushes, with some friction so that the springy ring comes to rest. */
static void press(ethd__stress_log *log, const ethd_contact_law *contact, double stiffness, double force) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, -1e-6);
  ethd_setup_contact(&rig.setup, contact);
  ethd__stress_set(&rig.setup, "contact.k_e", stiffness);
  rig.measured = 1;
  ethd__stress_rig_start(&rig, 0.2);
  while (ethd__stress_rig_tick(&rig)->state != ETHD_VO && rig.tick < 1000) continue;
  double eps = rig.trace.eps;
  int changed = 0;
  for (int k = 0; k < TICKS; k++) {
    rig.push.x = 10 * ethd__stress_rig_speed(&rig) - force;
    changed += ethd__stress_rig_tick(&rig)->eps != eps;
  }
  const char *id = contact->law.id;
  ethd__stress_near(log, "m", -(rig.trace.d_re + rig.trace.eps), force / stiffness, 1e-6,
                    "%s: penetration beyond x_eps = F / K_e", id);
  ethd__stress_within(log, "ticks", changed, 0, 0, "%s: ticks on which eps changed", id);
  ethd__stress_rig_close(&rig);
}

static void run(ethd__stress_log *log) {
  static const ethd_contact_law *const laws[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                 &ethd_contact_hunt_crossley};
  static const double forces[] = {0.1, 1, 5, 20};
  for (size_t l = 0; l < 3; l++)
    for (size_t i = 0; i < 4; i++)
      for (double k = 500; k < 5000; k += 2000) press(log, laws[l], k, forces[i]);
}

const ethd__stress ethd__stress_press = {"press", "a static press: how deep, and eps unchanged", run};
