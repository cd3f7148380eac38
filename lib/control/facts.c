/* Computes the device's ability along a contact's normal from the pose, the links' inertias and the limits.

     g = J^T n            torques of a unit force along n      w = J^-1 n     joint speeds of a unit speed along it
     m = 1 / (h^T M^-1 h)      effective mass: h = g in the links' absolute angles, M = diag(m_i L_i^2)
     F = min_i tau_i / |g_i|   the largest force within each motor's limit
     f_c sum_i |w_i| L_i       friction of the joints that move */
#include "control/facts.h"

#include "guard/parts.h"

/* Returns the lesser of two numbers; a b that is NaN, for unknown, is returned. */
static double least(double a, double b) { return a < b ? a : b; }

/* Converts the joints' torques to torques on the links' absolute angles: a serial arm's second motor is on link 1. */
static void on_links(const ethd__plan *plan, const double tau[2], double out[2]) {
  out[0] = plan->setup.arm.mechanism == ETHD_ARM_SERIAL ? tau[0] - tau[1] : tau[0];
  out[1] = tau[1];
}

/* Returns the largest torque against g that the limits of joint i allow at this tick, Nm. */
static double room(const ethd__tick *t, int i, double g) {
  const ethd_limits *limits = &t->plan->setup.limits;
  const ethd_guard_state *guard = &t->state->guard;
  double most = limits->torque;
  if (limits->nominal_torque < (double)INFINITY) most = least(most, ethd__guard_cool(limits, guard->heat[i]));
  if (limits->torque_rate < (double)INFINITY) {
    double now = g > 0 ? -guard->last[i] : guard->last[i];
    most = least(most, now + limits->torque_rate * t->dt > 0 ? now + limits->torque_rate * t->dt : 0);
  }
  return most;
}

/* Returns the age of the finger's estimated position: a filter that doesn't compensate the readings' age gives a
   position as old as the readings. */
static double finger_age(const ethd__tick *t) {
  const ethd__state *state = t->state;
  if (t->sense->have & ETHD_HAVE_FINGER) return 0;
  if (!state->filter.started) return (double)NAN;
  if (state->filter.used == 0 || t->plan->filter.compensation == ETHD_COMPENSATION_STAMP) return 0;
  return state->reading_age;
}

static double finger_acceleration(const ethd__tick *t, ethd_vec n) {
  const ethd_filter_state *filter = &t->state->filter;
  bool known = t->plan->filter.method == ETHD_FILTER_CA && filter->started && !(t->sense->have & ETHD_HAVE_FINGER);
  return known ? ethd_vec_dot(n, ethd_vec_of(filter->a)) : (double)NAN;
}

void ethd__facts(const ethd__tick *t, const ethd_contact *c, ethd_facts *out) {
  const ethd_setup *setup = &t->plan->setup;
  const ethd_dynamics *d = &setup->dynamics;
  const double *mobility = t->plan->mobility;
  const ethd_vec n = {c->n.x, c->n.y};
  double g[2], h[2], w[2], last[2];
  ethd_pose_torques(&t->pose, n, g);
  ethd_pose_joints(&t->pose, n, w);
  on_links(t->plan, g, h);
  on_links(t->plan, t->state->guard.last, last);
  double w1 = fabs(w[0]) * setup->arm.link1, w2 = fabs(w[1]) * setup->arm.link2;
  double h1 = h[0] * mobility[0], h2 = h[1] * mobility[1];
  out->mass = 1 / (h1 * h[0] + h2 * h[1]);
  out->applied = out->mass * (h1 * last[0] + h2 * last[1]);
  out->force = least(room(t, 0, g[0]) / fabs(g[0]), room(t, 1, g[1]) / fabs(g[1]));
  out->friction = d->friction * (w1 + w2);
  out->viscous = d->viscous * (w1 * w1 + w2 * w2);
  out->delay = d->delay;
  out->lag = t->plan->lag;
  out->ring_radius = setup->ring_radius;
  out->finger_radius = setup->finger_radius;
  out->finger_age = finger_age(t);
  out->finger_a = finger_acceleration(t, n);
  out->memory = t->state->core.memory;
  out->acceleration = (double)NAN;
  out->room = setup->ring_radius - setup->finger_radius;
}
