#include "servo/link.h"

#include <math.h>
#include <string.h>

#include "servo/words.h"
#include "text/error_text.h"

#define BACK_OFF_MOST 32.0 /* times the map's back_off */
#define SILENT_LEAST 0.2   /* s without a good answer, after which the line counts as dead */
#define SILENT_ANSWERS 10.0
#define BUCKET_ADD 10
#define BUCKET_REFUSED 100

static int64_t nanoseconds(double seconds) { return (int64_t)(1e9 * seconds); }

void ethd__servo_link_make(const ethd__servo_map *map, ethd__servo_link *out) {
  memset(out, 0, sizeof *out);
  out->map = map;
  out->bus.fd = out->sequence = -1;
  out->back_off = map->back_off;
  ethd__servo_plan_make(map, &out->plan);
}

void ethd__servo_link_close(ethd__servo_link *l) {
  ethd__servo_bus_close(&l->bus);
  l->state = ETHD__SERVO_DOWN;
  l->sequence = -1;
  l->result = ETHD_E_DEVICE;
}

ethd_status ethd__servo_link_connect(ethd__servo_link *l, int64_t now_ns) {
  ethd_status status = ethd__servo_bus_open(l->map, &l->bus, l->message);
  if (status) {
    l->attempt_ns = now_ns + nanoseconds(l->back_off);
    l->back_off = fmin(2 * l->back_off, BACK_OFF_MOST * l->map->back_off);
    return status;
  }
  l->counts.connects++;
  l->state = ETHD__SERVO_UP;
  l->draining = l->plan.all = true;
  l->heard_ns = now_ns;
  ethd__servo_link_begin(l, ETHD__SERVO_IDENTIFY, now_ns);
  return ETHD_OK;
}

void ethd__servo_link_lose(ethd__servo_link *l, const char *why, int64_t now_ns) {
  ethd__say(l->message, ETHD_E_DEVICE, "%s: %s", l->map->port, why);
  ethd__servo_link_close(l);
  l->counts.lost++;
  l->rows[ETHD_FAULT_LINK_LOST]++;
  l->attempt_ns = now_ns + nanoseconds(l->back_off);
}

/* ---- bad answers ---- */

static void count(ethd__servo_link *l, ethd__servo_outcome got) {
  switch (got) {
  case ETHD__SERVO_MISSING: l->counts.missing++, l->rows[ETHD_FAULT_REPLY_MISSING]++; break;
  case ETHD__SERVO_BUSY: l->counts.busy++, l->rows[ETHD_FAULT_REPLY_BAD]++; break;
  case ETHD__SERVO_REFUSED: l->counts.refused++, l->rows[ETHD_FAULT_REPLY_BAD]++; break;
  case ETHD__SERVO_FAILED: l->counts.failed++, l->rows[ETHD_FAULT_DRIVE]++; break;
  default: l->counts.garbled++, l->rows[ETHD_FAULT_REPLY_BAD]++;
  }
}

/* Counts a bad answer. The line stays open, and nothing is sent until it is quiet. */
static ethd_status fail(ethd__servo_link *l, ethd__servo_outcome got, int64_t now_ns) {
  double silent = fmax(SILENT_LEAST, SILENT_ANSWERS * (l->map->response + l->map->drain));
  if (got == ETHD__SERVO_LOST) {
    ethd__servo_link_lose(l, ethd__servo_bus_error(&l->bus), now_ns);
    return ETHD_E_DEVICE;
  }
  count(l, got);
  ethd__say(l->message, ETHD_E_DEVICE, "%s: %s", l->map->port, ethd__servo_bus_error(&l->bus));
  if (got != ETHD__SERVO_MISSING) l->bucket += got == ETHD__SERVO_REFUSED ? BUCKET_REFUSED : BUCKET_ADD;
  if (l->bucket > 2 * BUCKET_REFUSED) l->bucket = 2 * BUCKET_REFUSED;
  l->draining = got != ETHD__SERVO_BUSY;
  if (now_ns - l->heard_ns > nanoseconds(silent)) ethd__servo_link_lose(l, ethd__servo_bus_error(&l->bus), now_ns);
  return ETHD_E_DEVICE;
}

/* ---- an exchange ---- */

static void set(ethd__servo_link *l, int role, double raw) {
  int32_t r = l->map->roles[role];
  if (r >= 0) ethd__servo_pack(&l->map->registers[r], raw, ethd__servo_plan_words(&l->plan, l->map, r));
}

/* Counts from 0 to the register's max; with two registers, to the smaller max. A borrowed register, such as a speed
   that isn't used, has a small max so that its counting does no harm. */
static uint16_t next_count(const ethd__servo_link *l) {
  double most = UINT16_MAX;
  for (int i = ETHD__SERVO_COUNTER; i <= ETHD__SERVO_COUNTER2; i++)
    if (l->map->roles[i] >= 0) most = fmin(most, l->map->registers[l->map->roles[i]].max);
  return l->counter >= most ? 0 : (uint16_t)(l->counter + 1);
}

static void fill(ethd__servo_link *l, const double torque[2]) {
  const int roles[2] = {ETHD__SERVO_TORQUE1, ETHD__SERVO_TORQUE2};
  for (int i = 0; i < 2; i++) {
    int32_t r = l->map->roles[roles[i]];
    double joint = l->state == ETHD__SERVO_ENABLED ? torque[i] : 0;
    if (r < 0) continue;
    l->raw[r] = ethd__servo_raw(&l->map->registers[r], joint);
    set(l, roles[i], l->raw[r]);
  }
  l->counter = next_count(l);
  for (int i = ETHD__SERVO_COUNTER; i <= ETHD__SERVO_COUNTER2; i++) set(l, i, l->counter);
}

/* True if the drive echoes the value just written. Any other echo belongs to another question. */
static bool echoes(ethd__servo_link *l) {
  for (uint32_t i = 0; i < l->map->count; i++) {
    const ethd__servo_register *r = &l->map->registers[i];
    if (r->echo < 0 || !r->cyclic) continue;
    uint32_t written = ethd__servo_bits(r, ethd__servo_plan_words(&l->plan, l->map, (int32_t)i));
    const ethd__servo_register *e = &l->map->registers[r->echo];
    if (ethd__servo_bits(e, ethd__servo_plan_words(&l->plan, l->map, r->echo)) != written) return false;
  }
  return true;
}

static void unpack(ethd__servo_link *l) {
  for (uint32_t i = 0; i < l->map->count; i++)
    if (l->plan.block[i] >= 0 && l->map->registers[i].direction == ETHD__SERVO_READ &&
        ethd__servo_plan_fresh(&l->plan, (int32_t)i))
      l->raw[i] = ethd__servo_unpack(&l->map->registers[i], ethd__servo_plan_words(&l->plan, l->map, (int32_t)i));
}

static ethd_status stale(ethd__servo_link *l) {
  l->counts.stale++;
  l->rows[ETHD_FAULT_REPLY_STALE]++;
  l->draining = true;
  ethd__say(l->message, ETHD_E_DEVICE, "%s: the drive doesn't show what was written to it", l->map->port);
  return ETHD_E_DEVICE;
}

static ethd_status exchange(ethd__servo_link *l, int64_t now_ns, const double torque[2]) {
  fill(l, torque);
  ethd__servo_outcome got = ethd__servo_plan_ask(&l->plan, &l->bus);
  if (got) return fail(l, got, now_ns);
  l->echo_failed = !echoes(l);
  if (l->echo_failed) return stale(l);
  unpack(l);
  l->heard_ns = now_ns;
  l->back_off = l->map->back_off;
  l->counts.exchanges++;
  if (l->bucket > 0) l->bucket--;
  return ETHD_OK;
}

/* Where an exchange fails because a unit is gone, the others are disabled all the same, once the line is quiet. */
static bool disables_the_rest(ethd__servo_link *l) {
  if (l->sequence != ETHD__SERVO_DISABLE || !ethd__servo_several(l->map)) return false;
  return !ethd__servo_bus_drain(&l->bus);
}

ethd_status ethd__servo_link_turn(ethd__servo_link *l, int64_t now_ns, const double torque[2]) {
  if (l->state == ETHD__SERVO_DOWN) {
    if (now_ns < l->attempt_ns) return ETHD_STATUS_STALE;
    ethd_status status = ethd__servo_link_connect(l, now_ns);
    if (status) return status;
  }
  if (l->draining) {
    ethd__servo_outcome got = ethd__servo_bus_drain(&l->bus);
    if (got) return fail(l, got, now_ns);
    l->draining = false;
  }
  ethd_status status = exchange(l, now_ns, torque);
  if (l->sequence < 0 || (status && !disables_the_rest(l))) return status;
  l->skipped |= status != ETHD_OK;
  ethd__servo_outcome got = ethd__servo_sequence_turn(l, now_ns);
  return got ? fail(l, got, now_ns) : status;
}
