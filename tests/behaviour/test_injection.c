/* The fault table, row by row: each is injected where it would arise, at several moments of as many taps, and must be
   seen in time, lead to what the table says, and leave no torque over the limit for one tick. The report is a
   table; times are ticks of 1 ms on the virtual clock, from when the fault begins to show. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "behaviour/fault_rows.h"
#include "unit/draw.h"

#define TRIALS_MOST 30 /* until a fault that needs motion to show did so in that many */
#define AFTER 120      /* ticks that are looked at after a row was seen */
#define PATIENCE 900   /* ticks until it must have been seen, or the ring stand */
#define ROUNDING 1e-12

/* Moments of a tap at which each row is injected: five, with ETHD_WHOLE set 20. */
static int trials(void) { return getenv("ETHD_WHOLE") ? 20 : 5; }

/* ---- one trial ---- */

typedef struct outcome {
  int shown, good, worst; /* trials; ticks */
  char says[160];         /* what was wrong first */
} outcome;

static void wrong(outcome *o, int trial, const char *says, double value) {
  if (!o->says[0]) snprintf(o->says, sizeof o->says, "trial %d: %s %g", trial, says, value);
}

static int is_still(const fault_rig *r) { return r->torque[0] == 0 && r->torque[1] == 0; }

/* What follows once the row was seen. */
static const char *follow(fault_rig *r, const fault_row *t, int64_t begin) {
  int64_t seen = r->tick, let_go = seen + (t->device == FAULT_BUS ? 60 : 1), stood = -1;
  int ends = t->reaction == ETHD_REACTION_STOP ? PATIENCE : AFTER,
      goes_on = t->reaction == ETHD_REACTION_COUNTED || t->reaction == ETHD_REACTION_DEGRADE;
  for (int i = 0; i < ends; i++) {
    const ethd_trace *trace = &r->row.trace;
    if (goes_on && r->stepped && trace->fault) return "a row that only counts has stopped it: row";
    if (!goes_on && r->stepped && !trace->fault) return "nothing is latched, row";
    if (t->reaction == ETHD_REACTION_ZERO && r->stepped && (trace->tau[0] != 0 || trace->tau[1] != 0))
      return "a torque is asked for, row";
    if (t->reaction == ETHD_REACTION_ZERO && r->tick >= let_go && !is_still(r))
      return "the drive still has a torque, row";
    if (t->reaction == ETHD_REACTION_STOP && i > 0 && r->stepped &&
        trace->tau[0] * trace->qd[0] + trace->tau[1] * trace->qd[1] > ROUNDING)
      return "the stop drives the ring, row";
    if (t->reaction == ETHD_REACTION_STOP && stood < 0 && r->row.trace.fault && !ethd_loop_armed(r->loop)) stood = i;
    if (stood >= 0 && !is_still(r)) return "it has a torque again, row";
    if (stood >= 0 && i > stood + AFTER) break;
    t->inject(r, r->tick - begin);
    fault_rig_tick(r);
  }
  if (t->reaction == ETHD_REACTION_STOP && stood < 0) return "it never stands still, row";
  if (t->reaction == ETHD_REACTION_ZERO && ethd_loop_armed(r->loop)) return "the device is still armed, row";
  return NULL;
}

static void try(const fault_row *t, int trial, outcome *o) {
  static fault_rig r;
  uint64_t key = (uint64_t)(t - fault_rows) * 1000 + (uint64_t)trial;
  int64_t begin = t->first + (int64_t)(draw_bits(key) % (uint64_t)(t->last - t->first));
  fault_rig_response = t->row == ETHD_FAULT_FEEDBACK_OLD ? 0.003 : 0.1; /* each tick of silence takes that */
  fault_rig_open(&r, t->device, (uint64_t)trial, t->change);
  while (r.tick < begin) fault_rig_tick(&r);
  if (r.row.trace.fault) wrong(o, trial, "a fault before the fault: row", (double)r.row.trace.fault);
  fault_rig_mark(&r);
  const int64_t *seen = t->is_grave ? &r.grave[t->row] : &r.seen[t->row];
  while (*seen < 0 && r.tick < begin + PATIENCE) {
    t->inject(&r, r.tick - begin);
    fault_rig_tick(&r);
  }
  int needs_motion = t->needs_motion;
  if (*seen < 0) {
    if (!needs_motion || r.shows >= 0) wrong(o, trial, "not seen, begun at tick", (double)begin), o->shown++;
    fault_rig_close(&r);
    return;
  }
  o->shown++;
  if (needs_motion && r.shows < 0) t->inject(&r, r.tick - begin); /* in this very tick, perhaps */
  int64_t from = r.shows >= 0 && r.shows <= *seen ? r.shows : needs_motion ? *seen : begin;
  int after = (int)(*seen - from);
  if (after > o->worst) o->worst = after;
  if (after > t->bound) wrong(o, trial, "seen late, ticks:", after);
  const char *says = follow(&r, t, begin);
  if (says) wrong(o, trial, says, (double)r.row.trace.fault);
  int latches = t->reaction == ETHD_REACTION_STOP || t->reaction == ETHD_REACTION_ZERO;
  if (latches && r.row.trace.fault != t->row && !(t->row == 2 && r.row.trace.fault == 35))
    wrong(o, trial, "another row is latched:", (double)r.row.trace.fault);
  if (r.most > r.setup.limits.torque + (t->device == FAULT_BUS ? 0.001 : ROUNDING))
    wrong(o, trial, "torque over the limit, Nm:", r.most);
  if (t->row == ETHD_FAULT_INDEX && ethd_device_start(r.device) >= 0) wrong(o, trial, "the next run isn't refused", 0);
  o->good += !o->says[0];
  fault_rig_close(&r);
}

/* ---- the table ---- */

static int failures;

static const char *const reactions[] = {"", "count", "degrade", "stop", "zero", "refuse"};

static void print(int row, const char *how, const char *bound, const char *worst, const char *reaction,
                  const char *verdict) {
  printf("%3d  %-62s %-20s %8s  %-7s %s\n     | %s\n", row, ethd_fault_sentence((ethd_fault)row),
         bound ? bound : ethd_fault_bound((ethd_fault)row), worst, reaction, verdict, how);
}

/* A drive on a bus and a board on its line answer in true time. A busy machine can delay their answers; a trial counts
   as failed only if it fails three times. */
static void repeat(const fault_row *t, int trial, outcome *o) {
  outcome before = *o;
  int most = t->device == FAULT_BUS || t->device == FAULT_RING ? 3 : 1;
  for (int i = 0; i < most; i++) {
    *o = before;
    try(t, trial, o);
    if (strcmp(o->says, before.says) == 0) return;
  }
}

static void run(const fault_row *t) {
  outcome o = {.worst = -1};
  char worst[32], verdict[220];
  int trial = 0;
  while (trial < TRIALS_MOST && o.shown < trials()) repeat(t, trial++, &o);
  if (o.shown < trials()) wrong(&o, trial, "it has shown too seldom:", o.shown);
  snprintf(worst, sizeof worst, "%d ms", o.worst);
  if (!o.says[0] && trial == trials())
    snprintf(verdict, sizeof verdict, "good");
  else if (!o.says[0])
    snprintf(verdict, sizeof verdict, "good; nothing to show in %d more", trial - trials());
  else
    snprintf(verdict, sizeof verdict, "BAD: %s", o.says);
  failures += o.says[0] != 0;
  print(t->row, t->how, NULL, worst, reactions[t->reaction], verdict);
}

static void run_end(const fault_end *e) {
  char says[160] = "", verdict[220] = "good";
  for (int i = 0; i < trials() && !says[0]; i++) e->try(i, says, sizeof says);
  if (says[0]) snprintf(verdict, sizeof verdict, "BAD: %s", says);
  failures += says[0] != 0;
  print(e->row, e->how, NULL, "-", reactions[e->reaction], verdict);
}

static const struct {
  int row;
  const char *why;
} elsewhere[] = {
    {3, "it needs threads: tests/threads/test_loop_rows.c, in the same words"},
    {39, "it needs a cap: tests/behaviour/test_cap_tap.c"},
};

static bool is_tried(int row) {
  for (size_t i = 0; i < fault_row_count; i++)
    if (fault_rows[i].row == row) return true;
  for (size_t i = 0; i < fault_end_count; i++)
    if (fault_ends[i].row == row) return true;
  for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
    if (elsewhere[i].row == row) return true;
  return false;
}

static void find_untried(void) {
  for (int row = 1; row < ETHD_FAULT_COUNT; row++) {
    if (is_tried(row)) continue;
    printf(" %2d  %-62s NOT TRIED: give it a case in tests/behaviour/fault_rows.c\n", row,
           ethd_fault_sentence((ethd_fault)row));
    failures++;
  }
}

int main(int count, char **words) {
  setvbuf(stdout, NULL, _IOLBF, 0);
  for (size_t i = 0; i < fault_row_count; i++)
    if (count < 2 || fault_rows[i].row == atoi(words[1])) run(&fault_rows[i]); /* a number: that row alone */
  for (size_t i = 0; i < fault_end_count; i++)
    if (count < 2 || fault_ends[i].row == atoi(words[1])) run_end(&fault_ends[i]);
  for (size_t i = 0; count < 2 && i < sizeof elsewhere / sizeof *elsewhere; i++)
    print(elsewhere[i].row, elsewhere[i].why, NULL, "-", "zero", "elsewhere");
  find_untried();
  printf("%d bad\n", failures);
  return failures != 0;
}
