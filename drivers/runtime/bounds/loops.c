#include "bounds/loops.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const ethd__bounds_names[ETHD_LOOP_KINDS] = {"tracking", "wall", "braking"};

ethd__bounds_device ethd__bounds_device_of(const ethd_plant *p, double hand) {
  bool rigid = !isfinite(p->stiffness);
  double with = hand * p->finger_mass;
  return (ethd__bounds_device){.mass = {p->mass[0] + with, p->mass[1] + with},
                               .motor_mass = rigid ? 0 : p->motor_mass,
                               .spring = rigid ? 0 : p->stiffness,
                               .damper = rigid ? 0 : p->damping,
                               .delay = p->delay,
                               .friction = p->friction,
                               .viscous = p->viscous,
                               .count = p->count};
}

/* ---- gains ---- */

static double or_zero(double value) { return isnan(value) ? 0 : value; }

/* Computes J^-T K J^-1 for K = k I. */
static void at_ring(const double ji[4], double k, double along[2], double *across) {
  along[0] = k * (ji[0] * ji[0] + ji[2] * ji[2]);
  along[1] = k * (ji[1] * ji[1] + ji[3] * ji[3]);
  *across = k * (ji[0] * ji[1] + ji[2] * ji[3]);
  if (fabs(*across) < 1e-9 * (along[0] + along[1])) *across = 0;
}

static const ethd_law *law_of(const ethd_setup *setup, ethd__bounds_kind kind) {
  if (kind == ETHD_LOOP_TRACKING) return &setup->tracking->law;
  return kind == ETHD_LOOP_WALL ? &setup->contact->law : &setup->transition->law;
}

static double gain(const ethd_setup *setup, const char *section, const char *name, char key[48]) {
  key[0] = 0;
  if (!name) return 0;
  snprintf(key, 48, "%s.%s", section, name);
  return ethd_setup_get(setup, key);
}

bool ethd__bounds_gains_of(const ethd_setup *setup, ethd__bounds_kind kind, ethd__bounds_gains *out) {
  static const char *const sections[ETHD_LOOP_KINDS] = {"tracking", "contact", "transition"};
  const ethd_gains *gains = ethd_law_gains(law_of(setup, kind));
  if (!gains) return false;
  out->stiffness = gain(setup, sections[kind], gains->stiffness, out->stiffness_key);
  out->damping = gain(setup, sections[kind], gains->damping, out->damping_key);
  return true;
}

const ethd_law *ethd__bounds_unjudged(const ethd_setup *setup, ethd__bounds_kind kind) {
  const ethd_law *law = law_of(setup, kind);
  return ethd_law_gains(law) ? NULL : law;
}

bool ethd__bounds_feel(const ethd_setup *setup, ethd__bounds_felt *out) {
  ethd__bounds_gains gains;
  double q[2];
  ethd_pose pose;
  if (!ethd__bounds_gains_of(setup, ETHD_LOOP_TRACKING, &gains) || !*gains.stiffness_key ||
      ethd_arm_angles(&setup->arm, (ethd_vec){ETHD_LOOP_FELT_X, ETHD_LOOP_FELT_Y}, -1, q))
    return false;
  ethd_arm_pose(&setup->arm, q, &pose);
  at_ring(pose.j_inv, gains.stiffness, out->stiffness, &out->stiffness_across);
  at_ring(pose.j_inv, gains.damping, out->damping, &out->damping_across);
  return true;
}

static bool set_gains(const ethd_setup *setup, ethd__bounds_kind kind, int axis, ethd__sampled_loop *out) {
  ethd__bounds_gains gains;
  ethd__bounds_felt felt;
  if (!ethd__bounds_gains_of(setup, kind, &gains)) return false;
  if (kind == ETHD_LOOP_TRACKING && !ethd__bounds_feel(setup, &felt)) return false;
  out->stiffness = kind == ETHD_LOOP_TRACKING ? felt.stiffness[axis] : gains.stiffness;
  out->damping = kind == ETHD_LOOP_TRACKING ? felt.damping[axis] : gains.damping;
  return true;
}

bool ethd__bounds_of(const ethd_setup *setup, const ethd__bounds_device *device, ethd__bounds_kind kind, int axis,
                     ethd__sampled_loop *out) {
  *out = (ethd__sampled_loop){.mass = isnan(device->mass[axis]) ? 1 : device->mass[axis],
                              .motor_mass = device->motor_mass,
                              .spring = device->spring,
                              .damper = device->damper,
                              .period = setup->period,
                              .method = setup->velocity,
                              .link = axis ? setup->arm.link2 : setup->arm.link1};
  memcpy(out->p, setup->velocity_p, sizeof out->p);
  ethd__sampled_set_delay(out, or_zero(device->delay));
  return set_gains(setup, kind, axis, out);
}

/* ---- rows ---- */

static void add(ethd__bounds_row *out, int *n, ethd__bounds_number number, double value, double end, bool least) {
  double margin = least ? value / end : value > 0 ? end / value : (double)NAN;
  out[(*n)++] = (ethd__bounds_row){number, value, end, least, margin};
}

int ethd__bounds_rows(const ethd__sampled_loop *l, ethd__bounds_row out[ETHD_LOOP_NUMBERS]) {
  int n = 0;
  double k = l->stiffness, b = l->damping, least = ethd__sampled_mass_min(l), longest = ethd__sampled_delay_max(l);
  double velocity = ethd__sampled_velocity_end(l);
  if (k > 0) add(out, &n, ETHD_LOOP_STIFFNESS, k, ethd__sampled_stiffness_max(l), false);
  add(out, &n, ETHD_LOOP_DAMPING, b, ethd__sampled_damping_max(l), false);
  if (isfinite(least)) add(out, &n, ETHD_LOOP_MASS, l->mass, least, true);
  if (longest >= 0) add(out, &n, ETHD_LOOP_DELAY, l->delay * l->period + l->late, longest, false);
  if (!isnan(velocity)) add(out, &n, ETHD_LOOP_VELOCITY, l->p[0], velocity, l->method == ETHD_VELOCITY_LOWPASS);
  return n;
}

/* Tests stability at the margin, which is faster than a search for the ends of the rows. */
bool ethd__bounds_keeps(const ethd__sampled_loop *l, const ethd__bounds_margin *margin) {
  if (l->stiffness <= 0 && l->damping <= 0) return true;
  return ethd__sampled_stable_up_to(l, margin->gain, margin->gain) && ethd__sampled_stable_up_to(l, margin->gain, 1) &&
         ethd__sampled_stable_up_to(l, 1, margin->gain) && ethd__sampled_stable_later(l, margin->delay);
}

ethd__bounds_hold ethd__bounds_holds(const ethd__sampled_loop *l, const ethd__bounds_device *device) {
  double needed = ethd__sampled_viscous_needed(l);
  return (ethd__bounds_hold){.needed = needed,
                             .held = ethd__sampled_held(needed, device->friction, device->viscous),
                             .kick = ethd__sampled_kick(l, device->count * l->link)};
}
