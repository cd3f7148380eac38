/* A static press: in vo the ring rests F/K_e beyond x_eps, and eps stays what it was, to the bit. */
#include <math.h>

#include "stress/mass.h"

#define MASS 0.3
#define TICKS 6000

/* Brakes from 0.2 m/s, then F pushes, with some friction so that the springy ring comes to rest. */
static void press(const ethd_contact_law *contact, double stiffness, double force) {
  mass_rig r;
  mass_open(&r, MASS, -1e-6);
  ethd_setup_contact(&r.on.setup, contact);
  rig_set(&r.on.setup, "contact.k_e", stiffness);
  r.measured = 1;
  mass_start(&r, 0.2);
  while (mass_tick(&r)->state != ETHD_VO && r.tick < 1000) continue;
  double eps = r.on.trace.eps;
  int changed = 0;
  for (int k = 0; k < TICKS; k++) {
    r.push.x = 10 * mass_speed(&r) - force;
    changed += mass_tick(&r)->eps != eps;
  }
  const char *id = contact->law.id;
  near(-(r.on.trace.d_re + r.on.trace.eps), force / stiffness, 1e-6, "%s: penetration beyond x_eps = F / K_e", id);
  within(changed, 0, 0, "%s: ticks on which eps changed", id);
  mass_close(&r);
}

TEST(test_press) {
  static const ethd_contact_law *const laws[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                 &ethd_contact_hunt_crossley};
  static const double forces[] = {0.1, 1, 5, 20};
  for (size_t l = 0; l < 3; l++)
    for (size_t i = 0; i < 4; i++)
      for (double k = 500; k < 5000; k += 2000) press(laws[l], k, forces[i]);
}
