#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "conform/conform_rig.h"
#include "conform/letting_go.h"
#include "device/device.h"
#include "text/text.h"

#define OPENINGS 20
#define PUSH 0.1       /* s */
#define STILL 0.01     /* rad in PUSH without torque */
#define SPEED_MAX 50.0 /* rad/s: faster is a jump */
#define AGE_MAX 0.005  /* s of a joint sample */

/* ---- questions ---- */

/* Opening the device checks the driver's table. */
static ethd_verdict ask_table(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_open(def, &r))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "open: %.140s", r.message);
  ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%s: %s", def->ids,
                           r.device->count == 1 ? r.device->at[0].driver->brief : "several drivers behind one device");
  ethd_device_close(r.device);
  return a->verdict;
}

static int descriptors(void) {
  DIR *folder = opendir("/proc/self/fd");
  int n = 0;
  while (folder && readdir(folder)) n++;
  if (folder) closedir(folder);
  return n;
}

/* Opens, starts and closes the device again and again; no descriptor may stay open. */
static ethd_verdict ask_open(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  int before = 0;
  for (int k = 0; k < OPENINGS; k++) {
    if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
    if (k % 2) ethd__conform_rig_run(&r, 0.005, 0, 0);
    ethd__conform_rig_end(&r);
    if (!k) before = descriptors();
  }
  int left = descriptors() - before;
  if (left)
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "%d descriptors stay open after %d cycles", left,
                                    OPENINGS - 1);
  return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%d times open, start, stop, close", OPENINGS);
}

static ethd_verdict ask_limits(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  ethd_error error;
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_run(&r, 0.02, 0, 0);
  ethd_limits l = ethd_device_limits(r.device);
  ethd_pose pose;
  ethd_arm_pose(&def->device->setup->arm, r.sense.q, &pose);
  const double *w = l.workspace;
  if (ethd_limits_check(&l, &error))
    ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "%s: %s", error.name, ethd_status_sentence(error.status));
  else if (!(pose.x.x >= w[0] && pose.x.x <= w[1] && pose.x.y >= w[2] && pose.x.y <= w[3]))
    ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "the ring stands at %.3f %.3f m, outside of its workspace",
                             pose.x.x, pose.x.y);
  else if (!isfinite(l.torque))
    ethd__conform_rig_answer(a, ETHD_VERDICT_AT_RISK,
                             "the device has no torque limit; only the configuration's limit applies");
  else
    ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "torque %.4g Nm, speed %.4g m/s", l.torque, l.speed);
  ethd__conform_rig_end(&r);
  return a->verdict;
}

/* The fault row with the hardest reaction among the reported ones; 0 if there is none. */
static ethd_fault worst_row(const ethd__conform_rig *r, ethd_reaction *reaction) {
  ethd_fault worst = ETHD_FAULT_NONE;
  *reaction = ETHD_REACTION_NONE;
  for (int64_t rows = r->faults | r->grave; rows; rows &= rows - 1) {
    ethd_fault row = (ethd_fault)(ffsll(rows) - 1);
    ethd_reaction own = ethd_fault_reaction(row, r->grave >> row & 1);
    if (own <= *reaction) continue;
    *reaction = own;
    worst = row;
  }
  return worst;
}

/* A fault row that is only counted breaks no rule, because answers sometimes come late. Nor does a row caused by this
   machine's lateness. */
static ethd_verdict judge_samples(const ethd__conform_rig *r, ethd_conform_answer *a) {
  char readings[48] = "";
  ethd_reaction reaction;
  ethd_fault row = worst_row(r, &reaction);
  if (row)
    return ethd__conform_rig_answer(
        a, reaction >= ETHD_REACTION_STOP && r->late <= AGE_MAX ? ETHD_VERDICT_BROKEN : ETHD_VERDICT_AT_RISK,
        "it reports: %s; ticks were up to %.3g ms late", ethd_fault_sentence(row), 1e3 * r->late);
  if (r->readings)
    snprintf(readings, sizeof readings, "; %d reading%s of the finger", r->readings, ethd__s((uint64_t)r->readings));
  return ethd__conform_rig_answer(a, r->age > AGE_MAX ? ETHD_VERDICT_AT_RISK : ETHD_VERDICT_KEPT,
                                  "%d sample%s, the oldest used at %.3g ms%s", r->samples,
                                  ethd__s((uint64_t)r->samples), 1e3 * r->age, readings);
}

static ethd_verdict ask_sense(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_run(&r, 5 * PUSH, 0, 0);
  if (!r.samples)
    ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "no joint sample in %g s", 5 * PUSH);
  else if (r.failed || !r.finite)
    ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "%d failed call%s%s", r.failed, ethd__s((uint64_t)r.failed),
                             r.finite ? "" : ", angles that aren't finite");
  else if (r.backwards || r.ahead)
    ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "samples that go back in time: %d; from the future: %d",
                             r.backwards, r.ahead);
  else
    judge_samples(&r, a);
  ethd__conform_rig_end(&r);
  return a->verdict;
}

static ethd_verdict ask_zero(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_settle(&r);
  double q[2] = {r.sense.q[0], r.sense.q[1]};
  ethd__conform_rig_run(&r, PUSH, 0, 0);
  double moved = fmax(fabs(r.sense.q[0] - q[0]), fabs(r.sense.q[1] - q[1]));
  ethd__conform_rig_end(&r);
  return ethd__conform_rig_answer(a, moved <= STILL ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "%.3g rad in %g s without torque, %g is allowed", moved, PUSH, STILL);
}

static ethd_verdict ask_sign(const ethd_conform_def *def, ethd_conform_answer *a) {
  double moved[2][2];
  for (int joint = 0; joint < 2; joint++)
    for (int minus = 0; minus < 2; minus++) {
      ethd__conform_rig r;
      if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
      ethd__conform_rig_settle(&r);
      double q = r.sense.q[joint];
      ethd__conform_rig_run(&r, PUSH, joint, minus ? -def->torque : def->torque);
      moved[joint][minus] = r.sense.q[joint] - q;
      ethd__conform_rig_end(&r);
    }
  int right = moved[0][0] > 0 && moved[0][1] < 0 && moved[1][0] > 0 && moved[1][1] < 0;
  return ethd__conform_rig_answer(a, right ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "+-%g Nm moved joint 1 by %+.3g %+.3g, joint 2 by %+.3g %+.3g rad", def->torque,
                                  moved[0][0], moved[0][1], moved[1][0], moved[1][1]);
}

static ethd_verdict ask_counts(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_settle(&r);
  ethd__conform_rig_run(&r, PUSH, 0, def->torque);
  ethd__conform_rig_end(&r);
  if (!(r.speed <= SPEED_MAX))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "the angles jump: %.3g rad/s", r.speed);
  if (isinf(r.resolution))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "the angles didn't change under torque");
  return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "smallest step %.3g rad, fastest %.3g rad/s", r.resolution,
                                  r.speed);
}

static const ethd__conform_question questions[ETHD_QUESTIONS] = {{"table", ask_table, false},
                                                                 {"open", ask_open, false},
                                                                 {"limits", ask_limits, false},
                                                                 {"sense", ask_sense, false},
                                                                 {"zero", ask_zero, false},
                                                                 {"sign", ask_sign, true},
                                                                 {"counts", ask_counts, true},
                                                                 {"watchdog", ethd__conform_watchdog, true},
                                                                 {"silence", ethd__conform_silence, true},
                                                                 {"safe", ethd__conform_safe, true},
                                                                 {"restart", ethd__conform_restart, true}};

ethd_status ethd_conform(const ethd_conform_def *def, ethd_conform_answer answers[ETHD_QUESTIONS]) {
  return ethd__conform_ask(def, questions, ETHD_QUESTIONS, def->torque, answers);
}
