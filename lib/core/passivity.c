/* Passivity observer and controller of a contact (Hannaford and Ryu 2002), by positions: the force is held
   from tick to tick, so its work is exact.

        E += -F travel          F along n < 0 pushes out, travel into the object > 0
        E > 0                   the wall has absorbed energy; reset while it doesn't push, since nothing is stored
        E < 0                   it released more than it absorbed; decays within about a second
        E < -energy             damping is added, enough to correct E within one period's motion, at most
                                plan.damping_max; the wall still never pulls
        E < -2 energy           if this recurs for EXCESS_MAX, damping doesn't help. A gap shorter than RESPITE doesn't
                                interrupt the count, because the wall then stores a part of the energy that it releases
                                next; a longer one shows that damping has helped

   A law's feed counts only while the law renders a wall. Before that no finger presses on the ring: compensated
   friction, or a brake ahead of the wall, acts on the ring alone. The finger feels it only as the ring's kinetic energy
   at the touch, m v^2/2, as with the speed from tracking (0.15 mJ at 0.05 m/s and 0.12 kg).

   A contact that begins soon after the last one ended, as in a bounce, continues with the energy which that one
   released. A contact that is first observed inside the wall, after a swap or an acknowledged fault, has already stored
   energy; E begins with this energy. */
#include "core/passivity.h"

#include "core/rows.h"

#define MEMORY 0.5       /* s */
#define EXCESS_MAX 0.050 /* s */
#define RESPITE 0.025    /* s */

/* A device applies the force in the period after its computation, or one period later: both are observed, and the worse
   counts. */
static void observe(ethd__slot *slot, const ethd_contact *c) {
  double travel = slot->watched ? slot->depth_was - c->d_re : 0;
  for (int late = 0; late < 2; late++) {
    double *e = &slot->energy[late];
    *e -= slot->force[late] * travel;
    if (*e > 0 && slot->force[late] == 0) *e = 0;
    if (*e < 0) *e -= *e * fmin(c->period / MEMORY, 1);
  }
  slot->depth_was = c->d_re;
}

/* The energy stored in a spring with this wall's force; a stiffening spring has stored less. A wall of a new scene that
   appears at the ring has stored nothing. */
static double stored(const ethd__core_tick *t, const ethd__slot *slot, double depth, double wall) {
  return slot->periods > 0 || t->soft ? fmax(-wall * depth / 2, 0) : 0;
}

static void begin(const ethd__core_tick *t, ethd__slot *slot, double depth, double wall) {
  const ethd__core *core = t->state;
  double has = stored(t, slot, depth, wall);
  double passed = (double)(core->counters.ticks - core->given_at) * t->plan->period;
  for (int late = 0; late < 2; late++) {
    slot->energy[late] = has - core->given * fmax(1 - passed / MEMORY, 0);
    slot->force[late] = has > 0 ? wall : 0; /* it has pushed all along */
  }
}

/* Returns the damping to add, Ns/m: it begins when more than the bound was released and ends below half of it. */
static double damping(const ethd__core_plan *plan, ethd__slot *slot, double given, double v, double period) {
  const double bound = plan->energy;
  if (given > bound) slot->giving = true;
  if (given <= bound / 2) slot->giving = false;
  if (!slot->giving || v == 0) return 0;
  return fmin((given - bound / 2) / (v * v * period), plan->damping_max);
}

static bool persists(ethd__core *core, double period) {
  uint64_t now = core->counters.ticks + 1;
  if (core->excess_at == 0 || (double)(now - core->excess_at) * period > RESPITE) core->excess_from = now;
  core->excess_at = now;
  return (double)(now - core->excess_from) * period > EXCESS_MAX - period / 2;
}

double ethd__passivity(const ethd__core_tick *t, ethd__slot *slot, const ethd_contact *c, double wall, double brake) {
  ethd__core *core = t->state;
  const double bound = t->plan->energy, period = t->plan->period;
  if (!slot->watched) begin(t, slot, -c->d_re, wall);
  observe(slot, c);
  slot->watched = true;
  double given = -fmin(slot->energy[0], slot->energy[1]);
  double added = -damping(t->plan, slot, given, c->v, c->period) * c->v;
  if (wall + added > 0) added = -wall;
  slot->force[1] = slot->force[0];
  slot->force[0] = wall + added + brake;
  core->given = fmax(given, 0);
  core->given_at = core->counters.ticks;
  if (slot->giving) ethd__note(core, ETHD_FAULT_ENERGY);
  if (given > 2 * bound && persists(core, period)) ethd__note_grave(core, ETHD_FAULT_ENERGY);
  return added;
}
