#include <string.h>

#include "control.h"

/* Touches looked at in one tick: the live contacts and what is newly near. */
#define CANDIDATES (2 * ETHD_CONTACTS_MAX + 8)

typedef struct candidate {
  ethd_touch touch;
  int slot; /* the one that it continues, -1: new */
} candidate;

typedef struct candidates {
  candidate at[CANDIDATES];
  int count;
} candidates;

/* ---- which touches ---- */

/* Everything that can count lies within: d_re < d_beta, or d_fe <= d_beta however far the finger is ahead. */
static double reach(const ethd__plan *plan, const ethd_trace *t) ETHD_RT {
  ethd_vec ahead = {t->xf[0] - t->x[0], t->xf[1] - t->x[1]};
  return plan->setup.ring_radius + plan->d_beta + ethd_vec_norm(ahead);
}

static double distance_between(ethd_vec a, ethd_vec b) ETHD_RT {
  return ethd_vec_norm(ethd_vec_sub(a, b));
}

static int claimed(const candidates *c, const ethd_touch *touch) ETHD_RT {
  for (int i = 0; i < c->count; i++)
    if (c->at[i].slot >= 0 && c->at[i].touch.object == touch->object &&
        c->at[i].touch.feature == touch->feature)
      return 1;
  return 0;
}

/* The unclaimed candidate that continues a slot: same object, nearest point. */
static int continuation(const candidates *c, const ethd__slot *slot) ETHD_RT {
  int best = -1;
  for (int i = 0; i < c->count; i++) {
    const candidate *k = &c->at[i];
    if (k->slot >= 0 || k->touch.object != slot->object) continue;
    if (best < 0 || distance_between(k->touch.point, slot->point) <
                        distance_between(c->at[best].touch.point, slot->point))
      best = i;
  }
  return best;
}

/* A contact lives until its state is transparent, in reach or not. */
static void follow(const ethd__plan *plan, const ethd__slot *slot, int index, ethd_vec x,
                   candidates *c) ETHD_RT {
  if (slot->state == ETHD_TRANSPARENT || c->count == CANDIDATES) return;
  candidate *k = &c->at[c->count];
  ethd_scene_follow(plan->setup.scene, slot->object, x, slot->point, &k->touch);
  if (claimed(c, &k->touch)) return;
  k->slot = index;
  c->count++;
}

static void match(const ethd__plan *plan, ethd__state *state, ethd_vec x, candidates *c) ETHD_RT {
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    if (!state->slots[i].used) continue;
    int k = continuation(c, &state->slots[i]);
    if (k >= 0)
      c->at[k].slot = i;
    else
      follow(plan, &state->slots[i], i, x, c);
  }
}

/* A thin wall's side is the one on which the contact began, until the ring has gone round an end. */
static void keep_side(ethd_touch *touch, const ethd__slot *slot) ETHD_RT {
  if (!slot || slot->side == 0 || touch->side != -slot->side) return;
  touch->n = ethd_vec_scale(-1, touch->n);
  touch->distance = -touch->distance;
  touch->side = slot->side;
}

/* Deepest first; equal depths keep the scene's order. */
static void sort(candidates *c) ETHD_RT {
  for (int i = 1; i < c->count; i++) {
    candidate k = c->at[i];
    int j = i;
    for (; j > 0 && c->at[j - 1].touch.distance > k.touch.distance; j--) c->at[j] = c->at[j - 1];
    c->at[j] = k;
  }
}

static void collect(const ethd__plan *plan, ethd__state *state, const ethd_trace *t, candidates *c,
                    int64_t *overflow) ETHD_RT {
  ethd_touch touches[CANDIDATES - ETHD_CONTACTS_MAX];
  const size_t room = sizeof touches / sizeof *touches;
  ethd_vec x = {t->x[0], t->x[1]};
  size_t found = ethd_scene_touches(plan->setup.scene, x, reach(plan, t), touches, room);
  *overflow = found > room ? (int64_t)(found - room) : 0;
  c->count = (int)(found < room ? found : room);
  for (int i = 0; i < c->count; i++) c->at[i] = (candidate){touches[i], -1};
  match(plan, state, x, c);
  for (int i = 0; i < c->count; i++)
    keep_side(&c->at[i].touch, c->at[i].slot < 0 ? NULL : &state->slots[c->at[i].slot]);
  sort(c);
}

/* ---- one contact ---- */

static ethd_contact measure(const ethd__plan *plan, const ethd_trace *t, const ethd_touch *touch,
                            double age, double dt) ETHD_RT {
  ethd_contact c;
  memset(&c, 0, sizeof c);
  double along = ethd_vec_dot(touch->n, ethd_vec_sub(touch->point, (ethd_vec){t->xf[0], t->xf[1]}));
  c.point = touch->point;
  c.n = touch->n;
  c.d_re = touch->distance - plan->setup.ring_radius;
  c.d_fe = along - plan->setup.finger_radius;
  c.d_fr = along - plan->setup.ring_radius;
  c.v = touch->n.x * t->v[0] + touch->n.y * t->v[1];
  c.v_f = touch->n.x * t->vf[0] + touch->n.y * t->vf[1];
  c.d_beta = plan->d_beta;
  c.period = dt;
  c.age = age;
  c.object = touch->object;
  return c;
}

/* NaN fails every one of these. */
static int ruling_is_good(const ethd_ruling *r) ETHD_RT {
  return r->beta >= 0 && r->beta <= 1 && r->share >= 0 && r->share <= 1 && r->damping >= 0 &&
         isfinite(r->damping) && isfinite(r->offset) && isfinite(r->feed) && isfinite(r->shift.x) &&
         isfinite(r->shift.y) && isfinite(r->argument);
}

static int rule(const ethd__plan *plan, ethd__slot *slot, const ethd_contact *c, ethd_ruling *out,
                ethd__failure *failure) ETHD_RT {
  memset(out, 0, sizeof *out);
  out->beta = 1;
  out->argument = c->d_fe;
  ethd_status status = plan->setup.transition->step(plan->setup.transition_p, slot->transition, c, out);
  if (status < 0) {
    *failure = (ethd__failure){ETHD_FAULT_LAW, 16 * ETHD_TRANSITION - status};
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
static int wall(const ethd__plan *plan, ethd__slot *slot, const ethd_contact *c, int32_t material,
                const ethd_ruling *r, double *force, ethd__failure *failure) ETHD_RT {
  int in = entering(slot, c->v, plan->setup.v_hysteresis);
  *force = 0;
  if (!(r->share > 0)) return 1;
  ethd_status status = plan->setup.contact->step(ethd__contact_p(plan, material), slot->contact,
                                                 c->d_re + r->offset, c->v, in, force);
  if (status < 0) {
    *failure = (ethd__failure){ETHD_FAULT_LAW, 16 * ETHD_CONTACT - status};
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

static void add(const ethd_contact *c, const ethd_ruling *r, double force, ethd_trace *out,
                ethd_vec *shift) ETHD_RT {
  if (out->contacts++ == 0) { /* the deepest comes first */
    out->object = c->object;
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

static int contact(const ethd__plan *plan, const ethd_touch *touch, ethd__slot *slot, double dt,
                   ethd_trace *out, ethd_vec *shift, ethd__failure *failure) ETHD_RT {
  ethd_contact c = measure(plan, out, touch, slot->age, dt);
  ethd_ruling r;
  double force;
  if (!rule(plan, slot, &c, &r, failure)) return 0;
  slot->used = c.d_re < c.d_beta || r.argument <= c.d_beta || r.state != ETHD_TRANSPARENT;
  if (!slot->used) return 1;
  if (!wall(plan, slot, &c, touch->material, &r, &force, failure)) return 0;
  slot->object = touch->object;
  slot->point = touch->point;
  slot->side = touch->side;
  slot->state = r.state;
  slot->age += dt;
  add(&c, &r, force, out, shift);
  return 1;
}

static void nothing(ethd_trace *out, ethd_vec *shift) ETHD_RT {
  out->queried = out->contacts = out->overflow = out->state = 0;
  out->object = -1;
  out->beta = 1;
  out->fe[0] = out->fe[1] = out->fd[0] = out->fd[1] = out->eps = 0;
  out->d_re = out->d_fe = out->v_n = (double)NAN;
  *shift = (ethd_vec){0, 0};
}

/* Slots that no candidate continues end here. */
static void end_lost(ethd__state *state, const candidates *c) ETHD_RT {
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    int kept = 0;
    for (int k = 0; k < c->count; k++) kept |= c->at[k].slot == i;
    if (kept || !state->slots[i].used) continue;
    state->slots[i].used = 0;
    if (state->slots[i].state != ETHD_TRANSPARENT) state->counters.contacts_lost++;
  }
}

int ethd__contacts(const ethd__plan *plan, ethd__state *state, double dt, ethd_trace *out,
                   ethd_vec *shift, ethd__failure *failure) {
  nothing(out, shift);
  if (!plan->setup.scene) return 1;
  out->queried = 1;
  state->counters.queried++;
  candidates c;
  collect(plan, state, out, &c, &out->overflow);
  end_lost(state, &c);
  for (int i = 0, taken = 0; i < c.count; i++) {
    ethd__slot *slot = c.at[i].slot < 0 ? NULL : &state->slots[c.at[i].slot];
    ethd_contact m = measure(plan, out, &c.at[i].touch, 0, dt);
    if (!could_count(&m, slot)) {
      if (slot) slot->used = 0;
      continue;
    }
    if (taken == ETHD_CONTACTS_MAX) { /* the shallowest go */
      if (slot) slot->used = 0;
      out->overflow++;
      continue;
    }
    if (!slot) slot = free_slot(plan, state);
    if (!slot) { /* held by shallower ones further down the list */
      out->overflow++;
      continue;
    }
    if (!contact(plan, &c.at[i].touch, slot, dt, out, shift, failure)) return 0;
    taken += slot->used;
  }
  return 1;
}
