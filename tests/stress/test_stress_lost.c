/* Ticks that never come: a loop stays stable. */
#include <math.h>

#include "stress/mass.h"
#include "unit/draw.h"

#define PERIOD 0.001

/* A tenth of the ticks lost, gains at a third of the boundary of a loop that is three times as slow. */
TEST(test_lost_ticks) {
  const double mass = 0.3, slow = 3 * PERIOD, b = 2 * mass / slow / 6, k = b / slow / 3;
  mass_rig r;
  mass_open(&r, mass, -10 / k);
  ethd_setup_velocity(&r.on.setup, ETHD_VELOCITY_DIFFERENCE);
  ethd_setup_transition(&r.on.setup, &ethd_transition_smooth);
  rig_set(&r.on.setup, "contact.k_e", k);
  rig_set(&r.on.setup, "contact.b_e", b);
  rig_set(&r.on.setup, "transition.v_hysteresis", 1);
  r.push.x = -10;
  mass_start(&r, 1e-3);
  double first = 0, last = 0;
  for (uint64_t i = 0; i < 4000; i++) {
    if (i == 0 || draw(i, 0, 1) >= 0.1) mass_step(&r);
    mass_move(&r);
    double speed = fabs(mass_speed(&r));
    if (i < 50) first = fmax(first, speed);
    if (i >= 3950) last = fmax(last, speed);
  }
  bound(last, 1e-6 * first, "a tenth of the ticks lost: what is left of a swing of 1 mm/s");
  mass_close(&r);
}
