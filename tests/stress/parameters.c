/* Every parameter at both ends of its range, alone and in all pairs, in a loop that taps at a wall: the
   setup is accepted, every number of the trace is finite, the torque is within its limit, and no fault
   comes but those that a limit of 0 is there for. As in the programs, the device's torque limit counts.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "ethd/estimate.h"
#include "stress/rig.h"
#include "stress/stress.h"

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
  ethd__stress_set(s, k->name, value);
}

/* ---- a tap ---- */

typedef struct setups_tally {
  int64_t runs, refused, stopped, faults, broken; /* broken: not finite or over the limit */
  char refusal[320], fault[320], breach[320];
} setups_tally;

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
static void read_finger(const ethd__stress_rig *rig, ethd_sense *s) {
  ethd_vec centre = {-0.1 * rig->setup.ring_radius, 0.02 * rig->setup.ring_radius};
  ethd_pose pose;
  s->step_ns = 1000;
  s->sample_ns = s->time_ns;
  if (rig->tick == 0) {
    ethd_arm_pose(&rig->setup.arm, s->q, &pose);
    s->have |= ETHD_HAVE_START;
    s->finger[0] = pose.x.x, s->finger[1] = pose.x.y;
  } else if (rig->tick % 6 == 3) {
    s->have |= ETHD_HAVE_RAYS;
    ethd_fit_rays(rig->setup.ring_radius, rig->setup.finger_radius, centre, s->rays);
  } else if (rig->tick % 3 == 0) {
    s->have |= ETHD_HAVE_CENTRE;
    s->centre[0] = centre.x, s->centre[1] = centre.y;
  }
}

static void tap(ethd__stress_rig *rig, int ticks, const char *name, setups_tally *t) {
  ethd_setup other = rig->setup;
  ethd_error error;
  ethd_setup_transition(&other, &ethd_transition_smooth);
  for (int k = 0; k < ticks; k++) {
    if (k == ticks / 2 && ethd_control_post(rig->control, &other, &error) < 0) t->refused++;
    ethd_sense sense = ethd__stress_rig_sense(rig);
    read_finger(rig, &sense);
    (void)ethd_control_step(rig->control, &sense, &rig->command, &rig->trace);
    ethd__stress_rig_move(rig);
    if (rig->trace.fault && expected(&rig->setup, rig->trace.fault)) {
      t->stopped++;
    } else if (rig->trace.fault) {
      t->faults++;
      snprintf(t->fault, sizeof t->fault, "%s: %s", name, ethd_fault_sentence((ethd_fault)rig->trace.fault));
    }
    if (!trace_is_finite(&rig->trace) || !torque_is_held(&rig->trace, rig->setup.limits.torque)) {
      t->broken++;
      snprintf(t->breach, sizeof t->breach, "%s, tick %d", name, k);
    }
    if (rig->trace.fault) return;
  }
}

static void one(const ethd_setup *setup, int ticks, const char *name, setups_tally *t) {
  ethd__stress_rig rig;
  ethd_error error;
  ethd_limits device = ethd_limits_none();
  ethd__stress_rig_open(&rig, 0.1173, 0.0002);
  rig.setup = *setup;
  device.torque = FORCE * fmin(setup->arm.link1, setup->arm.link2);
  rig.setup.limits = ethd_limits_narrower(&device, &setup->limits);
  rig.force_limit = FORCE;
  t->runs++;
  if (ethd_setup_check(&rig.setup, &error) < 0) {
    t->refused++;
    snprintf(t->refusal, sizeof t->refusal, "%s: %s", name, error.name);
    return;
  }
  ethd__stress_rig_start(&rig, 0.3);
  tap(&rig, ticks, name, t);
  ethd__stress_rig_close(&rig);
}

/* ---- all ends ---- */

static void pairs(const ethd_setup *base, int ticks, setups_tally *t) {
  knobs all;
  char name[192];
  collect(base, &all);
  one(base, ticks, "defaults", t);
  for (int i = 0; i < all.count; i++)
    for (int k = i; k < all.count; k++)
      for (int ends = 0; ends < (i == k ? 2 : 4); ends++) {
        ethd_setup setup = *base;
        turn(&setup, &all.at[i], ends & 1);
        if (k > i) turn(&setup, &all.at[k], ends >> 1);
        snprintf(name, sizeof name, "%s at %s, %s at %s", all.at[i].name, ends & 1 ? "max" : "min", all.at[k].name,
                 (k > i ? ends >> 1 : ends) ? "max" : "min");
        one(&setup, ticks, name, t);
      }
}

static const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                   &ethd_contact_hunt_crossley};
static const ethd_transition_law *const transitions[] = {&ethd_transition_offset, &ethd_transition_smooth,
                                                         &ethd_transition_abrupt, &ethd_transition_predictive};
enum { TRANSITIONS = sizeof transitions / sizeof *transitions };

static void run(ethd__stress_log *log) {
  int quick = log->effort == ETHD__QUICK, ticks = quick ? 60 : 300;
  setups_tally t = {0};
  for (int v = 0; v < ETHD_VELOCITY_COUNT; v++)
    for (int f = 0; f < ETHD_FILTER_COUNT; f++) {
      if (quick && f != v % ETHD_FILTER_COUNT) continue;
      ethd_setup base = ethd_setup_default();
      ethd_setup_velocity(&base, (ethd_velocity_method)v);
      ethd_setup_filter(&base, (ethd_filter_method)f);
      ethd_setup_fit(&base, (ethd_fit_method)((v + f) % ETHD_FIT_COUNT));
      ethd_setup_contact(&base, contacts[(v + f) % 3]);
      ethd_setup_transition(&base, transitions[v % 3 == 0 ? 0 : (v + 2 * f) % TRANSITIONS]);
      pairs(&base, ticks, &t);
    }
  ethd__stress_within(log, "setups", (double)t.refused, 0, 0, "setups refused of those tried");
  ethd__stress_within(log, "ticks", (double)t.faults, 0, 0, "faults that no limit asked for");
  ethd__stress_within(log, "ticks", (double)t.broken, 0, 0, "ticks not finite, or over the torque limit");
  ethd__stress_note(log, "%lld setups of %d ticks, %lld stopped by a limit of 0", (long long)t.runs, ticks,
                    (long long)t.stopped);
  if (t.refused) ethd__stress_note(log, "refused: %s", t.refusal);
  if (t.faults) ethd__stress_note(log, "fault: %s", t.fault);
  if (t.broken) ethd__stress_note(log, "broken: %s", t.breach);
}

const ethd__stress ethd__stress_parameters = {"parameters",
                                              "every parameter at both ends of its range, alone and in pairs", run};
