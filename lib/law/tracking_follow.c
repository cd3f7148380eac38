#include "ethd/law.h"

/* Follows the finger in space, and by J^T in the plane:

     F = k eps_x + b eps_v            eps_x = X_f - X, eps_v = V_f - V
     V = V_f + rate eps_x             with a delay t_d there is no overshoot up to rate t_d = 1/e */

enum { K, B, RATE, COUNT };

static const ethd_param params[COUNT] = {
    {"k", "N/m", 0, 1e6, 600, "force commands: stiffness between finger and effector"},
    {"b", "Ns/m", 0, 1e5, 15, "force commands: damping between them"},
    {"rate", "1/s", 0, 1e3, 10, "velocity commands: speed towards the finger for each metre to it"},
};

static ethd_status force(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT {
  (void)state;
  *out = ethd_vec3_add(ethd_vec3_scale(p[K], in->eps_x), ethd_vec3_scale(p[B], in->eps_v));
  return ETHD_OK;
}

static ethd_status velocity(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT {
  (void)state;
  *out = ethd_vec3_add(in->finger_v, ethd_vec3_scale(p[RATE], in->eps_x));
  return ETHD_OK;
}

const ethd_tracking_law ethd_tracking_follow = {
    .law = {sizeof(ethd_tracking_law), ETHD_ABI, ETHD_TRACKING, 0, "follow",
            "follows the finger in space, by force or velocity", params, COUNT, NULL, NULL},
    .force = force,
    .velocity = velocity,
};
