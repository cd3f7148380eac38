/* Passivity observer and controller of a contact (Hannaford and Ryu 2002), by positions: the force is held
   from tick to tick, so its work is exact.

        E += -F travel          F along n < 0 pushes out, travel into the object > 0
        E > 0                   absorbed so far: forgotten where the wall doesn't push, for nothing is stored
        E < 0                   given away, more than it took; forgotten within a second or so
        E < -energy             damping is added, as much as brings E back by one period's motion, at most
                                DAMPING_MAX; the wall still never pulls
        E < -2 energy           again and again for EXCESS_MAX: damping doesn't help. Between, a wall stores some of
                                what it will give next; without it for RESPITE, damping has helped

   A contact that begins anew soon after the last one, a bounce, goes on with what that gave away.        */
#include "control/passivity.h"

#include "control/rows.h"

#define MEMORY 0.5       /* s */
#define DAMPING_MAX 20.0 /* Ns/m, as the guard's stop */
#define EXCESS_MAX 0.050 /* s */
#define RESPITE 0.025    /* s */

/* A device gives the force in the period after it was worked out, or in the one after that: both are watched,
   and the worse counts. */
static void observe(ethd__slot *slot, const ethd_contact *c) ETHD_RT {
  double travel = slot->periods > 0 ? slot->depth_was - c->d_re : 0;
  for (int late = 0; late < 2; late++) {
    double *e = &slot->energy[late];
    *e -= slot->force[late] * travel;
    if (*e > 0 && slot->force[late] == 0) *e = 0;
    if (*e < 0) *e -= *e * fmin(c->period / MEMORY, 1);
  }
  slot->depth_was = c->d_re;
}

static void begin(ethd__slot *slot, const ethd__state *state, double period) ETHD_RT {
  double passed = (double)(state->counters.ticks - state->given_at) * period;
  for (int late = 0; late < 2; late++) slot->energy[late] = -state->given * fmax(1 - passed / MEMORY, 0);
}

/* Noticed over the bound, done with under half of it. */
static double damping(ethd__slot *slot, double given, double bound, double v, double period) ETHD_RT {
  if (given > bound) slot->giving = true;
  if (given <= bound / 2) slot->giving = false;
  if (!slot->giving || v == 0) return 0;
  return fmin((given - bound / 2) / (v * v * period), DAMPING_MAX);
}

static bool persists(ethd__state *state, double period) ETHD_RT {
  uint64_t now = state->counters.ticks + 1;
  if (state->excess_at == 0 || (double)(now - state->excess_at) * period > RESPITE) state->excess_from = now;
  state->excess_at = now;
  return (double)(now - state->excess_from) * period > EXCESS_MAX - period / 2;
}

double ethd__passivity(const ethd__tick *t, ethd__slot *slot, const ethd_contact *c, double wall, double brake) {
  ethd__state *state = t->state;
  const double bound = t->plan->setup.limits.energy, period = t->plan->setup.period;
  if (slot->periods == 0) begin(slot, state, period);
  observe(slot, c);
  double given = -fmin(slot->energy[0], slot->energy[1]);
  double added = -damping(slot, given, bound, c->v, c->period) * c->v;
  if (wall + added > 0) added = -wall;
  slot->force[1] = slot->force[0];
  slot->force[0] = wall + added + brake;
  state->given = fmax(given, 0);
  state->given_at = state->counters.ticks;
  if (slot->giving) ethd__note(state, ETHD_FAULT_ENERGY);
  if (given > 2 * bound && persists(state, period)) ethd__note_grave(state, ETHD_FAULT_ENERGY);
  return added;
}
