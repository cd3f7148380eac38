/* Times ticks on this machine, now: a short measurement, which is no bound. */
#include <math.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/report.h"
#include "clock.h"
#include "ethd/estimate.h"
#include "text/freed.h"

#define TICKS 20000

/* Sweeps the joints' range with the finger ahead of the ring and a frame of rays at every third tick. */
static void sense_at(const ethd_setup *setup, int k, ethd_sense *s) {
  double a = 2 * M_PI * k / 4001, b = 2 * M_PI * k / 977;
  ethd_pose pose;
  memset(s, 0, sizeof *s);
  s->time_ns = (int64_t)k * 1000000;
  s->sample_ns = s->time_ns;
  s->q[0] = M_PI / 2 + 1.2 * sin(a);
  s->q[1] = (setup->arm.mechanism == ETHD_ARM_SERIAL ? -M_PI / 2 : 0) + 1.2 * sin(b);
  ethd_arm_pose(&setup->arm, s->q, &pose);
  s->have = k == 0 ? ETHD_HAVE_START : k % 3 == 0 ? ETHD_HAVE_RAYS : 0;
  s->finger[0] = pose.x.x, s->finger[1] = pose.x.y;
  ethd_fit_rays(setup->ring_radius, setup->finger_radius, (ethd_vec){0.1 * setup->ring_radius * cos(a), 0}, s->rays);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int measure(const ethd_setup *own, double *ns) {
  ethd_setup setup = *own;
  ethd_control *control;
  ethd_sense s;
  ethd_command c;
  setup.limits = ethd_limits_none(); /* nothing stops the sweep */
  if (ethd_control_create(&setup, &control, NULL) < 0) return 0;
  for (int k = 0; k < TICKS; k++) {
    sense_at(&setup, k, &s);
    int64_t start = ethd__clock_now();
    (void)ethd_control_step(control, &s, &c, NULL);
    ns[k] = (double)(ethd__clock_now() - start);
  }
  ethd_control_destroy(control);
  return 1;
}

static bool is_realtime(void) {
  int policy = sched_getscheduler(0);
  return policy == SCHED_FIFO || policy == SCHED_RR;
}

int ethd__report_tick(const ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  ETHD__FREED double *ns = malloc(TICKS * sizeof *ns);
  printf("\ntick         rehearsed %d times all over the arm's range, on this machine, now\n", TICKS);
  if (!ns || !measure(setup, ns)) {
    printf("  no memory\n");
    return 0;
  }
  qsort(ns, TICKS, sizeof *ns, ascending);
  /* without realtime the worst case depends on the machine, not on the tick */
  double judged = 1e-9 * ns[is_realtime() ? TICKS - 1 : TICKS - 1 - TICKS / 1000];
  double most = fmin(setup->period, setup->limits.step_time);
  printf("  p50 %.2f us, p99.9 %.2f us, max %.1f us, of %s = %.4g us; %s\n", 1e-3 * ns[TICKS / 2],
         1e-3 * ns[TICKS - 1 - TICKS / 1000], 1e-3 * ns[TICKS - 1],
         most < setup->period ? "limits.step_time" : "loop.period", 1e6 * most,
         is_realtime() ? "a short measurement" : "no bound: this process isn't realtime");
  if (judged <= most) return 0;
  printf("  EXCEEDED; to change: fewer objects in the scene, a longer loop.period or limits.step_time\n");
  return 1;
}
