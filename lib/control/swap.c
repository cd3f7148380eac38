/* A swap: the new plan continues with the state, and the old plan's torque is computed once more, since limit.c fades
   from it. */
#include "control/swap.h"

#include "control/estimate.h"
#include "control/evaluate.h"
#include "control/limit.h"
#include "control/places.h"
#include "core/swap.h"
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

void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) {
  unsigned replaced = 0;
  swap_velocity(from, to, state);
  swap_filter(from, to, state);
  for (int place = 0; place < ETHD__PLACES; place++) {
    if (has_same_scene(from, to, place)) continue;
    ethd__place_forget(&state->places[place]);
    replaced |= 1u << place;
  }
  ethd__core_swap(&from->core, &to->core, &state->core, old ? &old->core : NULL, replaced);
}

/* ---- the tick of a swap ---- */

/* Computes the old plan's command on a copy of the state, so that this run doesn't change the state with which the new
   plan continues. Returns false if a law failed, which is then noted in the state too. */
static bool evaluate_old(ethd__tick *t, double torque[2]) {
  memcpy(t->scratch, t->state, sizeof *t->scratch);
  ethd__tick old = *t;
  old.plan = t->from;
  old.state = t->scratch;
  if (!ethd__evaluate(&old)) {
    t->state->core.met = t->scratch->core.met; /* the row of the law that failed */
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
