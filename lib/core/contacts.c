/* The contacts and their effect on the command.

   1. Contacts that no candidate continues end.
   2. Each candidate that could count, up to ETHD_CONTACTS_MAX of them, gets a slot: that of its contact, a free one, or
      the shallowest contact's.
   3. The transition law gives its ruling: share of tracking (beta), share of the wall, offset, damping, feed, lead and
      speed. A contact that doesn't count by its ruling frees its slot.
   4. The contact law gives the force of the wall at its offset, to which the passivity observer may add damping.
   5. The forces of all contacts are added up. The smallest beta counts, with the lead of its contact. */
#include "core/contacts.h"

#include "core/fence.h"
#include "core/passivity.h"
#include "core/rows.h"

/* ---- one contact ---- */

/* The intermediate results of one contact. */
typedef struct contact_work {
  const ethd__candidate *candidate;
  ethd__slot *slot;
  ethd_contact contact;
  ethd_ruling ruling;
  ethd_facts facts; /* for a law that looks ahead */
} contact_work;

/* Computes the contact of a candidate, except its age. */
static ethd_contact measure(const ethd__core_tick *t, const ethd__candidate *k) {
  const ethd__core_plan *plan = t->plan;
  ethd_contact c;
  memset(&c, 0, sizeof c);
  double along = ethd_vec3_dot(k->n, ethd_vec3_sub(k->point, t->finger));
  c.point = k->point;
  c.n = k->n;
  c.d_re = k->distance - plan->radius;
  c.d_fe = along - plan->finger_radius;
  c.d_fr = along - plan->radius;
  c.v = ethd_vec3_dot(k->n, ethd_vec3_sub(t->v, k->v));
  c.v_f = ethd_vec3_dot(k->n, ethd_vec3_sub(t->finger_v, k->v));
  c.d_beta = plan->d_beta;
  c.period = t->dt;
  c.object = k->object;
  c.body = k->place;
  return c;
}

/* NaN fails every comparison. */
static bool ruling_is_good(const ethd_ruling *r) {
  return r->beta >= 0 && r->beta <= 1 && r->share >= 0 && r->share <= 1 && r->damping >= 0 && isfinite(r->damping) &&
         isfinite(r->offset) && isfinite(r->feed) && isfinite(r->lead) && r->speed > -(double)INFINITY &&
         isfinite(r->argument);
}

/* Calls the transition law for its ruling. */
static bool rule(const ethd__core_tick *t, contact_work *w) {
  ethd_ruling *r = &w->ruling;
  if (t->plan->range) {
    t->facts(t->front, &w->contact, &w->facts);
    w->contact.facts = &w->facts;
  }
  memset(r, 0, sizeof *r);
  r->beta = 1;
  r->speed = (double)INFINITY;
  r->argument = w->contact.d_fe;
  ethd_status status = t->plan->rule(t->plan->transition_p, w->slot->transition.at, &w->contact, r);
  return ethd__law_is_good(t->state, ETHD_TRANSITION, status, ruling_is_good(r));
}

/* Returns true while the ring enters. It counts as leaving once v < -h, and as entering again once v > h. */
static bool entering(ethd__slot *slot, double v, double h) {
  if (v < -h)
    slot->leaving = true;
  else if (v > h)
    slot->leaving = false;
  return !slot->leaving;
}

/* Force of the (offset) wall along n, N; never attractive. */
static bool wall(const ethd__core_tick *t, const contact_work *w, double *force) {
  const ethd_contact *c = &w->contact;
  bool in = entering(w->slot, c->v, t->plan->v_hysteresis);
  *force = 0;
  if (!(w->ruling.share > 0)) return true;
  double gap = c->d_re + w->ruling.offset;
  ethd_status status = t->plan->push(w->candidate->contact_p, w->slot->contact.at, gap, c->v, in, force);
  if (!ethd__law_is_good(t->state, ETHD_CONTACT, status, isfinite(*force))) return false;
  *force = *force < 0 ? w->ruling.share * *force : 0;
  return true;
}

/* Returns the force that holds the speed to the ruling's limit, N along n; it never pulls into the object. */
static double hold_speed(const ethd__core_tick *t, const ethd_contact *c, double speed) {
  return c->v > speed ? -t->plan->brake * (c->v - speed) : 0;
}

/* Adds a contact's results to those of the other contacts. */
static void add(ethd__core_tick *t, const contact_work *w, double force) {
  const ethd_contact *c = &w->contact;
  const ethd_ruling *r = &w->ruling;
  ethd__touched *out = &t->touched;
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
    out->lead = ethd_vec3_scale(r->lead, c->n);
  }
  double braking = -r->damping * c->v;
  if (r->speed < (double)INFINITY) {
    out->bound[out->bounds++] =
        (struct ethd__bound){c->n, r->speed + ethd_vec3_dot(c->n, w->candidate->v), r->state == ETHD_VO};
    braking += hold_speed(t, c, r->speed);
  }
  out->fe = ethd_vec3_add(out->fe, ethd_vec3_scale(force + r->feed, c->n));
  out->fd = ethd_vec3_add(out->fd, ethd_vec3_scale(braking, c->n));
}

/* Stores the slot's surface, before a law can fail. */
static void claim(ethd__slot *slot, const ethd__candidate *k) {
  slot->object = k->object;
  slot->place = k->place;
  slot->point = k->local;
  slot->side = k->side;
  slot->past.n = k->n;
}

static void change_state(ethd__slot *slot, int32_t state) {
  if (slot->state != state) slot->changed = slot->periods;
  slot->state = state;
}

/* Stores a contact's data for adoption by a new plan. Only the old plan's run at a swap, on the scratch, does so. */
static void tell(ethd__slot *slot, const ethd_contact *c, const ethd_ruling *r) {
  slot->past.offset = r->offset;
  slot->past.d_re = c->d_re;
  slot->past.v = c->v;
}

/* The other forces that can act on a finger, N along n. Before a wall is rendered no finger presses on the ring, so the
   feed doesn't count as released energy: like tracking's torque it becomes the ring's motion and heat. */
static double bare_force(const ethd_ruling *r, double v) {
  double braking = -r->damping * v;
  return r->share > 0 ? r->feed + braking : braking;
}

/* Runs the laws on one contact. False: one of them failed. */
static bool work_out(ethd__core_tick *t, contact_work *w) {
  ethd__slot *slot = w->slot;
  ethd_contact *c = &w->contact;
  const ethd_ruling *r = &w->ruling;
  double force;
  c->age = (double)slot->periods * t->plan->period;
  claim(slot, w->candidate);
  if (!rule(t, w)) return false;
  if (!(c->d_re < t->near || r->argument <= c->d_beta || r->state != ETHD_TRANSPARENT)) {
    ethd__slot_free(t->state, slot);
    return true;
  }
  t->state->live |= ethd__slot_bit(t->state, slot);
  if (!wall(t, w, &force)) return false;
  slot->watched &= t->plan->watches_energy;
  if (t->plan->watches_energy) force += ethd__passivity(t, slot, c, force, bare_force(r, c->v));
  change_state(slot, r->state);
  if (t->keeps) tell(slot, c, r);
  slot->periods += (int64_t)rint(c->period / t->plan->period); /* whole periods, so that the age doesn't drift */
  add(t, w, force);
  return true;
}

/* ---- slots ---- */

static ethd__slot *free_slot(const ethd__core_tick *t) {
  const ethd__core_plan *plan = t->plan;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    ethd__slot *slot = &t->state->slots[i];
    if (t->state->live & 1u << i) continue;
    memset(slot, 0, sizeof *slot);
    ethd__block_reset(plan, &plan->transition->law, plan->transition_p, &slot->transition);
    ethd__block_reset(plan, &plan->contact->law, plan->contact_p, &slot->contact);
    return slot;
  }
  return NULL;
}

/* Ends the contacts that no candidate continues. */
static void end_lost(ethd__core *core, const ethd__candidates *c) {
  unsigned lost = c->live;
  for (int k = 0; k < c->count; k++)
    if (c->at[k].slot >= 0) lost &= ~(1u << c->at[k].slot);
  for (; lost; lost &= lost - 1) {
    ethd__slot *slot = &core->slots[__builtin_ctz(lost)];
    ethd__slot_free(core, slot);
    if (slot->state != ETHD_TRANSPARENT) core->counters.contacts_lost++;
  }
}

static void no_room(ethd__core_tick *t, int count) {
  t->touched.overflow += count;
  t->state->counters.contacts_lost += (uint64_t)count;
}

/* Frees the slot of the shallowest contact, which comes after candidate k in the list. */
static void make_room(ethd__core *core, ethd__candidates *c, int k) {
  /* unreachable: the loop's end, since not all slots belong to candidates up to k */
  for (int i = c->count - 1; i > k; i--) {
    if (c->at[i].slot < 0) continue;
    ethd__slot_free(core, &core->slots[c->at[i].slot]);
    c->at[i].slot = -1;
    return;
  }
}

static ethd__slot *new_slot(const ethd__core_tick *t, ethd__candidates *c, int k) {
  ethd__slot *slot = free_slot(t);
  if (slot) return slot;
  make_room(t->state, c, k);
  return free_slot(t);
}

/* ---- all of them ---- */

bool ethd__contacts_begin(ethd__core_tick *t) {
  const ethd__core_plan *plan = t->plan;
  ethd__touched *out = &t->touched;
  double range;
  memset(out, 0, offsetof(ethd__touched, bound));
  out->object = -1;
  out->beta = 1;
  out->d_re = out->d_fe = out->v_n = (double)NAN;
  t->near = plan->d_beta;
  if (!plan->range) return true;
  ethd_status status = ethd__fence_range(plan, t->state, ethd_vec3_norm(t->v), &range);
  if (range > plan->d_beta && range < (double)INFINITY) t->near = range;
  return ethd__law_is_good(t->state, ETHD_TRANSITION, status, true);
}

static bool could_count(const ethd_contact *c, double near, const ethd__slot *slot) {
  return c->d_re < near || c->d_fr <= c->d_beta || (slot && slot->state != ETHD_TRANSPARENT);
}

/* Processes the candidates from the deepest to the shallowest, so that the shallowest are dropped if room lacks. */
static bool work_out_all(ethd__core_tick *t, ethd__candidates *c) {
  for (int k = 0, taken = 0; k < c->count; k++) {
    contact_work w;
    w.candidate = &c->at[k];
    w.contact = measure(t, w.candidate);
    w.slot = c->at[k].slot < 0 ? NULL : &t->state->slots[c->at[k].slot];
    bool counts = could_count(&w.contact, t->near, w.slot);
    if (counts && taken < ETHD_CONTACTS_MAX) {
      if (!w.slot) w.slot = new_slot(t, c, k);
      if (!work_out(t, &w)) return false;
      taken += (t->state->live & ethd__slot_bit(t->state, w.slot)) != 0;
    } else {
      if (w.slot) ethd__slot_free(t->state, w.slot);
      if (counts) no_room(t, 1);
    }
  }
  return true;
}

bool ethd__contacts(ethd__core_tick *t, ethd__candidates *c) {
  ethd__candidates_sort(t->state, c);
  end_lost(t->state, c);
  no_room(t, c->overflow);
  return work_out_all(t, c);
}
