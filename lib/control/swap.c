/* A swap without a bump: at its tick the torque is what the old plan gives, and the difference to the new plan's
   torque fades linearly to 0 over swap_time. */
#include "control/swap.h"

#include "control/estimate.h"
#include "control/evaluate.h"
#include "control/fence.h"
#include "control/places.h"

/* ---- the fade ---- */

/* Returns a torque without what the guard would cut. If that were part of a fade, the fade would be over as soon as the
   rest is at the limit, too early and too steeply. */
static double within_limit(const ethd__tick *t, double torque) ETHD_RT {
  double most = t->plan->setup.limits.torque;
  if (torque > most) return most;
  return torque < -most ? -most : torque;
}

void ethd__fade_start(ethd__tick *t, const double from[2]) {
  for (int i = 0; i < 2; i++) {
    t->state->fade.delta[i] = within_limit(t, from[i]) - within_limit(t, t->trace->tau_raw[i]);
    t->trace->tau_raw[i] = from[i];
  }
  t->state->fade.elapsed = 0;
}

/* Returns the share of the difference that is left after `t` s. */
static double fade_share(double t, double swap_time) ETHD_RT { return t < swap_time ? 1 - t / swap_time : 0; }

void ethd__fade(ethd__tick *t) {
  ethd__state *state = t->state;
  if (isinf(state->fade.elapsed)) return;
  state->fade.elapsed += t->dt;
  double share = fade_share(state->fade.elapsed, t->plan->setup.swap_time);
  if (share < 1e-9) { /* periods add up to swap_time only within rounding */
    state->fade.elapsed = (double)INFINITY;
    return;
  }
  for (int i = 0; i < 2; i++)
    t->trace->tau_raw[i] = within_limit(t, t->trace->tau_raw[i]) + share * state->fade.delta[i];
  state->guard.steep = 0; /* the fade's slope is no law's */
}

/* ---- the state ---- */

static void swap_velocity(const ethd__plan *from, const ethd__plan *to, ethd__state *state) ETHD_RT {
  if (from->velocity.method == to->velocity.method &&
      memcmp(from->velocity.p, to->velocity.p, sizeof from->velocity.p) == 0)
    return;
  for (int i = 0; i < 2; i++) {
    double speed = state->velocity[i].speed;
    memset(&state->velocity[i], 0, sizeof state->velocity[i]);
    state->velocity[i].speed = speed;
  }
}

static void swap_filter(const ethd__plan *from, const ethd__plan *to, ethd__state *state) ETHD_RT {
  ethd_vec x, v;
  if (!state->filter.started ||
      (from->filter.method == to->filter.method && memcmp(from->filter.p, to->filter.p, sizeof from->filter.p) == 0))
    return;
  ethd_filter_output(&from->filter, &state->filter, &x, &v);
  ethd_filter_start(&to->filter, &state->filter, x, v);
}

static bool has_same_scene(const ethd__plan *a, const ethd__plan *b, int place) ETHD_RT {
  return ethd__place_scene(&a->setup, place) == ethd__place_scene(&b->setup, place);
}

/* Makes a contact an orphan when its scene was replaced. Its object's number means nothing in the new scene, so its
   touch is kept, by which candidates.c finds the same surface there. */
static void orphan(ethd__state *state, int i, const ethd__state *old) ETHD_RT {
  ethd__slot *slot = &state->slots[i];
  slot->used = slot->used && old && old->slots[i].used;
  if (!slot->used) return;
  slot->point = old->slots[i].point;
  slot->past.n = old->slots[i].past.n;
  state->orphans |= 1u << i;
}

/* Resets the new law's state, and hands it the contact as the old law leaves it after this tick if it can adopt one. */
static void adopt(const ethd__plan *to, const ethd__slot *was, ethd__slot *slot) ETHD_RT {
  const ethd_transition_law *law = to->setup.transition;
  const double *p = to->setup.transition_p;
  ethd__block_reset(to, &law->law, p, &slot->transition);
  if (!slot->used || !was || !was->used || !ETHD_LAW_HAS(law, adopt)) return;
  const double period = to->setup.period;
  const ethd_past past = {.offset = was->past.offset,
                          .d_re = was->past.d_re,
                          .v = was->past.v,
                          .age = (double)was->periods * period,
                          .since = (double)(was->periods - was->changed) * period,
                          .state = was->state};
  ethd__fence_adopt(to, &slot->transition, &past);
}

static void swap_slot(const ethd__plan *from, const ethd__plan *to, const ethd__slot *was, ethd__slot *slot) ETHD_RT {
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
    swap_slot(from, to, old ? &old->slots[i] : NULL, &state->slots[i]);
  }
}

/* ---- the tick of a swap ---- */

/* Works out the old plan's torque on a copy of the state, so that this run leaves no mark in the state on which the new
   plan goes on. Returns false if a law failed, which is then noted in the state too. */
static bool evaluate_old(ethd__tick *t, double torque[2]) ETHD_RT {
  memcpy(t->scratch, t->state, sizeof *t->scratch);
  ethd__tick old = *t;
  old.plan = t->from;
  old.state = t->scratch;
  bool held = ethd__evaluate(&old);
  if (held) ethd__fade(&old);
  memcpy(torque, t->trace->tau_raw, sizeof t->trace->tau_raw);
  if (!held) t->state->met = t->scratch->met; /* the row of the law that failed */
  return held;
}

void ethd__swap(ethd__tick *t) {
  double old[2];
  bool held = evaluate_old(t, old);
  ethd__swap_state(t->from, t->plan, t->state, held ? t->scratch : NULL);
  if (!held)
    ethd__estimate(t);
  else if (ethd__evaluate(t))
    ethd__fade_start(t, old);
}
