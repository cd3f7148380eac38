/* A swap: the new plan goes on with the state, and the old plan's torque is worked out once more, from which limit.c
   fades. */
#include "control/swap.h"

#include "control/estimate.h"
#include "control/evaluate.h"
#include "control/fence.h"
#include "control/limit.h"
#include "control/places.h"
#include "estimate/filter_methods.h"

/* ---- the state ---- */

static void swap_velocity(const ethd__plan *from, const ethd__plan *to, ethd__state *state) {
  if (from->velocity.method == to->velocity.method &&
      memcmp(from->velocity.p, to->velocity.p, sizeof from->velocity.p) == 0)
    return;
  for (int i = 0; i < 2; i++) {
    double speed = state->velocity[i].speed;
    memset(&state->velocity[i], 0, sizeof state->velocity[i]);
    state->velocity[i].speed = speed;
  }
}

static void swap_filter(const ethd__plan *from, const ethd__plan *to, ethd__state *state) {
  ethd_vec x, v;
  if (!state->filter.started ||
      (from->filter.method == to->filter.method && memcmp(from->filter.p, to->filter.p, sizeof from->filter.p) == 0))
    return;
  ethd__filter_output(&from->filter, &state->filter, &x, &v);
  ethd_filter_start(&to->filter, &state->filter, x, v);
}

static bool has_same_scene(const ethd__plan *a, const ethd__plan *b, int place) {
  return ethd__place_scene(&a->setup, place) == ethd__place_scene(&b->setup, place);
}

/* Makes a contact an orphan when its scene was replaced. Its object's number means nothing in the new scene, so its
   touch is kept, by which candidates.c finds the same surface there. */
static void orphan(ethd__state *state, int i, const ethd__state *old) {
  ethd__slot *slot = &state->slots[i];
  if (!(state->live & (old ? old->live : 0) & 1u << i)) {
    ethd__slot_free(state, slot);
    return;
  }
  slot->point = old->slots[i].point;
  slot->past.n = old->slots[i].past.n;
  state->orphans |= 1u << i;
}

/* Resets the new law's state, and hands it the contact as the old law leaves it after this tick if it can adopt one. */
static void adopt(const ethd__plan *to, const ethd__slot *was, ethd__slot *slot) {
  const ethd_transition_law *law = to->setup.transition;
  const double *p = to->setup.transition_p;
  ethd__block_reset(to, &law->law, p, &slot->transition);
  if (!was || !ETHD_LAW_HAS(law, adopt)) return;
  const double period = to->setup.period;
  const ethd_past past = {.offset = was->past.offset,
                          .d_re = was->past.d_re,
                          .v = was->past.v,
                          .age = (double)was->periods * period,
                          .since = (double)(was->periods - was->changed) * period,
                          .state = was->state};
  ethd__fence_adopt(to, &slot->transition, &past);
}

static void swap_slot(const ethd__plan *from, const ethd__plan *to, const ethd__slot *was, ethd__slot *slot) {
  if (from->setup.transition != to->setup.transition) adopt(to, was, slot);
  if (from->setup.contact != to->setup.contact)
    ethd__block_reset(to, &to->setup.contact->law, to->setup.contact_p, &slot->contact);
}

void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) {
  swap_velocity(from, to, state);
  swap_filter(from, to, state);
  for (int place = 0; place < ETHD__PLACES; place++)
    if (!has_same_scene(from, to, place)) ethd__place_forget(&state->places[place]);
  if (from->setup.tracking != to->setup.tracking)
    ethd__block_reset(to, &to->setup.tracking->law, to->setup.tracking_p, &state->tracking);
  if (from->setup.transition != to->setup.transition) memset(state->memory, 0, sizeof state->memory);
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    if (!has_same_scene(from, to, state->slots[i].place)) orphan(state, i, old);
    swap_slot(from, to, old && state->live & old->live & 1u << i ? &old->slots[i] : NULL, &state->slots[i]);
  }
}

/* ---- the tick of a swap ---- */

/* Works out what the old plan would command, on a copy of the state, so that this run leaves no mark in the state on
   which the new plan goes on. Returns false if a law failed, which is then noted in the state too. */
static bool evaluate_old(ethd__tick *t, double torque[2]) {
  memcpy(t->scratch, t->state, sizeof *t->scratch);
  ethd__tick old = *t;
  old.plan = t->from;
  old.state = t->scratch;
  if (!ethd__evaluate(&old)) {
    t->state->met = t->scratch->met; /* the row of the law that failed */
    return false;
  }
  ethd__limit(&old);
  memcpy(torque, t->trace->tau, sizeof t->trace->tau);
  return true;
}

void ethd__swap(ethd__tick *t, double old[2]) {
  bool held = evaluate_old(t, old);
  ethd__swap_state(t->from, t->plan, t->state, held ? t->scratch : NULL);
  if (!held)
    ethd__estimate(t);
  else if (ethd__evaluate(t))
    t->old = old;
}
