/* Start and stop: [main] runs these sequences while the loop leaves the device alone. */
#include <time.h>

#include "clock.h"
#include "servo/device.h"
#include "text/error_text.h"

#define START_MOST 10.0 /* s beyond the steps' own times */
#define ZEROES 3        /* good exchanges with zero torque before anything is enabled */
#define PAUSE 200000    /* ns between the turns of a start */

/* Makes exchanges until the drive has identified itself. */
static ethd_status identify(ethd__servo_device *d, double seconds) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  for (int64_t begin = ethd__clock_now(), now = begin; 1e-9 * (double)(now - begin) < seconds;
       now = ethd__clock_now()) {
    if (d->link.state == ETHD__SERVO_UP && d->link.sequence < 0)
      ethd__servo_link_begin(&d->link, ETHD__SERVO_IDENTIFY, now);
    (void)!ethd__servo_turn(d, now, zero);
    if (d->link.state >= ETHD__SERVO_IDENTIFIED) return ETHD_OK;
    nanosleep(&pause, NULL);
  }
  return ETHD_E_DEVICE;
}

static double steps_time(const ethd__servo_map *map, int sequence) {
  double sum = map->connect;
  for (uint32_t i = 0; i < map->sequences[sequence].count; i++)
    if (map->sequences[sequence].at[i].kind != ETHD__SERVO_STEP_WRITE) sum += map->sequences[sequence].at[i].value;
  return sum;
}

ethd_status ethd__servo_meet(ethd__servo_device *d) {
  ethd_status status = ethd__servo_link_connect(&d->link, ethd__clock_now());
  return status ? status : identify(d, steps_time(&d->map, ETHD__SERVO_IDENTIFY));
}

/* ---- start: zero first, seen back from the drive, then the steps ---- */

static ethd_status zero_and_verify(ethd__servo_device *d, double seconds) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  int good = 0;
  for (int64_t begin = ethd__clock_now(), now = begin; good < ZEROES; now = ethd__clock_now()) {
    if (1e-9 * (double)(now - begin) > seconds || d->link.state < ETHD__SERVO_IDENTIFIED) return ETHD_E_DEVICE;
    good = ethd__servo_turn(d, now, zero) ? 0 : good + 1;
    nanosleep(&pause, NULL);
  }
  return ETHD_OK;
}

/* Runs the steps of a sequence, one in each turn, under zero torque. */
static ethd_status run(ethd__servo_device *d, int32_t sequence) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  double most = steps_time(&d->map, sequence) + 1;
  int64_t begin = ethd__clock_now();
  ethd__servo_link_begin(&d->link, sequence, begin);
  for (int64_t now = begin; d->link.sequence == sequence; now = ethd__clock_now()) {
    if (1e-9 * (double)(now - begin) > most) return ETHD_E_DEVICE;
    (void)!ethd__servo_turn(d, now, zero);
    nanosleep(&pause, NULL);
  }
  return d->link.result;
}

ethd_status ethd__servo_enable(ethd__servo_device *d) {
  if (d->unarmed) return ethd__say(d->link.message, ETHD_E_DEVICE, "%s", d->unarmed);
  atomic_store(&d->safe, 1);
  atomic_fetch_add(&d->epoch, 1); /* commands from before no longer count */
  d->link.attempt_ns = 0;
  d->link.set_point_stays = false;
  for (int i = 0; i < 2; i++) d->feedback.axes[i].since_ns = 0;
  ethd_status status = identify(d, START_MOST / 10 + steps_time(&d->map, ETHD__SERVO_IDENTIFY));
  if (status) return status;
  /* an old set-point must be gone, and must be seen to be gone, before the drive can move anything */
  status = zero_and_verify(d, 0.5);
  d->link.set_point_stays = status && d->link.echo_failed;
  if (d->link.set_point_stays) {
    d->link.rows[ETHD_FAULT_SET_POINT]++;
    return ethd__say(d->link.message, status, "%s: %s", d->map.port, ethd_fault_sentence(ETHD_FAULT_SET_POINT));
  }
  return status ? status : run(d, ETHD__SERVO_ENABLE);
}

int32_t ethd__servo_lost(const ethd__servo_device *d) {
  for (int i = 0; i < 2; i++)
    if (d->joint[i] >= 0 && !(d->feedback.axes[i].started && d->feedback.axes[i].referenced)) return d->joint[i] + 1;
  return 0;
}

static ethd_status start_locked(ethd__servo_device *d) {
  int32_t lost = ethd__servo_lost(d);
  if (lost)
    return ethd__say(
        d->link.message, ETHD_E_DEVICE,
        "the angle of joint %d is unknown: home it; or stand the arm in its jig and give device.q1, q2 (step 4)", lost);
  ethd_status status = ethd__servo_enable(d);
  if (!status) atomic_store(&d->safe, 0);
  return status;
}

ethd_status ethd__servo_start(void *device) {
  ethd__servo_device *d = device;
  pthread_mutex_lock(&d->lock);
  ethd_status status = start_locked(d);
  ethd__say(d->why, status, "%s", status ? d->link.message : "");
  pthread_mutex_unlock(&d->lock);
  return status ? ETHD_E_DEVICE : ETHD_OK;
}

void ethd__servo_clear(void *device) { atomic_store(&((ethd__servo_device *)device)->clear, 1); }

const char *ethd__servo_why(const void *device) { return ((const ethd__servo_device *)device)->why; }

/* Asks for zero torque even where the drive doesn't answer the steps. */
ethd_status ethd__servo_disable(ethd__servo_device *d) {
  atomic_store(&d->safe, 1);
  if (d->link.state < ETHD__SERVO_UP) return ETHD_OK;
  if (d->link.state > ETHD__SERVO_IDENTIFIED) d->link.state = ETHD__SERVO_IDENTIFIED;
  return run(d, ETHD__SERVO_DISABLE);
}

ethd_status ethd__servo_stop(void *device) {
  ethd__servo_device *d = device;
  pthread_mutex_lock(&d->lock);
  ethd_status status = ethd__servo_disable(d);
  pthread_mutex_unlock(&d->lock);
  return status ? ETHD_E_DEVICE : ETHD_OK;
}
