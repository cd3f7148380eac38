#include "ethd/law.h"

/* Modified Kelvin-Voigt (eq. 3, 7): d = gap < 0, d_dot = -v.
   entering: F = K_e d - B_e v;  leaving: F = K_e d. */

enum { K_E, B_E, COUNT };

static const ethd_param params[COUNT] = {
    {"k_e", "N/m", 0, 1e6, 2500, "stiffness of the wall (K_e)"},
    {"b_e", "Ns/m", 0, 1e4, 45, "damping of the wall while entering (B_e)"},
};

static ethd_status step(const double *p, void *block, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)block;
  if (!(gap < 0))
    *force = 0;
  else if (entering)
    *force = p[K_E] * gap - p[B_E] * speed;
  else
    *force = p[K_E] * gap;
  return ETHD_OK;
}

const ethd_contact_law ethd_contact_kelvin_voigt = {
    .law = {sizeof(ethd_contact_law), ETHD_ABI, ETHD_CONTACT, 0, "kelvin-voigt", "spring, and a damper while entering",
            params, COUNT, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){"k_e", "b_e"},
};
