/* The torque of the laws, tau = beta tau_t + J^T sum (share F_e - damping v + feed) n   (eq. 5 and figure 7).

   1. Ring and finger are estimated from the sense (estimate.c).
   2. The contacts give beta, the sums of their forces, fe (with feed) and fd (damping), and a lead (near.c).
   3. The tracking law computes tau_t from the finger's position and velocity relative to the ring, with the lead.
   4. While the finger isn't seen, beta fades (core/finger.c). */
#include "control/evaluate.h"

#include "control/estimate.h"
#include "control/near.h"
#include "core/rows.h"

/* Computes the torque from the force of a law that has no torque function. */
static ethd_status follow(const ethd__tick *t, const ethd_tracking_in *in, double tau[2]) {
  const ethd__core_plan *plan = &t->plan->core;
  const ethd_follow_in space = {.eps_x = {in->eps_x.x, in->eps_x.y, 0},
                                .eps_v = {in->eps_v.x, in->eps_v.y, 0},
                                .finger_v = {in->finger_v.x, in->finger_v.y, 0},
                                .period = in->period};
  ethd_vec3 force = {0, 0, 0};
  const ethd_status status = plan->follow(plan->tracking_p, t->state->core.tracking.at, &space, &force);
  ethd_pose_torques(&t->pose, (ethd_vec){force.x, force.y}, tau);
  return status;
}

/* Calls the tracking law for its torque before beta, tau. */
static bool track(const ethd__tick *t, double tau[2]) {
  const ethd__core_plan *plan = &t->plan->core;
  ethd__core *core = &t->state->core;
  const ethd_vec lead = {t->core.touched.lead.x, t->core.touched.lead.y};
  ethd_trace *out = t->trace;
  ethd_tracking_in in;
  in.eps_x = ethd_vec_sub(ethd_vec_add(t->finger.x, lead), t->ring.x);
  in.eps_v = ethd_vec_sub(t->finger.v, t->ring.v);
  in.period = t->dt;
  in.finger_v = t->finger.v;
  ethd_pose_joints(&t->pose, in.eps_x, in.eps_q);
  ethd_pose_joints(&t->pose, in.eps_v, in.eps_q_dot);
  memcpy(out->eps_q, in.eps_q, sizeof out->eps_q);
  memcpy(out->eps_q_dot, in.eps_q_dot, sizeof out->eps_q_dot);
  ethd_status status = plan->track ? plan->track(plan->tracking_p, core->tracking.at, &in, tau) : follow(t, &in, tau);
  return ethd__law_is_good(core, ETHD_TRACKING, status, isfinite(tau[0]) && isfinite(tau[1]));
}

bool ethd__evaluate(ethd__tick *t) {
  ethd_trace *out = t->trace;
  double tau_t[2] = {0, 0}, tau_f[2];
  ethd__estimate(t);
  if (!ethd__touch(t)) return false;
  if (!track(t, tau_t)) return false;
  if (t->state->absent > 0) out->beta *= 1 - t->state->absent;
  ethd_vec force = {out->fe[0] + out->fd[0], out->fe[1] + out->fd[1]};
  ethd_pose_torques(&t->pose, force, tau_f);
  for (int i = 0; i < 2; i++) out->tau_raw[i] = out->beta * tau_t[i] + tau_f[i];
  return true;
}
