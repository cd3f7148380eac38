/* Every parameter at both ends of its range, alone and in all pairs, in a loop that taps at a wall: the
   setup is accepted, every number of the trace is finite, the torque is within its limit, and no fault
   comes but those that a limit of 0 is there for. As in the programs, the device's torque limit counts.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "ethd/estimate.h"
#include "stress/mass.h"

#define KNOBS_MAX 64
#define FORCE 5.357 /* N: the device's limit */
#define SPARE 1e-5  /* m: so far finger.radius_max stays from the ring */

typedef struct knob {
  char name[64];
  double ends[2];
} knob;

typedef struct knobs {
  knob at[KNOBS_MAX];
  int count;
} knobs;

/* ---- what there is to turn ---- */

/* Every single number but the arm's mechanism; of the limits those that act on every tap. */
static bool is_turned(const ethd_setup_key *key) {
  static const char *const limits[] = {"torque", "torque_rate", "speed", "step_time"};
  if (key->count > 1 || (!strcmp(key->section, "arm") && ethd_param_words(&key->param))) return false;
  if (strcmp(key->section, "limits")) return true;
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
    if (!strcmp(limits[i], key->param.name)) return true;
  return false;
}

static void collect(const ethd_setup *s, knobs *all) {
  ethd_setup_key key;
  all->count = 0;
  for (uint32_t i = 0; ethd_setup_key_at(s, i, &key) == ETHD_OK; i++) {
    if (!is_turned(&key)) continue;
    knob *k = &all->at[all->count++];
    snprintf(k->name, sizeof k->name, "%s.%s", key.section, key.param.name);
    k->ends[0] = key.param.min;
    k->ends[1] = key.param.max;
  }
}

/* The finger's radii go with the ring's, and end where it does. The ring is turned before them. */
static void turn(ethd_setup *s, const knob *k, int end) {
  double value = k->ends[end];
  if (!strcmp(k->name, "ring.radius")) {
    s->finger_radius = fmax(s->finger_radius * value / s->ring_radius, 1e-4);
    s->finger_radius_max *= value / s->ring_radius;
  } else if (end && !strcmp(k->name, "finger.radius")) {
    value = s->ring_radius;
  } else if (end && !strcmp(k->name, "finger.radius_max")) {
    value = s->ring_radius - SPARE;
  }
  rig_set(s, k->name, value);
}

/* ---- a tap ---- */

static bool all_finite(const double *v, int n) {
  for (int i = 0; i < n; i++)
    if (!isfinite(v[i])) return false;
  return true;
}

static bool trace_is_finite(const ethd_trace *t) {
  return all_finite(t->x, 2) && all_finite(t->v, 2) && all_finite(t->xf, 2) && all_finite(t->vf, 2) &&
         all_finite(t->qd, 2) && all_finite(t->eps_q, 2) && all_finite(t->eps_q_dot, 2) && all_finite(&t->beta, 1) &&
         all_finite(t->fe, 2) && all_finite(t->fd, 2) && all_finite(&t->eps, 1) && all_finite(t->tau_raw, 2) &&
         all_finite(t->tau, 2) &&
         (!t->contacts || (all_finite(&t->d_re, 1) && all_finite(&t->d_fe, 1) && all_finite(&t->v_n, 1)));
}

static bool torque_is_held(const ethd_trace *t, double most) {
  return fabs(t->tau[0]) <= most && fabs(t->tau[1]) <= most;
}

/* Limits of 0 are there to stop a ring that moves, a torque that rises, a step that takes time. */
static bool expected(const ethd_setup *s, int64_t fault) {
  return (fault == ETHD_FAULT_SPEED && s->limits.speed == 0) ||
         (fault == ETHD_FAULT_TORQUE_RATE && s->limits.torque_rate == 0) ||
         (fault == ETHD_FAULT_BUDGET && s->limits.step_time == 1e-9);
}

/* The finger comes as frames of rays and readings of the centre by turns, a little ahead. */
static void read_finger(const mass_rig *r, ethd_sense *s) {
  ethd_vec centre = {-0.1 * r->on.setup.ring_radius, 0.02 * r->on.setup.ring_radius};
  ethd_pose pose;
  s->step_ns = 1000;
  s->sample_ns = s->time_ns;
  if (r->tick == 0) {
    ethd_arm_pose(&r->on.setup.arm, s->q, &pose);
    s->have |= ETHD_HAVE_START;
    s->finger[0] = pose.x.x, s->finger[1] = pose.x.y;
  } else if (r->tick % 6 == 3) {
    s->have |= ETHD_HAVE_RAYS;
    ethd_fit_rays(r->on.setup.ring_radius, r->on.setup.finger_radius, centre, s->rays);
  } else if (r->tick % 3 == 0) {
    s->have |= ETHD_HAVE_CENTRE;
    s->centre[0] = centre.x, s->centre[1] = centre.y;
  }
}

static void tap(mass_rig *r, int ticks, const char *name) {
  ethd_setup other = r->on.setup;
  ethd_error error;
  ethd_setup_transition(&other, &ethd_transition_smooth);
  for (int k = 0; k < ticks && !r->on.trace.fault; k++) {
    if (k == ticks / 2)
      ck_assert_msg(ethd_control_post(r->on.control, &other, &error) == ETHD_OK, "%s: %s", name, error.name);
    ethd_sense sense = mass_sense(r);
    read_finger(r, &sense);
    (void)rig_try(&r->on, &sense);
    mass_move(r);
    const ethd_trace *t = &r->on.trace;
    ck_assert_msg(!t->fault || expected(&r->on.setup, t->fault), "%s: %s", name,
                  ethd_fault_sentence((ethd_fault)t->fault));
    ck_assert_msg(trace_is_finite(t), "%s, tick %d: not finite", name, k);
    ck_assert_msg(torque_is_held(t, r->on.setup.limits.torque), "%s, tick %d: over the torque limit", name, k);
  }
}

/* Returns whether a limit of 0 stopped it. */
static int one(const ethd_setup *setup, int ticks, const char *name) {
  mass_rig r;
  ethd_limits device = ethd_limits_none();
  mass_open(&r, 0.1173, 0.0002);
  r.on.setup = *setup;
  device.torque = FORCE * fmin(setup->arm.link1, setup->arm.link2);
  r.on.setup.limits = ethd_limits_narrower(&device, &setup->limits);
  r.force_limit = FORCE;
  mass_start(&r, 0.3);
  tap(&r, ticks, name);
  mass_close(&r);
  return r.on.trace.fault != 0;
}

/* ---- all ends ---- */

static int pairs(const ethd_setup *base, int ticks) {
  knobs all;
  char name[192];
  collect(base, &all);
  int stopped = one(base, ticks, "defaults");
  for (int i = 0; i < all.count; i++)
    for (int k = i; k < all.count; k++)
      for (int ends = 0; ends < (i == k ? 2 : 4); ends++) {
        ethd_setup setup = *base;
        turn(&setup, &all.at[i], ends & 1);
        if (k > i) turn(&setup, &all.at[k], ends >> 1);
        snprintf(name, sizeof name, "%s at %s, %s at %s", all.at[i].name, ends & 1 ? "max" : "min", all.at[k].name,
                 (k > i ? ends >> 1 : ends) ? "max" : "min");
        stopped += one(&setup, ticks, name);
      }
  return stopped;
}

static const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                   &ethd_contact_hunt_crossley};
static const ethd_transition_law *const transitions[] = {&ethd_transition_offset, &ethd_transition_smooth,
                                                         &ethd_transition_abrupt, &ethd_transition_predictive};
enum { TRANSITIONS = sizeof transitions / sizeof *transitions };

TEST(test_parameters) {
  const int ticks = (int)pick(60, 300);
  int stopped = 0;
  for (int v = 0; v < ETHD_VELOCITY_COUNT; v++)
    for (int f = 0; f < ETHD_FILTER_COUNT; f++) {
      if (!pick(0, 1) && f != v % ETHD_FILTER_COUNT) continue;
      ethd_setup base = ethd_setup_default();
      ethd_setup_velocity(&base, (ethd_velocity_method)v);
      ethd_setup_filter(&base, (ethd_filter_method)f);
      ethd_setup_fit(&base, (ethd_fit_method)((v + f) % ETHD_FIT_COUNT));
      ethd_setup_contact(&base, contacts[(v + f) % 3]);
      ethd_setup_transition(&base, transitions[v % 3 == 0 ? 0 : (v + 2 * f) % TRANSITIONS]);
      stopped += pairs(&base, ticks);
    }
  ck_assert_int_gt(stopped, 900);
}
