#include "bounds/loops.h"

#include <math.h>
#include <string.h>

#define FELT_X 0.25
#define FELT_Y 0.25

const char *const ethd__loop_names[ETHD_LOOP_KINDS] = {"tracking", "wall", "braking"};

/* The diagonal of J^-T K J^-1 with K = k I: what a joint gain is at the ring. */
static void at_ring(const double ji[4], double k, double out[2]) {
  out[0] = k * (ji[0] * ji[0] + ji[2] * ji[2]);
  out[1] = k * (ji[1] * ji[1] + ji[3] * ji[3]);
}

static double or_zero(double value) { return isnan(value) ? 0 : value; }

bool ethd__loop_felt(const ethd_setup *setup, double stiffness[2], double damping[2]) {
  double k_t = ethd_setup_get(setup, "tracking.k_t"), q[2];
  ethd_pose pose;
  if (isnan(k_t) || ethd_arm_angles(&setup->arm, (ethd_vec){FELT_X, FELT_Y}, -1, q)) return false;
  ethd_arm_pose(&setup->arm, q, &pose);
  at_ring(pose.j_inv, k_t, stiffness);
  at_ring(pose.j_inv, or_zero(ethd_setup_get(setup, "tracking.b_t")), damping);
  return true;
}

static bool set_gains(const ethd_setup *setup, ethd__loop_kind kind, int axis, ethd__sampled_loop *out) {
  double k[2], d[2];
  switch (kind) {
  case ETHD_LOOP_TRACKING:
    if (!ethd__loop_felt(setup, k, d)) return false;
    out->stiffness = k[axis];
    out->damping = d[axis];
    return true;
  case ETHD_LOOP_WALL:
    out->stiffness = or_zero(ethd_setup_get(setup, "contact.k_e"));
    out->damping = or_zero(ethd_setup_get(setup, "contact.b_e"));
    return true;
  default: out->damping = or_zero(ethd_setup_get(setup, "transition.b_d")); return true;
  }
}

/* Delays that differ from whole ticks by rounding are whole. */
static void set_delay(ethd__sampled_loop *loop, double delay) {
  loop->delay = (int)floor(delay / loop->period * (1 + 1e-12));
  loop->late = fmax(0, delay - loop->delay * loop->period);
  if (loop->late < 1e-9 * loop->period) loop->late = 0;
}

bool ethd__loop_of(const ethd_setup *setup, const ethd__loop_device *device, ethd__loop_kind kind, int axis,
                   ethd__sampled_loop *out) {
  *out = (ethd__sampled_loop){.mass = device->mass[axis],
                              .period = setup->period,
                              .method = setup->velocity,
                              .link = axis ? setup->arm.link2 : setup->arm.link1};
  memcpy(out->p, setup->velocity_p, sizeof out->p);
  set_delay(out, device->delay);
  return set_gains(setup, kind, axis, out);
}

bool ethd__loop_keeps(const ethd__sampled_loop *loop, const ethd__loop_margin *margin) {
  static const double at[][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  if (loop->stiffness <= 0 && loop->damping <= 0) return true;
  for (int i = 0; i < 4; i++) {
    ethd__sampled_loop l = *loop;
    l.stiffness *= 1 + at[i][0] * (margin->gain - 1);
    l.damping *= 1 + at[i][1] * (margin->gain - 1);
    if (!ethd__sampled_stable(&l)) return false;
  }
  ethd__sampled_loop later = *loop;
  set_delay(&later, loop->delay * loop->period + loop->late + margin->delay);
  return later.delay <= ETHD_LOOP_DELAY_MAX && ethd__sampled_stable(&later);
}
