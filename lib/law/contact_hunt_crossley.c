#include "ethd/law.h"

/* Hunt and Crossley 1975 with exponent 1: F = -K_e p (1 + c_e p_dot), p = -gap, p_dot = v. The force doesn't jump at
   the surface, since the damping grows with depth. */

enum { K_E, C_E, COUNT };

static const ethd_param params[COUNT] = {
    {"k_e", "N/m", 0, 1e6, 2500, "stiffness of the wall (K_e)"},
    {"c_e", "s/m", 0, 1e3, 1, "damping: share of the stiffness force for each m/s"},
};

static ethd_status step(const double *p, void *block, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)block, (void)entering;
  *force = gap < 0 ? p[K_E] * gap * (1 + p[C_E] * speed) : 0;
  return ETHD_OK;
}

const ethd_contact_law ethd_contact_hunt_crossley = {
    .law = {sizeof(ethd_contact_law), ETHD_ABI, ETHD_CONTACT, 0, "hunt-crossley",
            "spring with damping that grows with depth", params, COUNT, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){"k_e", NULL},
};
