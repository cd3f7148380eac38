#include "screen/live.h"

#include <errno.h>
#include <math.h>
#include <sched.h>
#include <string.h>
#include <time.h>

#include "cli/cli.h"
#include "clock.h"

#define PRIORITY 10 /* of SCHED_FIFO: under a device's loop */

/* ---- the thread ---- */

static void await(int64_t instant) {
  struct timespec t = {.tv_sec = (time_t)(instant / 1000000000), .tv_nsec = (long)(instant % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL)) continue;
}

static void show(ethd__live *l) {
  const ethd__tap_rows *rows = &l->stage->rows;
  const ethd_truth *truth = &rows->truth[rows->count - 1];
  if (isnan(l->touch) && truth->pad > 0) l->touch = truth->t;
  const ethd__glimpse g = {.t = truth->t,
                           .touch = l->touch,
                           .finger = {truth->finger[0], truth->finger[1]},
                           .ring = {truth->ring[0], truth->ring[1]},
                           .state = (int32_t)rows->trace[rows->count - 1].state};
  ethd_cell_put(l->glimpse, &g);
}

static void lead(ethd__live *l, double t) {
  ethd__led led;
  if (ethd_cell_take(l->pointer, &led) == ETHD_OK)
    ethd__hand_move(&l->hand, 1e-9 * (double)(led.ns - l->began_ns), led.x);
  ethd__hand_lead(&l->hand, t);
}

/* Late ticks are made up for, because simulated time must follow the pointer. */
static void *run(void *live) {
  ethd__live *l = live;
  ethd__tapping tapping;
  int64_t period = llrint(1e9 * l->rule.period), due = l->began_ns;
  ethd__flush_denormals();
  l->status = ethd__tapping_begin(l->stage->sim, l->stage->control, &l->tap, &l->rule, &l->stage->rows, &tapping);
  while (!l->status && !atomic_load_explicit(&l->stop, memory_order_relaxed)) {
    await(due);
    l->late += ethd__clock_now() - due >= period;
    due += period;
    lead(l, (double)l->stage->rows.count * l->rule.period);
    l->status = ethd__tapping_step(&tapping);
    if (!l->status) show(l);
  }
  atomic_store_explicit(&l->over, 1, memory_order_release);
  return NULL;
}

/* ---- [main] ---- */

/* Runs before everything without realtime priority, the screen included, if the machine grants that. */
static int create(ethd__live *l, int policy) {
  pthread_attr_t attr;
  struct sched_param param = {.sched_priority = policy == SCHED_FIFO ? PRIORITY : 0};
  pthread_attr_init(&attr);
  pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attr, policy);
  pthread_attr_setschedparam(&attr, &param);
  int failure = pthread_create(&l->thread, &attr, run, l);
  pthread_attr_destroy(&attr);
  return failure;
}

static bool start(ethd__live *l) {
  int failure = create(l, SCHED_FIFO);
  return !(failure == EPERM ? create(l, SCHED_OTHER) : failure);
}

static ethd_status open_cells(ethd__live *l) {
  ethd_error error;
  ethd_status status = ethd_cell_create(sizeof(ethd__led), &l->pointer, &error);
  return status ? status : ethd_cell_create(sizeof(ethd__glimpse), &l->glimpse, &error);
}

static void release(ethd__live *l) {
  ethd_cell_destroy(l->pointer);
  ethd_cell_destroy(l->glimpse);
  ethd__hand_free(&l->hand);
}

ethd_status ethd__live_start(ethd__live *l, ethd__stage *stage, const ethd__speed *speed, uint64_t number, ethd_vec x,
                             double seconds) {
  const ethd_plant *plant = &stage->study->plant;
  memset(l, 0, sizeof *l);
  l->stage = stage;
  l->touch = NAN;
  ethd_status status = ethd__hand_create(&l->hand, x, seconds);
  if (!status) status = open_cells(l);
  if (!status) {
    ethd_sim_draw(plant, stage->study->seed, number, speed->centre, stage->study->meet, &l->tap);
    l->tap.finger_radius = plant->finger_radius;
    l->tap.commanded = speed->centre;
    l->tap.path = ethd__hand_path(&l->hand);
    l->rule = ethd__stage_rule(stage, speed, l->tap.finger_radius);
    l->began_ns = ethd__clock_now();
    l->started = start(l);
    status = l->started ? ETHD_OK : ETHD_E_MEMORY;
  }
  if (status) release(l);
  return status;
}

void ethd__live_lead(ethd__live *l, int64_t ns, ethd_vec x) {
  const ethd__led led = {ns, x};
  ethd_cell_put(l->pointer, &led);
}

bool ethd__live_look(ethd__live *l, ethd__glimpse *out) {
  (void)!ethd_cell_take(l->glimpse, out);
  return !atomic_load_explicit(&l->over, memory_order_acquire);
}

ethd_status ethd__live_join(ethd__live *l) {
  if (!l->started) return ETHD_E_ARGUMENT;
  atomic_store_explicit(&l->stop, 1, memory_order_relaxed);
  pthread_join(l->thread, NULL);
  l->started = false;
  release(l);
  return l->status < 0 ? l->status : ETHD_OK;
}
