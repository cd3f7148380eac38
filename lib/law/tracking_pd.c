#include "ethd/law.h"

/* tau = K_t eps_q + B_t eps_q_dot (eq. 2, 5). */

enum { K_T, B_T, DERIVATIVE, COUNT };
enum { VELOCITY, DIFFERENCE };

static const ethd_param params[COUNT] = {
    {"k_t", "Nm/rad", 0, 1e4, 40, "stiffness between finger and ring, each joint (K_t)"},
    {"b_t", "Nms/rad", 0, 1e3, 1, "damping between finger and ring, each joint (B_t)"},
    {"derivative", "velocity|difference", 0, 1, VELOCITY,
     "eps_q_dot: J^-1 (V_f - V_r), or the backward difference of eps_q"},
};

typedef struct pd_state {
  double eps_q[2];
  double started;
} pd_state;

_Static_assert(sizeof(pd_state) <= ETHD_STATE_MAX, "state");

static double difference(pd_state *s, const ethd_tracking_in *in, int i) {
  double d = s->started != 0 ? (in->eps_q[i] - s->eps_q[i]) / in->period : 0;
  s->eps_q[i] = in->eps_q[i];
  return d;
}

static ethd_status step(const double *p, void *block, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  pd_state *s = block;
  for (int i = 0; i < 2; i++) {
    double d = p[DERIVATIVE] == DIFFERENCE ? difference(s, in, i) : in->eps_q_dot[i];
    tau[i] = p[K_T] * in->eps_q[i] + p[B_T] * d;
  }
  s->started = 1;
  return ETHD_OK;
}

const ethd_tracking_law ethd_tracking_pd = {
    .law = {sizeof(ethd_tracking_law), ETHD_ABI, ETHD_TRACKING, sizeof(pd_state), "pd",
            "spring and damper between finger and ring, in joint space", params, COUNT, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){"k_t", "b_t"},
};
