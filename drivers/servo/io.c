/* The I/O thread's side of the servo: it makes one turn of the link for each exchange. */
#include <math.h>
#include <time.h>

#include "clock.h"
#include "servo/device.h"
#include "servo/words.h"

#define PHASE 0.2 /* of a period passes between a tick and the exchange, so that the tick's command is there */
#define BEHIND 3  /* exchanges: what would be due later than this is due now */

/* Gives the newest command, or zero when that belongs to an earlier start or to a loop that is gone. */
static void command(ethd__servo_device *d, int64_t now_ns, double torque[2]) {
  int fresh = ethd_cell_take(d->commands, &d->command) == ETHD_OK;
  const ethd__servo_command *c = &d->command;
  bool good = !atomic_load_explicit(&d->safe, memory_order_relaxed) && now_ns - c->stamp_ns <= ethd__servo_old(d) &&
              c->epoch == atomic_load_explicit(&d->epoch, memory_order_relaxed);
  for (int i = 0; i < 2; i++) torque[i] = good ? c->torque[i] : 0;
  /* exchanges begin a while after a tick; the stamps of commands say when ticks are */
  int64_t behind = fresh ? (now_ns - c->stamp_ns) % d->period_ns - (int64_t)(PHASE * (double)d->period_ns) : 0;
  d->due_ns = now_ns - behind + d->exchange_ns;
}

/* Returns when the drive was asked for the joint positions; of two requests, the earlier one, and by how much later each
   went out. The drive samples them at an unknown time after the request. The request's time is used, so that no sample
   seems newer than it is. */
static int64_t asked(const ethd__servo_link *l, int64_t later_ns[2]) {
  int64_t at[2], first = INT64_MAX;
  for (int i = 0; i < 2; i++) {
    int32_t r = l->map->roles[ETHD__SERVO_POSITION1 + i];
    at[i] = r < 0 ? INT64_MAX : ethd__servo_plan_asked(&l->plan, r);
    if (at[i] < first) first = at[i];
  }
  for (int i = 0; i < 2; i++) later_ns[i] = at[i] < INT64_MAX ? at[i] - first : 0;
  return first;
}

/* Notes what went out if the drive isn't enabled, or the register's limits have cut it. Rounding isn't noted: a limit of
   the torque's rate that started from a rounded torque might never leave zero. */
static void note_torque(ethd__servo_device *d, const double asked[2]) {
  ethd__servo_sample *s = &d->feedback.sample;
  s->has &= ~ETHD__SERVO_HAS_CUT;
  for (int i = 0; i < 2; i++) {
    int32_t at = d->map.roles[ETHD__SERVO_TORQUE1 + i];
    const ethd__servo_register *r = &d->map.registers[at < 0 ? 0 : at];
    double went = at < 0 ? asked[i] : ethd__servo_joint(r, d->link.raw[at]);
    bool rounded = fabs(went - asked[i]) <= 1.001 * ethd__servo_least(r) + 1e-6 * fabs(asked[i]);
    s->torque[i] = rounded ? asked[i] : went;
    if (!rounded) s->has |= ETHD__SERVO_HAS_CUT;
  }
}

/* Makes one turn of the link and publishes what it shows. The caller holds the device's lock. */
ethd_status ethd__servo_turn(ethd__servo_device *d, int64_t now_ns, const double torque[2]) {
  int64_t begin = ethd__clock_now();
  bool may_push = d->link.state == ETHD__SERVO_ENABLED || d->link.sequence == ETHD__SERVO_ENABLE;
  if (!ethd__guardian_enter(&d->guardian, begin, d->link.bus.fd, d->link.counts.connects))
    ethd__servo_link_lose(&d->link, "the guardian has taken the line: this program was silent too long", now_ns);
  ethd__guardian_arm(&d->guardian, may_push && !d->is_virtual); /* a virtual clock may stand still */
  ethd_status status = ethd__servo_link_turn(&d->link, now_ns, torque);
  int64_t took = ethd__clock_now() - begin;
  if (!status) {
    ethd_histogram_add(&d->trip, took);
    int64_t *later = d->feedback.sample.later_ns, first = asked(&d->link, later);
    if (d->is_virtual) later[0] = later[1] = 0; /* an exchange takes no time */
    ethd__servo_feedback_take(&d->feedback, &d->link, d->is_virtual ? now_ns : first);
    note_torque(d, torque);
  }
  ethd__servo_feedback_judge(&d->feedback, &d->link);
  d->feedback.sample.epoch = atomic_load_explicit(&d->epoch, memory_order_relaxed);
  ethd_cell_put(d->samples, &d->feedback.sample);
  return status;
}

/* Waits until the exchange is due. On a virtual clock nothing waits. */
static ethd_status await(const ethd__servo_device *d, int64_t *now_ns) {
  int64_t left = d->due_ns - *now_ns;
  struct timespec t = {left / 1000000000, left % 1000000000};
  if (left <= 0) return ETHD_OK;
  if (d->is_virtual) {
    if (left >= d->period_ns) return ETHD_STATUS_STALE;
    return ETHD_OK;
  }
  if (left > BEHIND * d->exchange_ns) return ETHD_OK;
  nanosleep(&t, NULL);
  *now_ns = ethd__clock_now();
  return ETHD_OK;
}

ethd_status ethd__servo_service(void *device, uint32_t unit, int64_t now_ns) {
  ethd__servo_device *d = device;
  double torque[2];
  (void)unit;
  ethd_status status = await(d, &now_ns);
  if (status) return status;
  pthread_mutex_lock(&d->lock);
  command(d, now_ns, torque);
  if (d->link.state == ETHD__SERVO_ENABLED && atomic_load_explicit(&d->safe, memory_order_relaxed))
    ethd__servo_link_begin(&d->link, ETHD__SERVO_DISABLE, now_ns);
  if (d->link.state == ETHD__SERVO_IDENTIFIED && d->link.sequence < 0 && atomic_exchange(&d->clear, 0))
    ethd__servo_link_begin(&d->link, ETHD__SERVO_CLEAR, now_ns);
  status = ethd__servo_turn(d, now_ns, torque);
  if (d->link.state != ETHD__SERVO_DOWN && status < 0) {
    status = ETHD_OK;   /* the link has counted it */
    d->due_ns = now_ns; /* ask again at once: where exchanges are rare, the next one would come too late */
  }
  pthread_mutex_unlock(&d->lock);
  return status;
}
