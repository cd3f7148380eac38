#include "behaviour/fault_drive.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit/mock_counter.h"

#define TURN 6.283185307179586
#define WATCHDOG 50 /* ticks, of apps/config/plant.map */

/* ---- counts ---- */

static int64_t count_of(double q) { return (int64_t)rint(q * FAULT_COUNTS / TURN); }

static int64_t below(int64_t a, int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/* A mark between two counts: the last one that was passed. */
static void pass_marks(fault_rig *r, int j, int64_t before, int64_t now) {
  int64_t a = below(before, FAULT_MARKS), b = below(now, FAULT_MARKS);
  if (a == b) return;
  if (j == 0) r->marks++;
  mock_counter_event(COUNTER_EVENT_INDEX, j, (uint64_t)((b > a ? b : a) * FAULT_MARKS + r->slip[j]) & 0xFFFFFFFF, 0);
}

static int64_t spoilt(const fault_rig *r, int j, int64_t count) {
  if (r->stuck[j]) return r->from[j];
  if (r->turned[j]) return 2 * r->from[j] - count;
  return count + r->slip[j];
}

void fault_drive_counts(fault_rig *r) {
  static int64_t before[2];
  for (int j = 0; j < 2; j++) {
    int64_t count = count_of(r->now.q[j]);
    if (!r->stuck[j] && !r->turned[j]) r->from[j] = count;
    counter_mock.count[j] = (uint64_t)spoilt(r, j, count) & 0xFFFFFFFF;
    if (r->tick > 0) pass_marks(r, j, before[j], count);
    before[j] = count;
  }
}

/* ---- registers ---- */

static void put_words(_Atomic uint16_t *at, uint32_t bits) {
  at[0] = (uint16_t)(bits >> 16);
  at[1] = (uint16_t)bits;
}

static uint32_t float_bits(double v) {
  float f = (float)v;
  uint32_t bits;
  memcpy(&bits, &f, sizeof bits);
  return bits;
}

void fault_drive_registers(fault_rig *r) {
  _Atomic uint16_t *w = r->server.words;
  for (int j = 0; j < 2; j++) {
    put_words(w + MOCK_POSITION1 + 2 * j, (uint32_t)count_of(r->now.q[j]));
    w[MOCK_MEASURED1 + j] =
        (uint16_t)(int16_t)rint(r->torque[j] / (FAULT_RATIO * FAULT_TORQUE_UNIT) + r->more / FAULT_TORQUE_UNIT);
  }
  r->server.frozen = r->more != 0;
  w[MOCK_STATUS] |= r->status;
  w[MOCK_VOLTAGE] = r->volts;
  if (!(r->now.have & ETHD_HAVE_CENTRE)) return;
  put_words(w + 12, float_bits(r->now.centre[0]));
  put_words(w + 14, float_bits(r->now.centre[1]));
  w[16] = (uint16_t)++r->readings;
  w[17] = (uint16_t)((r->now.time_ns - r->now.sample_ns) / 1000);
}

mock_act fault_drive_act(void *rig, uint64_t n, int function) {
  fault_rig *r = rig;
  (void)n;
  if (r->old_point && function == 3) r->server.words[MOCK_TORQUE1] = r->old_point;
  if (r->deaf) return (mock_act){MOCK_DROP, 0, 0};
  if (function != 3 || r->acts == 0) return (mock_act){MOCK_ANSWER, 0, 0};
  if (r->every > 1 && r->acts-- % r->every) return (mock_act){MOCK_ANSWER, 0, 0};
  if (r->every <= 1) r->acts--;
  return (mock_act){r->act, r->code, 0};
}

void fault_drive_watch(fault_rig *r) {
  uint64_t asked = atomic_load(&r->server.requests);
  r->silent = asked == r->asked || r->deaf ? r->silent + 1 : 0;
  r->asked = asked;
  if (r->silent > WATCHDOG) r->server.words[MOCK_STATUS] &= (uint16_t)~2u;
}

double fault_rig_response = 0.1;

void fault_drive_map(const char *path) {
  char line[256];
  FILE *plain = fopen("apps/config/plant.map", "r"), *to = fopen(path, "w");
  if (!plain || !to) fault_rig_fail("%s", path);
  while (fgets(line, sizeof line, plain)) {
    if (strncmp(line, "response", 8))
      fputs(line, to);
    else
      fprintf(to, "response = %g\n", fault_rig_response);
    /* A drive that gives too much looks like a runaway, too, and sometimes sooner: row 13 has a rig of its own. */
    if (!strncmp(line, "[register position", 18)) fputs("reverse_torque = 1e6\n", to);
  }
  fclose(plain);
  fclose(to);
}
