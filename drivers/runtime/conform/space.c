/* The questions for a device in space. */
#include <math.h>
#include <string.h>

#include "conform/space_rig.h"

#define LOOK 0.5   /* s of reading only */
#define PUSH 0.1   /* s for which a command is held */
#define PAUSE 0.02 /* s in which a device may reach its safe state */
#define STILL 1e-3 /* m in PUSH without a command */
#define OFF 0.2    /* share by which a motion may differ from the commanded motion */
#define LEFT 0.05  /* share of a motion that may remain after `safe`; without brakes, */
#define ROLLS 0.25 /* this */
#define OFTEN 0.1  /* share of calls that may exceed half a period, because this machine is late */
#define FAR 3.0    /* m: a device that goes on for so long shows no end of its travel */
#define ENDS 0.05  /* share of the commanded motion; a device that moves less is at the end */
#define BACK 0.3   /* m of commands after which it has left the end; a stretched arm does so slowly */
#define DRIFT 0.01 /* share of a long motion by which it may differ from the reported commands */

static ethd_vec3 place_of(const ethd__space_rig *s) { return ethd_vec3_of(s->sense.x); }

/* Returns the size of a push: the requested one, within the setup's limit. */
static double push_of(const ethd_conform_def *def) {
  const ethd_space_setup *setup = def->device->space;
  return fmin(def->torque, setup->kind == ETHD_SPACE_VELOCITY ? setup->speed : setup->force);
}

/* Returns the time in which the setup's acceleration stops a push by velocity, s; 0: not known. */
static double braking_of(const ethd_conform_def *def) {
  const ethd_space_setup *setup = def->device->space;
  return setup->kind == ETHD_SPACE_VELOCITY ? push_of(def) / setup->acceleration : 0;
}

/* Returns direction k of six: +x, -x, +y, ... */
static ethd_vec3 axis(int k) {
  double e[3] = {0};
  e[k / 2] = k % 2 ? -1 : 1;
  return ethd_vec3_of(e);
}

/* A push along an axis, and what has followed from it. */
typedef struct push {
  ethd__space_rig s;
  ethd_vec3 along, from, before; /* place, and sum of commands, at its begin */
} push;

static ethd_vec3 moved(const push *p) { return ethd_vec3_sub(place_of(&p->s), p->from); }
static ethd_vec3 asked(const push *p) { return ethd_vec3_sub(p->s.way, p->before); }

/* Begins a push in direction k of six. False: the device doesn't start, which the answer says, or says that it can't
   move there, such as a planar arm at right angles to its plane. */
static bool begin_push(const ethd_conform_def *def, int k, push *p, ethd_conform_answer *a) {
  double along[3];
  p->along = axis(k);
  a->verdict = ETHD_VERDICT_KEPT;
  if (!ethd__space_rig_begin(def, &p->s, a)) return false;
  ethd__space_rig_run(&p->s, PAUSE, (ethd_vec3){0, 0, 0});
  ethd_vec3_put(p->along, along);
  if (ethd_device_able(p->s.r.device, along).speed == 0) { /* NaN: not known */
    ethd__conform_rig_end(&p->s.r);
    return false;
  }
  p->from = place_of(&p->s);
  p->before = p->s.way;
  ethd__space_rig_run(&p->s, PUSH, ethd_vec3_scale(push_of(def), p->along));
  return true;
}

/* ---- questions ---- */

static ethd_verdict ask_space_table(const ethd_conform_def *def, ethd_conform_answer *a) {
  static const char *const safe[] = {"zero torque", "zero speed", "brakes"};
  ethd__space_rig s;
  memset(&s, 0, sizeof s);
  if (!ethd__conform_rig_open(def, &s.r))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "open: %.140s", s.r.message);
  ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%.100s; safe: %s", def->ids, safe[ethd_device_safe_is(s.r.device)]);
  ethd_device_close(s.r.device);
  return a->verdict;
}

static ethd_verdict ask_space_sense(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__space_rig s;
  if (!ethd__space_rig_begin(def, &s, a)) return a->verdict;
  ethd__space_rig_run(&s, LOOK, (ethd_vec3){0, 0, 0});
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
  ethd__space_rig s;
  if (!ethd__space_rig_begin(def, &s, a)) return a->verdict;
  ethd__space_rig_run(&s, PUSH, (ethd_vec3){0, 0, 0});
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, s.slow > OFTEN * s.calls ? ETHD_VERDICT_BROKEN : ETHD_VERDICT_KEPT,
                                  "of %d calls of read and write %d took over half a period; the longest %.3g ms",
                                  s.calls, s.slow, 1e-6 * (double)s.longest);
}

static ethd_verdict ask_space_zero(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__space_rig s;
  if (!ethd__space_rig_begin(def, &s, a)) return a->verdict;
  ethd__space_rig_run(&s, PUSH, (ethd_vec3){0, 0, 0});
  const ethd_vec3 from = place_of(&s);
  ethd__space_rig_run(&s, PUSH, (ethd_vec3){0, 0, 0});
  const double way = ethd_vec3_norm(ethd_vec3_sub(place_of(&s), from));
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, way <= STILL ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "%.3g m in %g s without a command, %g is allowed", way, PUSH, STILL);
}

/* Pushes in both directions of each axis: the effector moves there, as far as the commands that the device reports. */
static ethd_verdict ask_space_axes(const ethd_conform_def *def, ethd_conform_answer *a) {
  const bool by_velocity = def->device->space->kind == ETHD_SPACE_VELOCITY;
  const double size = push_of(def);
  double worst = 0;
  for (int k = 0; k < 6; k++) {
    push p;
    if (!begin_push(def, k, &p, a)) {
      if (a->verdict) return a->verdict;
      continue;
    }
    const double way = ethd_vec3_dot(p.along, moved(&p)), wanted = ethd_vec3_dot(p.along, asked(&p));
    ethd__space_rig_run(&p.s, PAUSE, (ethd_vec3){0, 0, 0});
    ethd__conform_rig_end(&p.s.r);
    if (!(way > 0) || p.s.r.failed)
      return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN,
                                      "%.3g %s in direction %c%d: it moved %.3g m; failed calls: %d", size,
                                      by_velocity ? "m/s" : "N", "+-"[k % 2], k / 2 + 1, way, p.s.r.failed);
    worst = fmax(worst, fabs(way - wanted) / wanted);
  }
  if (!by_velocity) return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%g N along each axis moved it there", size);
  return ethd__conform_rig_answer(
      a, worst <= OFF ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
      "%g m/s along each axis: its motion and its reported commands differ by a share of %.2g", size, worst);
}

/* At the end of its travel, in both directions of each axis, the device stops by itself, reports so, and comes back. A
   real one would hit what stands around it, so only a simulated one is driven there. */
static ethd_verdict ask_space_ends(const ethd_conform_def *def, ethd_conform_answer *a) {
  const double size = push_of(def), step = size * PUSH;
  double worst = 0, shortest = INFINITY, longest = 0, slowest = 0;
  if (!def->device->is_virtual || def->device->space->kind != ETHD_SPACE_VELOCITY)
    return ethd__conform_rig_answer(
        a, ETHD_VERDICT_NOT_ASKED, "only a simulated device that takes velocities is driven to the ends of its travel");
  for (int k = 0; k < 6; k++) {
    push p;
    if (!begin_push(def, k, &p, a)) {
      if (a->verdict) return a->verdict;
      continue;
    }
    double sum = 0, moves = step, back = 0;
    for (; sum < FAR && moves > ENDS * step; sum += moves) moves = ethd__space_rig_moved(&p.s, p.along, true, PUSH);
    const ethd_vec3 way = moved(&p);
    const double length = ethd_vec3_dot(p.along, way);
    const double off = ethd_vec3_norm(ethd_vec3_sub(way, asked(&p)));
    ethd__space_rig_run(&p.s, PAUSE, ethd_vec3_scale(-size, p.along));
    while (back < BACK && ethd__space_rig_moved(&p.s, p.along, true, PUSH) > -step / 2) back += step;
    ethd__conform_rig_end(&p.s.r);
    if (p.s.r.failed || !p.s.r.finite || !(off <= STILL + DRIFT * ethd_vec3_norm(way)) || back >= BACK)
      return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN,
                                      "direction %c%d: stopped after %.3g m, %.3g m off its commands, and %s; failed "
                                      "calls: %d",
                                      "+-"[k % 2], k / 2 + 1, length, off,
                                      back < BACK ? "came back" : "didn't come back", p.s.r.failed);
    if (length >= FAR)
      return ethd__conform_rig_answer(a, ETHD_VERDICT_AT_RISK, "direction %c%d: no end of its travel within %g m",
                                      "+-"[k % 2], k / 2 + 1, FAR);
    worst = fmax(worst, off);
    shortest = fmin(shortest, length);
    longest = fmax(longest, length);
    slowest = fmax(slowest, back);
  }
  return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT,
                                  "it stopped after %.3g to %.3g m, at most %.2g m off its commands, and came back "
                                  "within %.2g s",
                                  shortest, longest, worst, slowest / size + PUSH);
}

/* Made safe while it moves, the device takes the safe state of its table, whatever is written. */
static ethd_verdict ask_space_safe(const ethd_conform_def *def, ethd_conform_answer *a) {
  const ethd_vec3 along = {1, 0, 0};
  ethd__space_rig s;
  if (!ethd__space_rig_begin(def, &s, a)) return a->verdict;
  const ethd_safe_state leads_to = ethd_device_safe_is(s.r.device);
  ethd__space_rig_run(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  const double before = ethd__space_rig_moved(&s, along, true, PUSH);
  ethd_device_safe(s.r.device);
  ethd_device_safe(s.r.device);
  (void)ethd__space_rig_moved(&s, along, true, PAUSE + braking_of(def));
  const double left = ethd__space_rig_moved(&s, along, true, PUSH);
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
  ethd__space_rig s;
  if (!ethd__space_rig_begin(def, &s, a)) return a->verdict;
  ethd__space_rig_run(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  ethd__conform_rig_stop(&s.r);
  const ethd_status status = ethd__conform_rig_start(&s.r);
  if (status < 0) {
    ethd_device_close(s.r.device);
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "started anew: %s", ethd_status_sentence(status));
  }
  s.written = (ethd_vec3){0, 0, 0};
  (void)ethd__space_rig_moved(&s, along, false, PAUSE);
  const double left = ethd__space_rig_moved(&s, along, false, PUSH);
  ethd__space_rig_run(&s, PUSH, ethd_vec3_scale(push_of(def), along));
  const double again = ethd__space_rig_moved(&s, along, true, PUSH);
  ethd__conform_rig_end(&s.r);
  return ethd__conform_rig_answer(a, again > 0 && fabs(left) <= LEFT * again ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "started again: %.3g m in %g s before the first command, %.3g under it", left, PUSH,
                                  again);
}

static const ethd__conform_question questions[ETHD_SPACE_QUESTIONS] = {
    {"table", ask_space_table, false}, {"sense", ask_space_sense, false},   {"calls", ask_space_calls, false},
    {"zero", ask_space_zero, false},   {"axes", ask_space_axes, true},      {"ends", ask_space_ends, true},
    {"safe", ask_space_safe, true},    {"restart", ask_space_restart, true}};

ethd_status ethd_conform_space(const ethd_conform_def *def, ethd_conform_answer answers[ETHD_SPACE_QUESTIONS]) {
  return ethd__conform_ask(def, questions, ETHD_SPACE_QUESTIONS, push_of(def), answers);
}
