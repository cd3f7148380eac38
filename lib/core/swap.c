#include "core/swap.h"

#include "core/fade.h"
#include "core/fence.h"

/* Makes a contact an orphan when its scene was replaced. Its object's number isn't valid in the new scene, so its point
   is kept, with which candidates.c finds the same surface there. */
static void orphan(ethd__core *core, int i, const ethd__core *old) {
  ethd__slot *slot = &core->slots[i];
  if (!(core->live & (old ? old->live : 0) & 1u << i)) {
    ethd__slot_free(core, slot);
    return;
  }
  slot->point = old->slots[i].point;
  slot->past.n = old->slots[i].past.n;
  core->orphans |= 1u << i;
}

/* Resets the new law's state. If the law can adopt a contact, it gets the contact as the old law leaves it. */
static void adopt(const ethd__core_plan *to, const ethd__slot *was, ethd__slot *slot) {
  const ethd_transition_law *law = to->transition;
  ethd__block_reset(to, &law->law, to->transition_p, &slot->transition);
  if (!was || !ETHD_LAW_HAS(law, adopt)) return;
  const double period = to->period;
  const ethd_past past = {.offset = was->past.offset,
                          .d_re = was->past.d_re,
                          .v = was->past.v,
                          .age = (double)was->periods * period,
                          .since = (double)(was->periods - was->changed) * period,
                          .state = was->state};
  ethd__fence_adopt(to, &slot->transition, &past);
}

void ethd__core_swap(const ethd__core_plan *from, const ethd__core_plan *to, ethd__core *core, const ethd__core *old,
                     unsigned replaced) {
  if (from->tracking != to->tracking) ethd__block_reset(to, &to->tracking->law, to->tracking_p, &core->tracking);
  if (from->transition != to->transition) memset(core->memory, 0, sizeof core->memory);
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    ethd__slot *slot = &core->slots[i];
    if (replaced & 1u << slot->place) orphan(core, i, old);
    const ethd__slot *was = old && core->live & old->live & 1u << i ? &old->slots[i] : NULL;
    if (from->transition != to->transition) adopt(to, was, slot);
    if (from->contact != to->contact) ethd__block_reset(to, &to->contact->law, to->contact_p, &slot->contact);
  }
}

void ethd__core_resume(const ethd__core_plan *plan, ethd__core *core) {
  __atomic_store_n(&core->fault, ETHD_FAULT_NONE, __ATOMIC_RELAXED);
  core->before = (ethd__fault_rows){0, 0}; /* so a row that lasts counts as a new occurrence */
  ethd__fade_end(&core->fade);
  core->live = 0;
  ethd__block_reset(plan, &plan->tracking->law, plan->tracking_p, &core->tracking);
}
