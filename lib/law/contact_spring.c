#include "ethd/law.h"

enum { K_E, COUNT };

static const ethd_param params[COUNT] = {
    {"k_e", "N/m", 0, 1e6, 2500, "stiffness of the wall (K_e)"},
};

static ethd_status step(const double *p, void *block, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)block, (void)speed, (void)entering;
  *force = gap < 0 ? p[K_E] * gap : 0;
  return ETHD_OK;
}

const ethd_contact_law ethd_contact_spring = {
    .law = {sizeof(ethd_contact_law), ETHD_ABI, ETHD_CONTACT, 0, "spring", "spring without damping", params, COUNT,
            NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){"k_e", NULL},
};
