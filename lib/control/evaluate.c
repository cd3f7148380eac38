#include "control/control.h"

static int track(const ethd__plan *plan, ethd__state *state, const ethd_pose *pose, ethd_vec shift, double dt,
                 ethd_trace *out, double tau[2], ethd__failure *failure) ETHD_RT {
  ethd_vec xf = {out->xf[0], out->xf[1]}, vf = {out->vf[0], out->vf[1]};
  ethd_tracking_in in;
  in.eps_x = ethd_vec_sub(ethd_vec_add(xf, shift), pose->x);
  in.eps_v = ethd_vec_sub(vf, (ethd_vec){out->v[0], out->v[1]});
  in.period = dt;
  ethd_vec e = ethd_mat_mul(pose->j_inv, in.eps_x), e_dot = ethd_mat_mul(pose->j_inv, in.eps_v);
  in.eps_q[0] = out->eps_q[0] = e.x;
  in.eps_q[1] = out->eps_q[1] = e.y;
  in.eps_q_dot[0] = out->eps_q_dot[0] = e_dot.x;
  in.eps_q_dot[1] = out->eps_q_dot[1] = e_dot.y;
  ethd_status status = plan->setup.tracking->step(plan->setup.tracking_p, state->tracking, &in, tau);
  if (status < 0) {
    *failure = (ethd__failure){ETHD_FAULT_LAW, 100 * ETHD_TRACKING - status};
    return 0;
  }
  if (!isfinite(tau[0]) || !isfinite(tau[1])) {
    *failure = (ethd__failure){ETHD_FAULT_FINITE, ETHD_TRACKING};
    return 0;
  }
  return 1;
}

/* tau = beta tau_t + J^T (F_e + F_d) (eq. 5 and figure 7) */
int ethd__evaluate(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_pose *pose,
                   ethd_trace *out, ethd__failure *failure) {
  double tau_t[2] = {0, 0};
  ethd_vec shift;
  ethd__estimate(plan, state, sense, dt, pose, out);
  if (!ethd__contacts(plan, state, dt, out, &shift, failure)) return 0;
  if (!track(plan, state, pose, shift, dt, out, tau_t, failure)) return 0;
  if (state->absent > 0) out->beta *= 1 - state->absent;
  ethd_vec force = {out->fe[0] + out->fd[0], out->fe[1] + out->fd[1]};
  ethd_vec tau_f = ethd_mat_mul_transposed(pose->j, force);
  out->tau_raw[0] = out->beta * tau_t[0] + tau_f.x;
  out->tau_raw[1] = out->beta * tau_t[1] + tau_f.y;
  return 1;
}
