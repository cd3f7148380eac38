#include "core/fence.h"

#include <stddef.h>

#include "fp_mode.h"

/* ---- the processor's floating-point mode, which a law must leave as it was ---- */

typedef struct fp_control {
  uint64_t word;
  uint16_t x87;
} fp_control;

static fp_control control_now(void) { return (fp_control){ethd__fp_now() & ETHD__FP_BITS, ethd__x87_now()}; }

static void control_set(fp_control c) {
  ethd__x87_set(c.x87);
  ethd__fp_set(c.word);
}

static bool control_is(fp_control a, fp_control b) { return a.word == b.word && a.x87 == b.x87; }

/* ---- fences: a pattern before the law's state and from its end on ---- */

#define PATTERN 0xfe9ce5fe9ce5fe9cu /* a NaN other than the default one: no law writes it by accident */

static void put_words(void *to, size_t bytes) {
  const uint64_t word = PATTERN;
  for (size_t i = 0; i < bytes; i += sizeof word)
    memcpy((char *)to + i, &word, bytes - i < sizeof word ? bytes - i : sizeof word);
}

static bool holds(const void *from, size_t bytes) {
  const uint64_t pattern = PATTERN;
  uint64_t word, changed = 0;
  size_t i = 0;
  for (; i + sizeof word <= bytes; i += sizeof word) {
    memcpy(&word, (const char *)from + i, sizeof word);
    changed |= word ^ pattern;
  }
  return !changed && memcmp((const char *)from + i, &pattern, bytes - i) == 0;
}

/* Returns the bytes from the end of the law's state to the end of the fence behind its block. */
static size_t rest_of(const ethd_law *law) {
  return sizeof(ethd__law_block) - offsetof(ethd__law_block, at) - law->state_size;
}

static void put_fences(const ethd_law *law, ethd__law_block *b) {
  put_words(b->before, sizeof b->before);
  put_words((char *)b->at + law->state_size, rest_of(law));
}

static bool fences_hold(const ethd_law *law, const ethd__law_block *b) {
  return b->law == law && holds(b->before, sizeof b->before) &&
         holds((const char *)b->at + law->state_size, rest_of(law));
}

/* ---- a call of foreign code ---- */

typedef struct call {
  const ethd_law *law;
  ethd__law_block *block;
  fp_control before;
} call;

static call enter(const ethd_law *law, ethd__law_block *b) {
  __atomic_store_n(&b->law, law, __ATOMIC_RELAXED);
  __atomic_store_n(&b->running, 1, __ATOMIC_RELEASE);
  return (call){law, b, control_now()};
}

/* Detects and undoes a law's forbidden changes. */
static ethd_status leave(const call *c, ethd_status status) {
  ethd__law_block *b = c->block;
  if (!control_is(control_now(), c->before)) {
    control_set(c->before);
    status = ETHD_E_FENV;
  }
  if (!fences_hold(c->law, b)) {
    put_fences(c->law, b);
    b->law = c->law;
    b->failed = 0;
    status = ETHD_E_FENCE;
  }
  __atomic_store_n(&b->running, 0, __ATOMIC_RELEASE);
  return status;
}

/* A reset that failed fails the step after it. */
static ethd_status leave_step(const call *c, ethd_status status) {
  ethd_status found = leave(c, status), reset = (ethd_status)c->block->failed;
  c->block->failed = 0;
  return reset ? reset : found;
}

static ethd__law_block *block_of(void *state) {
  return (ethd__law_block *)(void *)((char *)state - offsetof(ethd__law_block, at));
}

void ethd__fence_reset(const ethd_law *law, const double *p, ethd__law_block *b) {
  put_fences(law, b);
  b->failed = 0;
  call c = enter(law, b);
  if (law->reset) law->reset(p, b->at);
  b->failed = leave(&c, ETHD_OK);
}

/* A violation in `adopt` fails the step after it, as with a reset. */
void ethd__fence_adopt(const ethd__core_plan *plan, ethd__law_block *b, const ethd_past *past) {
  const ethd_transition_law *law = plan->transition;
  if (!(plan->foreign & 1 << ETHD_TRANSITION)) {
    law->adopt(plan->transition_p, b->at, past);
    return;
  }
  const int64_t before = b->failed;
  call c = enter(&law->law, b);
  law->adopt(plan->transition_p, b->at, past);
  const ethd_status found = leave(&c, ETHD_OK);
  b->failed = found ? found : before;
}

/* `range` has no state, so only the processor is checked. Any block can show that it runs. */
ethd_status ethd__fence_range(const ethd__core_plan *plan, ethd__core *s, double speed, double *range) {
  ethd__law_block *b = &s->slots[0].transition;
  if (!(plan->foreign & 1 << ETHD_TRANSITION)) {
    *range = plan->range(plan->transition_p, speed);
    return ETHD_OK;
  }
  const call c = enter(&plan->transition->law, b);
  *range = plan->range(plan->transition_p, speed);
  const bool kept = control_is(control_now(), c.before);
  if (!kept) control_set(c.before);
  __atomic_store_n(&b->running, 0, __ATOMIC_RELEASE);
  return kept ? ETHD_OK : ETHD_E_FENV;
}

const ethd_law *ethd__fence_runs(const ethd__core *s) {
  for (int i = -1; i < 2 * ETHD_CONTACTS_MAX; i++) {
    const ethd__law_block *b = &s->tracking;
    if (i >= 0) b = i % 2 ? &s->slots[i / 2].contact : &s->slots[i / 2].transition;
    if (__atomic_load_n(&b->running, __ATOMIC_ACQUIRE) == 1) return __atomic_load_n(&b->law, __ATOMIC_RELAXED);
  }
  return NULL;
}

/* ---- the fenced steps ---- */

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  const ethd_law *law = block_of(state)->law;
  call c = enter(law, block_of(state));
  return leave_step(&c, ((const ethd_tracking_law *)(const void *)law)->step(p, state, in, tau));
}

static ethd_status follow_by_force(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT {
  const ethd_law *law = block_of(state)->law;
  call c = enter(law, block_of(state));
  return leave_step(&c, ((const ethd_tracking_law *)(const void *)law)->force(p, state, in, out));
}

static ethd_status follow_by_velocity(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT {
  const ethd_law *law = block_of(state)->law;
  call c = enter(law, block_of(state));
  return leave_step(&c, ((const ethd_tracking_law *)(const void *)law)->velocity(p, state, in, out));
}

static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  const ethd_law *law = block_of(state)->law;
  call c = enter(law, block_of(state));
  return leave_step(&c, ((const ethd_contact_law *)(const void *)law)->step(p, state, gap, speed, entering, force));
}

static ethd_status rule(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  const ethd_law *law = block_of(state)->law;
  call c = enter(law, block_of(state));
  return leave_step(&c, ((const ethd_transition_law *)(const void *)law)->step(p, state, contact, out));
}

bool ethd__law_is_foreign(const ethd_law *law) {
  for (const ethd_law *const *l = ethd_laws; *l; l++)
    if (*l == law) return false;
  return true;
}

void ethd__fence_prepare(ethd__core_plan *plan) {
  bool foreign[] = {ethd__law_is_foreign(&plan->tracking->law), ethd__law_is_foreign(&plan->contact->law),
                    ethd__law_is_foreign(&plan->transition->law)};
  plan->foreign = foreign[ETHD_TRACKING] << ETHD_TRACKING | foreign[ETHD_CONTACT] << ETHD_CONTACT |
                  foreign[ETHD_TRANSITION] << ETHD_TRANSITION;
  const ethd_tracking_law *law = plan->tracking;
  plan->track = law->step ? foreign[ETHD_TRACKING] ? track : law->step : NULL;
  plan->follow = NULL;
  if (plan->by_velocity && ETHD_TRACKING_HAS(law, velocity))
    plan->follow = foreign[ETHD_TRACKING] ? follow_by_velocity : law->velocity;
  else if (!plan->by_velocity && ETHD_TRACKING_HAS(law, force))
    plan->follow = foreign[ETHD_TRACKING] ? follow_by_force : law->force;
  plan->push = foreign[ETHD_CONTACT] ? push : plan->contact->step;
  plan->rule = foreign[ETHD_TRANSITION] ? rule : plan->transition->step;
  plan->range = ETHD_LAW_HAS(plan->transition, range) ? plan->transition->range : NULL;
}
