#include <string.h>

#include "control/candidates.h"

/* ---- one contact ---- */

/* Without its age. */
static ethd_contact measure(const ethd__plan *plan, const ethd_trace *t, const ethd__candidate *k, double dt) ETHD_RT {
  const ethd_touch *touch = &k->touch;
  ethd_contact c;
  memset(&c, 0, sizeof c);
  double along = ethd_vec_dot(touch->n, ethd_vec_sub(touch->point, (ethd_vec){t->xf[0], t->xf[1]}));
  c.point = touch->point;
  c.n = touch->n;
  c.d_re = touch->distance - plan->setup.ring_radius;
  c.d_fe = along - plan->setup.finger_radius;
  c.d_fr = along - plan->setup.ring_radius;
  c.v = touch->n.x * (t->v[0] - k->v.x) + touch->n.y * (t->v[1] - k->v.y);
  c.v_f = touch->n.x * (t->vf[0] - k->v.x) + touch->n.y * (t->vf[1] - k->v.y);
  c.d_beta = plan->d_beta;
  c.period = dt;
  c.object = touch->object;
  c.body = k->place;
  return c;
}

/* NaN fails every one of these. */
static int ruling_is_good(const ethd_ruling *r) ETHD_RT {
  return r->beta >= 0 && r->beta <= 1 && r->share >= 0 && r->share <= 1 && r->damping >= 0 && isfinite(r->damping) &&
         isfinite(r->offset) && isfinite(r->feed) && isfinite(r->shift.x) && isfinite(r->shift.y) &&
         isfinite(r->argument);
}

static int rule(const ethd__plan *plan, ethd__slot *slot, const ethd_contact *c, ethd_ruling *out,
                ethd__failure *failure) ETHD_RT {
  memset(out, 0, sizeof *out);
  out->beta = 1;
  out->argument = c->d_fe;
  ethd_status status = plan->setup.transition->step(plan->setup.transition_p, slot->transition, c, out);
  if (status < 0) {
    *failure = (ethd__failure){ETHD_FAULT_LAW, 100 * ETHD_TRANSITION - status};
    return 0;
  }
  if (!ruling_is_good(out)) {
    *failure = (ethd__failure){ETHD_FAULT_FINITE, ETHD_TRANSITION};
    return 0;
  }
  return 1;
}

/* Entering until v < -h, leaving until v > h. */
static int entering(ethd__slot *slot, double v, double h) ETHD_RT {
  if (v < -h)
    slot->leaving = 1;
  else if (v > h)
    slot->leaving = 0;
  return !slot->leaving;
}

/* Force of the (offset) wall along n; never attractive. */
static int wall(const ethd__plan *plan, ethd__slot *slot, const ethd_contact *c, int32_t material, const ethd_ruling *r,
                double *force, ethd__failure *failure) ETHD_RT {
  int in = entering(slot, c->v, plan->setup.v_hysteresis);
  *force = 0;
  if (!(r->share > 0)) return 1;
  ethd_status status = plan->setup.contact->step(ethd__contact_p(plan, c->body, material), slot->contact,
                                                 c->d_re + r->offset, c->v, in, force);
  if (status < 0) {
    *failure = (ethd__failure){ETHD_FAULT_LAW, 100 * ETHD_CONTACT - status};
    return 0;
  }
  if (!isfinite(*force)) {
    *failure = (ethd__failure){ETHD_FAULT_FINITE, ETHD_CONTACT};
    return 0;
  }
  *force = *force < 0 ? r->share * *force : 0;
  return 1;
}

/* ---- all of them ---- */

void ethd__slot_start(const ethd__plan *plan, ethd__slot *slot) {
  ethd__block_reset(&plan->setup.transition->law, plan->setup.transition_p, slot->transition);
  ethd__block_reset(&plan->setup.contact->law, plan->setup.contact_p, slot->contact);
  slot->state = ETHD_TRANSPARENT;
}

static ethd__slot *free_slot(const ethd__plan *plan, ethd__state *state) ETHD_RT {
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    ethd__slot *slot = &state->slots[i];
    if (slot->used) continue;
    memset(slot, 0, sizeof *slot);
    ethd__slot_start(plan, slot);
    return slot;
  }
  return NULL;
}

static int could_count(const ethd_contact *c, const ethd__slot *slot) ETHD_RT {
  return c->d_re < c->d_beta || c->d_fr <= c->d_beta || (slot && slot->state != ETHD_TRANSPARENT);
}

static void add_force(double to[2], double force, ethd_vec n) ETHD_RT {
  to[0] += force * n.x;
  to[1] += force * n.y;
}

static void add(const ethd_contact *c, const ethd_ruling *r, double force, ethd_trace *out, ethd_vec *shift) ETHD_RT {
  if (out->contacts++ == 0) { /* the deepest comes first */
    out->object = c->object;
    out->body = c->body;
    out->state = r->state;
    out->eps = r->offset;
    out->d_re = c->d_re;
    out->d_fe = r->argument;
    out->v_n = c->v;
  }
  if (out->contacts == 1 || r->beta < out->beta) {
    out->beta = r->beta;
    *shift = r->shift;
  }
  add_force(out->fe, force + r->feed, c->n);
  add_force(out->fd, -r->damping * c->v, c->n);
}

static int contact(const ethd__plan *plan, ethd__state *state, const ethd__candidate *k, ethd_contact *c,
                   ethd__slot *slot, ethd_trace *out, ethd_vec *shift, ethd__failure *failure) ETHD_RT {
  const ethd_touch *touch = &k->touch;
  ethd_ruling r;
  double force;
  c->age = (double)slot->periods * plan->setup.period;
  slot->object = touch->object; /* whose the slot is stands in it before a law may fail */
  slot->place = k->place;
  slot->point = k->local;
  slot->side = touch->side;
  if (!rule(plan, slot, c, &r, failure)) return 0;
  slot->used = c->d_re < c->d_beta || r.argument <= c->d_beta || r.state != ETHD_TRANSPARENT;
  if (!slot->used) return 1;
  if (!wall(plan, slot, c, touch->material, &r, &force, failure)) return 0;
  if (plan->setup.limits.energy < (double)INFINITY)
    force += ethd__passivity(plan, state, slot, c, force, r.feed - r.damping * c->v);
  slot->state = r.state;
  slot->periods += (int64_t)rint(c->period / plan->setup.period); /* whole: the age doesn't drift */
  add(c, &r, force, out, shift);
  return 1;
}

static void nothing(ethd_trace *out, ethd_vec *shift) ETHD_RT {
  out->queried = out->contacts = out->overflow = out->body = out->state = 0;
  out->object = -1;
  out->beta = 1;
  out->fe[0] = out->fe[1] = out->fd[0] = out->fd[1] = out->eps = 0;
  out->d_re = out->d_fe = out->v_n = (double)NAN;
  *shift = (ethd_vec){0, 0};
}

/* Contacts that no touch continues end here. */
static void end_lost(ethd__state *state, const ethd__candidates *c) ETHD_RT {
  unsigned lost = c->live;
  for (int k = 0; k < c->count; k++)
    if (c->at[k].slot >= 0) lost &= ~(1u << c->at[k].slot);
  for (; lost; lost &= lost - 1) {
    ethd__slot *slot = &state->slots[__builtin_ctz(lost)];
    slot->used = 0;
    if (slot->state != ETHD_TRANSPARENT) state->counters.contacts_lost++;
  }
}

static void no_room(ethd__state *state, int count, ethd_trace *out) ETHD_RT {
  out->overflow += count;
  state->counters.contacts_lost += (uint64_t)count;
}

/* Takes the shallowest contact's slot away from it: it stands further down the list than candidate k. */
static void make_room(ethd__state *state, ethd__candidates *c, int k) ETHD_RT {
  for (int i = c->count - 1; i > k; i--) {
    if (c->at[i].slot < 0) continue;
    state->slots[c->at[i].slot].used = 0;
    c->at[i].slot = -1;
    return;
  }
}

static ethd__slot *new_slot(const ethd__plan *plan, ethd__state *state, ethd__candidates *c, int k) ETHD_RT {
  ethd__slot *slot = free_slot(plan, state);
  if (slot) return slot;
  make_room(state, c, k);
  return free_slot(plan, state);
}

int ethd__contacts(const ethd__plan *plan, ethd__state *state, double dt, ethd_trace *out, ethd_vec *shift,
                   ethd__failure *failure) {
  nothing(out, shift);
  if (!plan->places) return 1;
  ethd__candidates c;
  ethd__candidates_collect(plan, state, out, &c);
  out->queried = c.queried;
  state->counters.queried += (uint64_t)c.queried;
  end_lost(state, &c);
  no_room(state, c.overflow, out);
  for (int k = 0, taken = 0; k < c.count; k++) {
    ethd__slot *slot = c.at[k].slot < 0 ? NULL : &state->slots[c.at[k].slot];
    ethd_contact m = measure(plan, out, &c.at[k], dt);
    int counts = could_count(&m, slot), room = taken < ETHD_CONTACTS_MAX;
    if (counts && room) {
      if (!slot) slot = new_slot(plan, state, &c, k);
      if (!contact(plan, state, &c.at[k], &m, slot, out, shift, failure)) return 0;
      taken += slot->used;
    } else {
      if (slot) slot->used = 0;
      if (counts) no_room(state, 1, out); /* the shallowest go */
    }
  }
  return 1;
}
