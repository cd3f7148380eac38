/* Finds out at which angles the joints are: the user confirms that the arm stands in its jig, or the joints are moved.
   [main] */
#include <math.h>
#include <time.h>

#include "clock.h"
#include "servo/device.h"
#include "servo/words.h"
#include "text/error_text.h"

#define PAUSE 200000 /* ns */
#define FAILURES 20  /* bad exchanges in a row that end the search */

/* ---- one cycle lasts an exchange; on a virtual clock nothing waits ---- */

static ethd_status turn(ethd__servo_device *d, const double torque[2]) {
  const struct timespec pause = {.tv_nsec = PAUSE};
  int64_t begin = d->is_virtual ? d->feedback.sample.stamp_ns + d->exchange_ns : ethd__clock_now();
  ethd_status status = ethd__servo_turn(d, begin, torque);
  while (!d->is_virtual && ethd__clock_now() - begin < d->exchange_ns) nanosleep(&pause, NULL);
  return status;
}

/* True when drive, supply, line, or a motor that doesn't follow ends the search. */
static bool is_ill(const ethd__servo_device *d) {
  return d->link.state != ETHD__SERVO_ENABLED || d->feedback.sample.levels;
}

static double index_of(const ethd__servo_device *d, int axis) {
  int32_t r = d->map.roles[ETHD__SERVO_INDEX1 + axis];
  return r < 0 ? 0 : d->link.raw[r];
}

/* How far the joint has gone since its mark passed, rad. */
static double past_mark(const ethd__servo_device *d, int axis) {
  int32_t at = d->map.roles[ETHD__SERVO_POSITION1 + axis];
  const ethd__servo_register *r = &d->map.registers[at];
  uint32_t ceiling = (uint32_t)ethd__count_ceiling(r->bits);
  uint32_t since = ((uint32_t)(int64_t)d->link.raw[at] - (uint32_t)(int64_t)index_of(d, axis)) & ceiling;
  double counts = since > ceiling / 2 ? -(double)(ceiling - since) - 1 : since;
  return counts * (ethd__servo_joint(r, 1) - ethd__servo_joint(r, 0));
}

/* ---- by moving it ---- */

/* Finds one joint, or says why it can't. */
static ethd_status find(ethd__servo_device *d, int axis) {
  const ethd__homing_def *def = &d->homing[axis];
  ethd__homing homing = {.begun = false};
  ethd__servo_sample *s = &d->feedback.sample;
  double torque[2] = {0, 0}, mark = index_of(d, axis);
  int64_t last = s->stamp_ns;
  ethd_status status = ETHD_STATUS_BUSY;
  for (int bad = 0; status == ETHD_STATUS_BUSY && bad < FAILURES;) {
    bad = turn(d, torque) ? bad + 1 : 0;
    if (bad) continue;
    if (is_ill(d))
      return ethd__say(d->link.message, ETHD_E_DEVICE, "joint %d: the drive removed the torque", d->joint[axis] + 1);
    status = ethd__homing_turn(def, &homing, s->q[axis], 1e-9 * (double)(s->stamp_ns - last), index_of(d, axis) != mark,
                               &torque[axis]);
    last = s->stamp_ns;
  }
  if (status < 0) return ethd__say(d->link.message, status, "joint %d: %s", d->joint[axis] + 1, homing.failure);
  if (status) return ETHD_E_DEVICE; /* the link has left its own message */
  double past = def->method == ETHD__HOMING_INDEX ? past_mark(d, axis) : 0;
  ethd__servo_feedback_place(&d->feedback, axis, d->home[d->joint[axis]] + past);
  return ETHD_OK;
}

static ethd_status find_all(ethd__servo_device *d) {
  if (d->homing[0].method == ETHD__HOMING_JIG && d->homing[1].method == ETHD__HOMING_JIG)
    return ethd__say(d->link.message, ETHD_E_ARGUMENT,
                     "device.home is jig: put the arm into the jig, and give its joint angles");
  ethd_status status = ethd__servo_enable(d);
  d->feedback.homing = true; /* a joint that stands under torque is no fault here */
  for (int i = 0; i < 2 && !status; i++)
    if (d->joint[i] >= 0) status = find(d, i);
  d->feedback.homing = false;
  ethd_status stopped = ethd__servo_disable(d);
  return status ? status : stopped;
}

/* ---- by the user's statement ---- */

static ethd_status place(ethd__servo_device *d, const double q[2]) {
  const double zero[2] = {0, 0};
  int bad = 0;
  while (turn(d, zero) && ++bad < FAILURES) continue;
  if (bad == FAILURES) return ETHD_E_DEVICE;
  for (int i = 0; i < 2; i++)
    if (d->joint[i] >= 0) ethd__servo_feedback_place(&d->feedback, i, q[d->joint[i]]);
  return ETHD_OK;
}

ethd_status ethd__servo_home(void *device, const double q[2]) {
  ethd__servo_device *d = device;
  pthread_mutex_lock(&d->lock);
  atomic_store(&d->safe, 1);
  ethd_status status = q ? place(d, q) : find_all(d);
  ethd__say(d->why, status, "%s", status ? d->link.message : "");
  ethd_cell_put(d->samples, &d->feedback.sample);
  pthread_mutex_unlock(&d->lock);
  return status ? ETHD_E_DEVICE : ETHD_OK;
}
