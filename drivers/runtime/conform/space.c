/* The questions for a device in space. */
#include <math.h>
#include <string.h>

#include "clock.h"
#include "conform/conform_rig.h"

#define LOOK 0.5   /* s of reading only */
#define PUSH 0.1   /* s for which a command is held */
#define PAUSE 0.02 /* s in which a device may reach its safe state */
#define STILL 1e-3 /* m in PUSH without a command */
#define OFF 0.2    /* share by which a motion may differ from the commanded motion */
#define LEFT 0.05  /* share of a motion that may remain after `safe`; without brakes, */
#define ROLLS 0.25 /* this */
#define OFTEN 0.1  /* share of calls that may exceed half a period, because this machine is late */
#define RAMP 1.0   /* m/s^2, N/ms: growth of a command if the setup has no limit */

typedef struct space_run {
  ethd__conform_rig r;
  ethd_space_sense sense; /* the last sample */
  ethd_vec3 written;      /* the last command */
  ethd_vec3 way;          /* sum of all commands, as the device reports them, times the period */
  int stale, calls, slow;
  int64_t longest; /* ns of a call */
} space_run;

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

static void time_call(space_run *s, int64_t begin) {
  const int64_t took = ethd__clock_now() - begin;
  s->calls++;
  s->slow += took > s->r.period / 2;
  if (took > s->longest) s->longest = took;
}

static void note_sample(space_run *s, const ethd_space_sense *now) {
  ethd__conform_rig *r = &s->r;
  const int64_t latest = r->def->device->is_virtual ? r->now : ethd__clock_now();
  r->finite &= is_finite(now->x) && is_finite(now->v);
  r->backwards += r->samples && now->time_ns < s->sense.time_ns;
  r->ahead += now->time_ns > latest;
  const ethd_vec3 took = now->have & ETHD_SPACE_HAVE_COMMANDED ? ethd_vec3_of(now->commanded) : s->written;
  s->way = ethd_vec3_add(s->way, ethd_vec3_scale(1e-9 * (double)r->period, took));
  r->samples++;
  s->sense = *now;
}

/* One period: I/O, read, and write, unless `command` is NULL. */
static void tick_space(space_run *s, const ethd_vec3 *command) {
  ethd__conform_rig *r = &s->r;
  ethd_space_sense now = {0};
  ethd_space_command c = {.normal = {0, 0, 1}, .kind = r->def->device->space->kind};
  if (ethd__conform_stopped(r->def)) {
    ethd_device_safe(r->device);
    return;
  }
  ethd__conform_rig_await(r);
  for (uint32_t u = 0, n = ethd_device_units(r->device); u < n && r->def->device->is_virtual; u++)
    (void)!ethd_device_service(r->device, u, r->now);
  int64_t begin = ethd__clock_now();
  const ethd_status status = ethd_device_read_space(r->device, r->now, &now);
  time_call(s, begin);
  r->failed += status < 0;
  s->stale += status > 0;
  if (status == ETHD_OK) note_sample(s, &now);
  if (!command) return;
  if (s->sense.have & ETHD_SPACE_HAVE_NORMAL) memcpy(c.normal, s->sense.normal, sizeof c.normal); /* no rotation */
  ethd_vec3_put(*command, c.value);
  s->written = *command;
  begin = ethd__clock_now();
  r->failed += ethd_device_write_space(r->device, r->now, &c) < 0;
  time_call(s, begin);
}

/* Runs for a time with a command; it rises and falls within the setup's limits. */
static void run_space(space_run *s, double seconds, ethd_vec3 to) {
  const ethd_space_setup *setup = s->r.def->device->space;
  const double rate = setup->kind == ETHD_SPACE_VELOCITY ? setup->acceleration : setup->force_rate;
  const double period = 1e-9 * (double)s->r.period, most = (isfinite(rate) ? rate : RAMP) * period;
  for (int k = 0, n = (int)ceil(seconds / period); k < n;) {
    const ethd_vec3 left = ethd_vec3_sub(to, s->written);
    const double length = ethd_vec3_norm(left);
    const ethd_vec3 next = length > most ? ethd_vec3_add(s->written, ethd_vec3_scale(most / length, left)) : to;
    tick_space(s, &next);
    k += length <= most || ethd__conform_stopped(s->r.def);
  }
}

static bool begin_space(const ethd_conform_def *def, space_run *s, ethd_conform_answer *a) {
  memset(s, 0, sizeof *s);
  return ethd__conform_rig_begin(def, &s->r, a);
}

static ethd_vec3 place_of(const space_run *s) { return ethd_vec3_of(s->sense.x); }

/* Returns the effector's motion in this time along a unit vector, m, while the last command is renewed or, with `write`
   false, no command is written. */
static double moved(space_run *s, ethd_vec3 along, bool write, double seconds) {
  const ethd_vec3 from = place_of(s), held = s->written;
  for (int k = 0, n = (int)ceil(seconds * 1e9 / (double)s->r.period); k < n; k++) tick_space(s, write ? &held : NULL);
  return ethd_vec3_dot(along, ethd_vec3_sub(place_of(s), from));
}

/* Returns the size of a push: the requested one, within the setup's limit. */
static double push_of(const ethd_conform_def *def) {
  const ethd_space_setup *setup = def->device->space;
  return fmin(def->torque, setup->kind == ETHD_SPACE_VELOCITY ? setup->speed : setup->force);
}

/* ---- questions ---- */

static ethd_verdict ask_space_table(const ethd_conform_def *def, ethd_conform_answer *a) {
  static const char *const safe[] = {"zero torque", "zero speed", "brakes"};
  space_run s;
  memset(&s, 0, sizeof s);
  if (!ethd__conform_rig_open(def, &s.r))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "open: %.140s", s.r.message);
  ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%.100s; safe: %s", def->ids, safe[ethd_device_safe_is(s.r.device)]);
  ethd_device_close(s.r.device);
  return a->verdict;
}

static ethd_verdict ask_space_sense(const ethd_conform_def *def, ethd_conform_answer *a) {
  space_run s;
  if (!begin_space(def, &s, a)) return a->verdict;
  run_space(&s, LOOK, (ethd_vec3){0, 0, 0});
  ethd__conform_rig_end(&s.r);
  if (!s.r.samples) return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "no sample in %g s", LOOK);
  if (s.r.failed || !s.r.finite)
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "failed calls: %d%s", s.r.failed,
                                    s.r.finite ? "" : "; places or speeds that aren't finite");
  if (s.r.backwards || s.r.ahead)
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "samples that go back in time: %d; from the future: %d",
                                    s.r.backwards, s.r.ahead);
  return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "samples: %d; ticks without a newer one: %d", s.r.samples,
                                  s.stale);
}

/* A driver's read and write return at once, in any state of its device. */
static ethd_verdict ask_space_calls(const ethd_conform_def *def, ethd_conform_answer *a) {
  space_run s;
  if (!begin_space(def, &s, a)) return a->verdict;
  run_space(&s, PUSH, (ethd_vec3){0, 0, 0});
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, s.slow > OFTEN * s.calls ? ETHD_VERDICT_BROKEN : ETHD_VERDICT_KEPT,
                                  "of %d calls of read and write %d took over half a period; the longest %.3g ms",
                                  s.calls, s.slow, 1e-6 * (double)s.longest);
}

static ethd_verdict ask_space_zero(const ethd_conform_def *def, ethd_conform_answer *a) {
  space_run s;
  if (!begin_space(def, &s, a)) return a->verdict;
  run_space(&s, PUSH, (ethd_vec3){0, 0, 0});
  const ethd_vec3 from = place_of(&s);
  run_space(&s, PUSH, (ethd_vec3){0, 0, 0});
  const double way = ethd_vec3_norm(ethd_vec3_sub(place_of(&s), from));
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, way <= STILL ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "%.3g m in %g s without a command, %g is allowed", way, PUSH, STILL);
}

/* Pushes in both directions of each axis: the effector moves there, as far as the commands that the device reports. */
static ethd_verdict ask_space_axes(const ethd_conform_def *def, ethd_conform_answer *a) {
  const bool by_velocity = def->device->space->kind == ETHD_SPACE_VELOCITY;
  const double push = push_of(def);
  double worst = 0;
  for (int k = 0; k < 6; k++) {
    const double sign = k % 2 ? -1 : 1;
    const ethd_vec3 along = {k / 2 == 0 ? sign : 0, k / 2 == 1 ? sign : 0, k / 2 == 2 ? sign : 0};
    space_run s;
    if (!begin_space(def, &s, a)) return a->verdict;
    run_space(&s, PAUSE, (ethd_vec3){0, 0, 0});
    const ethd_vec3 from = place_of(&s), before = s.way;
    run_space(&s, PUSH, ethd_vec3_scale(push, along));
    const double way = ethd_vec3_dot(along, ethd_vec3_sub(place_of(&s), from));
    const double wanted = ethd_vec3_dot(along, ethd_vec3_sub(s.way, before));
    run_space(&s, PAUSE, (ethd_vec3){0, 0, 0});
    ethd__conform_rig_end(&s.r);
    if (!(way > 0) || s.r.failed)
      return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN,
                                      "%+.3g %s along axis %d: it moved %.3g m; failed calls: %d", sign * push,
                                      by_velocity ? "m/s" : "N", k / 2 + 1, sign * way, s.r.failed);
    worst = fmax(worst, fabs(way - wanted) / wanted);
  }
  if (!by_velocity) return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%g N along each axis moved it there", push);
  return ethd__conform_rig_answer(
      a, worst <= OFF ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
      "%g m/s along each axis: its motion and its reported commands differ by a share of %.2g", push, worst);
}

/* Made safe while it moves, the device takes the safe state of its table, whatever is written. */
static ethd_verdict ask_space_safe(const ethd_conform_def *def, ethd_conform_answer *a) {
  const ethd_vec3 along = {1, 0, 0};
  space_run s;
  if (!begin_space(def, &s, a)) return a->verdict;
  const ethd_safe_state leads_to = ethd_device_safe_is(s.r.device);
  run_space(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  const double before = moved(&s, along, true, PUSH);
  ethd_device_safe(s.r.device);
  ethd_device_safe(s.r.device);
  (void)moved(&s, along, true, PAUSE);
  const double left = moved(&s, along, true, PUSH);
  ethd__conform_rig_stop(&s.r);
  ethd_device_safe(s.r.device); /* and once stopped */
  ethd_device_close(s.r.device);
  const bool stands = fabs(left) <= LEFT * before, rolls = leads_to == ETHD_SAFE_NO_TORQUE;
  return ethd__conform_rig_answer(a,
                                  stands                            ? ETHD_VERDICT_KEPT
                                  : rolls && left <= ROLLS * before ? ETHD_VERDICT_AT_RISK
                                                                    : ETHD_VERDICT_BROKEN,
                                  "%.3g m in %g s under the command, %.3g once safe%s", before, PUSH, left,
                                  rolls ? ", without torque" : "");
}

static ethd_verdict ask_space_restart(const ethd_conform_def *def, ethd_conform_answer *a) {
  const ethd_vec3 along = {1, 0, 0};
  space_run s;
  if (!begin_space(def, &s, a)) return a->verdict;
  run_space(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  ethd__conform_rig_stop(&s.r);
  const ethd_status status = ethd__conform_rig_start(&s.r);
  if (status < 0) {
    ethd_device_close(s.r.device);
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "started anew: %s", ethd_status_sentence(status));
  }
  s.written = (ethd_vec3){0, 0, 0};
  (void)moved(&s, along, false, PAUSE);
  const double left = moved(&s, along, false, PUSH);
  run_space(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  const double again = moved(&s, along, true, PUSH);
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, again > 0 && fabs(left) <= LEFT * again ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "started again: %.3g m in %g s before the first command, %.3g under it", left, PUSH,
                                  again);
}

static const struct {
  const char *name;
  ethd_verdict (*ask)(const ethd_conform_def *def, ethd_conform_answer *a);
  bool moves;
} questions[ETHD_SPACE_QUESTIONS] = {{"table", ask_space_table, false},   {"sense", ask_space_sense, false},
                                     {"calls", ask_space_calls, false},   {"zero", ask_space_zero, false},
                                     {"axes", ask_space_axes, true},      {"safe", ask_space_safe, true},
                                     {"restart", ask_space_restart, true}};

ethd_status ethd_conform_space(const ethd_conform_def *def, ethd_conform_answer answers[ETHD_SPACE_QUESTIONS]) {
  bool broken = false;
  for (int i = 0; i < ETHD_SPACE_QUESTIONS; i++) {
    ethd_conform_answer *a = &answers[i];
    a->question = questions[i].name;
    if (i && answers[0].verdict == ETHD_VERDICT_BROKEN)
      ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "the device can't be opened, or its table is broken");
    else if (questions[i].moves && !(def->torque > 0 && isfinite(push_of(def))))
      ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "it would move the device");
    else if (!ethd__conform_stopped(def))
      (void)questions[i].ask(def, a);
    if (ethd__conform_stopped(def)) ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "stopped");
    broken |= a->verdict == ETHD_VERDICT_BROKEN;
  }
  if (ethd__conform_stopped(def)) return ETHD_E_UNFINISHED;
  return broken ? ETHD_E_DEVICE : ETHD_OK;
}
