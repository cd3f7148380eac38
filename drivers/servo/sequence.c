/* Runs the steps of [identify], [enable], [disable] and [clear], one in each cycle. */
#include "servo/link.h"
#include "servo/words.h"
#include "text/error_text.h"

static void finish(ethd__servo_link *l, ethd_status result) {
  int32_t which = l->sequence;
  l->sequence = -1;
  l->result = result;
  if (result || l->state == ETHD__SERVO_DOWN) return;
  if (which == ETHD__SERVO_IDENTIFY) l->state = ETHD__SERVO_IDENTIFIED;
  if (which == ETHD__SERVO_ENABLE) l->state = ETHD__SERVO_ENABLED;
}

static ethd__servo_outcome write_step(ethd__servo_link *l, const ethd__servo_step *s) {
  uint16_t words[2];
  const ethd__servo_register *r = &l->map->registers[s->at];
  ethd__servo_pack(r, s->value, words);
  return ethd__servo_bus_write(&l->bus, ethd__servo_span_of(r), words);
}

/* Uses the bits that were read in this cycle; registers that weren't read in it are read now. */
static ethd__servo_outcome read_bits(ethd__servo_link *l, const ethd__servo_step *s, uint32_t *bits) {
  const ethd__servo_register *r = &l->map->registers[s->at];
  uint16_t words[2];
  ethd__servo_outcome got = ETHD__SERVO_DONE;
  if (r->cyclic && ethd__servo_plan_fresh(&l->plan, s->at)) {
    *bits = ethd__servo_bits(r, ethd__servo_plan_words(&l->plan, l->map, s->at));
  } else {
    got = ethd__servo_bus_read(&l->bus, ethd__servo_span_of(r), words);
    if (got) return got;
    *bits = ethd__servo_bits(r, words);
    l->raw[s->at] = ethd__servo_unpack(r, words);
  }
  return got;
}

static ethd__servo_outcome wait_step(ethd__servo_link *l, const ethd__servo_step *s, int64_t now_ns, bool *done) {
  uint32_t bits = 0;
  ethd__servo_outcome got = read_bits(l, s, &bits);
  *done = !got && (bits & s->mask) == s->bits;
  if (got || *done || 1e-9 * (double)(now_ns - l->step_ns) < s->value) return got;
  const ethd__servo_register *r = &l->map->registers[s->at];
  finish(l, ethd__say(l->message, ETHD_E_DEVICE, "%s.step%u: %s is 0x%X after %g s, 0x%X of 0x%X was awaited",
                      ethd__servo_sequences[l->sequence], l->step + 1, r->name, bits, s->value, s->bits, s->mask));
  return got;
}

ethd__servo_outcome ethd__servo_sequence_turn(ethd__servo_link *l, int64_t now_ns) {
  const ethd__servo_steps *steps = &l->map->sequences[l->sequence];
  ethd__servo_outcome got = ETHD__SERVO_DONE;
  bool done = true;
  if (l->step < steps->count) {
    const ethd__servo_step *s = &steps->at[l->step];
    if (s->kind == ETHD__SERVO_STEP_WRITE) got = write_step(l, s);
    if (s->kind == ETHD__SERVO_STEP_WAIT) got = wait_step(l, s, now_ns, &done);
    if (s->kind == ETHD__SERVO_STEP_PAUSE) done = 1e-9 * (double)(now_ns - l->step_ns) >= s->value;
  }
  /* [disable] goes on without a unit that is gone: the others don't wait for it */
  bool skip = got == ETHD__SERVO_MISSING && l->sequence == ETHD__SERVO_DISABLE && ethd__servo_several(l->map);
  l->skipped |= skip;
  if ((!skip && (got || !done)) || l->sequence < 0) return got;
  l->step++;
  l->step_ns = now_ns;
  if (l->step >= steps->count) finish(l, l->skipped ? ETHD_E_DEVICE : ETHD_OK);
  return got;
}

void ethd__servo_link_begin(ethd__servo_link *l, int32_t sequence, int64_t now_ns) {
  l->sequence = sequence;
  l->step = 0;
  l->skipped = false;
  l->step_ns = now_ns;
  l->result = ETHD_STATUS_BUSY;
  if (sequence == ETHD__SERVO_DISABLE && l->state == ETHD__SERVO_ENABLED) l->state = ETHD__SERVO_IDENTIFIED;
}
