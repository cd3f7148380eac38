/* A way out of every row of the fault table that stops: what broke is mended, a hand brings the arm back, and then
   acknowledging and enabling must do, without opening the device anew. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "behaviour/fault_ring.h"
#include "behaviour/fault_rows.h"

#define BEGIN 60     /* tick of the tap */
#define PATIENCE 900 /* ticks until the row must have been seen */
#define AFTER 120    /* that it lasts */
#define MOST 12000   /* ticks until it must be enabled again */
#define AGAIN 300    /* ticks that it must then go on */
#define STIFF 20.0   /* Nm/rad, of the hand */
#define SMOOTH 0.5   /* Nms/rad */

/* What can be mended is; counts that were lost, and a clock that was set, stay as they are. */
static void mend(fault_rig *r) {
  memset(r->stuck, 0, sizeof r->stuck);
  memset(r->turned, 0, sizeof r->turned);
  memset(r->unplugged, 0, sizeof r->unplugged);
  r->more = r->law_adds = 0;
  r->act = MOCK_ANSWER;
  r->acts = r->deaf = r->gone = r->blind = 0;
  r->every = 1;
  r->status = r->old_point = 0;
  r->volts = 480;
  r->jump_ns = r->law_takes = r->lag = 0;
  r->law_says = ETHD_OK;
  board.silent = 0;
  board.jump_us = 0;
}

static void carry(fault_rig *r, const double home[2], double before[2]) {
  for (int j = 0; j < 2; j++) {
    double w = (r->now.q[j] - before[j]) / 1e-3;
    r->shove[j] = fmax(-2, fmin(2, STIFF * (home[j] - r->now.q[j]) - SMOOTH * w));
    before[j] = r->now.q[j];
  }
}

/* As people do: ack until it holds, say where the joints stand if their encoders lost it, then enable. Ticks, or -1. */
static int recover(fault_rig *r, const double home[2]) {
  double before[2] = {r->now.q[0], r->now.q[1]};
  for (int i = 0; i < MOST; i++) {
    carry(r, home, before);
    fault_rig_tick(r);
    if (i % 200) continue;
    if (r->row.trace.fault == ETHD_FAULT_ENCODER_JUMP && i == 2000 && ethd_device_home(r->device, r->now.q)) return -1;
    if (r->row.trace.fault || r->row.trace.guard) {
      ethd_device_clear(r->device);
      if (ethd_control_clean_time(r->control) >= r->setup.limits.clean_time) ethd_loop_acknowledge(r->loop);
    } else if (!ethd_loop_armed(r->loop)) {
      ethd_device_clear(r->device);
      for (int k = 0; k < 5; k++) fault_rig_tick(r);
      r->shove[0] = r->shove[1] = 0;
      if (ethd_loop_enable(r->loop) == ETHD_OK) return i;
    }
  }
  return -1;
}

static int try(const fault_row *t) {
  static fault_rig r;
  double home[2];
  fault_rig_response = 0.1;
  fault_rig_open(&r, t->device, 1, t->change);
  memcpy(home, r.now.q, sizeof home);
  while (r.tick < (t->first > BEGIN ? t->first : t->last < BEGIN ? t->first : BEGIN)) fault_rig_tick(&r);
  int64_t begin = r.tick;
  fault_rig_mark(&r);
  const int64_t *seen = t->is_grave ? &r.grave[t->row] : &r.seen[t->row];
  for (; r.tick < begin + PATIENCE && (*seen < 0 || r.tick < *seen + AFTER); fault_rig_tick(&r))
    t->inject(&r, r.tick - begin);
  bool shown = *seen >= 0;
  int64_t met = shown ? r.row.trace.fault : 0;
  if (t->row == ETHD_FAULT_INDEX) { /* it goes on, and the next run is refused */
    ethd_loop_disarm(r.loop);
    fault_rig_tick(&r);
    shown &= ethd_loop_enable(r.loop) != ETHD_OK;
  }
  mend(&r);
  int took = recover(&r, home);
  int64_t fault = ETHD_FAULT_NONE;
  /* a motor that a tick's full torque burns is burnt again by the next tap */
  for (int i = 0; i < (t->row == ETHD_FAULT_HEAT ? 0 : AGAIN) && took >= 0; i++) {
    fault_rig_tick(&r);
    fault = r.row.trace.fault;
  }
  bool good = took >= 0 && !fault && ethd_loop_armed(r.loop);
  printf("%3d  %-64s %s, latched %2d, enabled again after %5d ms, %s", t->row, t->how, shown ? "shown" : "not shown",
         (int)met, took, good ? "good\n" : "BAD: ");
  if (!good) printf("%s; %s\n", ethd_fault_sentence((ethd_fault)fault), ethd_device_why(r.device));
  fault_rig_close(&r);
  return good && (shown || t->needs_motion);
}

int main(int count, char **words) {
  int bad = 0;
  setvbuf(stdout, NULL, _IOLBF, 0);
  for (size_t i = 0; i < fault_row_count; i++) {
    const fault_row *t = &fault_rows[i];
    if (count > 1 && t->row != atoi(words[1])) continue;
    if (t->reaction < ETHD_REACTION_STOP && t->row != ETHD_FAULT_INDEX) continue;
    for (int k = 0, good = 0; k < 3 && !good; k++) { /* a busy machine's answers are late, too */
      good = try(t);
      if (!good && k == 2) bad++;
    }
  }
  printf("%d bad\n", bad);
  return bad != 0;
}
