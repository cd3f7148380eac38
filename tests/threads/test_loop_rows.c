/* Rows of the fault table in true time, with threads. What is asserted is what follows upon what; times are printed.

     3   the loop's thread dies, at 20 moments in each of three places. The thread that watches over it lets the
         device go; the loop, should it live again, is told, and stays at zero torque
     35  the machine is suspended, as far as its clocks show

   A busy machine's loop may be late by as much as a dead one's: then the trial is void, and is repeated with twice
   the period. */
#include <dlfcn.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "ethd/loop.h"
#include "unit/device_of.h"
#include "unit/draw.h"
#include "unit/rig.h"
#include "unit/suite.h"

#define TRIALS 20
#define PERIOD 1e-3 /* s */
#define GAP 5       /* periods */
#define WIDER 5     /* times that the period is doubled */
#define AFTER 10    /* ticks that are looked at once it lives again */

/* ---- clocks, as a machine that was suspended has them ---- */

static int (*true_clock)(clockid_t id, struct timespec *out);
static _Atomic time_t suspended; /* s */

int clock_gettime(clockid_t id, struct timespec *out) {
  int failure = true_clock ? true_clock(id, out) : (int)syscall(SYS_clock_gettime, id, out);
  if (id == CLOCK_BOOTTIME) out->tv_sec += atomic_load(&suspended);
  return failure;
}

static void pause_for(long ns) { nanosleep(&(struct timespec){.tv_nsec = ns}, NULL); }

/* ---- a device whose thread dies, and lives again 2 ms after it was let go ---- */

enum { IN_READ, IN_LAW, IN_WRITE, PLACES, NOWHERE };

static struct {
  int place, tick; /* of the death */
  ethd_sense sense;
  atomic_int reads, dead, lived;
  _Atomic int64_t died, let_go; /* ns; 0: not yet */
  atomic_int safe;              /* 1: let go; no torque acts until it is started anew */
  double written[2];
  double before; /* Nm, of joint 1 when the thread died */
  int alone;     /* 1: nobody let the device go meanwhile */
} d;

static double torque(int joint) { return atomic_load(&d.safe) ? 0 : d.written[joint]; }

static void pass(int place) {
  if (place != d.place || atomic_load(&d.reads) != d.tick || atomic_load(&d.dead)) return;
  d.before = torque(0);
  if (d.before == 0) return;
  atomic_store(&d.died, ethd__clock_now());
  atomic_store(&d.dead, 1);
  for (int i = 0; !atomic_load(&d.let_go) && i < 20000; i++) pause_for(100000);
  d.alone = !atomic_load(&d.let_go);
  pause_for(2000000);
  atomic_store(&d.lived, 1);
}

static ethd_status dev_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  (void)device;
  *out = d.sense;
  out->time_ns = now_ns;
  atomic_fetch_add(&d.reads, 1);
  pass(IN_READ);
  return ETHD_OK;
}

static ethd_status dev_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  (void)device, (void)now_ns;
  pass(IN_WRITE);
  memcpy(d.written, command->torque, sizeof d.written);
  return ETHD_OK;
}

static void dev_safe(void *device) ETHD_RT {
  (void)device;
  atomic_store(&d.safe, 1);
  if (!atomic_load(&d.let_go)) atomic_store(&d.let_go, ethd__clock_now());
}

static ethd_status dev_stop(void *device) { return (void)device, ETHD_OK; }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "dies",
                                   .brief = "dies",
                                   .read = dev_read,
                                   .write = dev_write,
                                   .safe = dev_safe,
                                   .stop = dev_stop};

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  pass(IN_LAW);
  return ethd_tracking_pd.step(p, state, in, tau);
}

/* ---- one trial ---- */

static rig r;
static ethd_tracking_law law;
static ethd_loop *loop;

/* The finger 1 mm ahead: a torque that isn't 0. */
static void begin(int place, int tick, double period, double gap) {
  double p[ETHD_PARAMS_MAX];
  motion m = rig_at(0.01, 0, 0.001);
  rig_open(&r, NULL);
  r.setup.period = period;
  law = ethd_tracking_pd;
  law.step = track;
  memcpy(p, r.setup.tracking_p, sizeof p);
  ethd_setup_tracking(&r.setup, &law);
  memcpy(r.setup.tracking_p, p, sizeof p);
  rig_start(&r);
  memset(&d, 0, sizeof d);
  d.sense = rig_sense(&r.setup.arm, &m);
  d.place = place;
  d.tick = tick;
  ethd_loop_def def = ethd_loop_default();
  static ethd_device of_it;
  device_of(&of_it, &driver, &d);
  def.device = &of_it;
  def.control = r.control;
  def.period = period;
  def.gap = gap;
  def.soft_start = 0;
  def.stack = (size_t)4 << 20; /* sanitizers keep their own things there */
  ck_assert_int_eq(ethd_loop_create(&def, &loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
}

/* Whether the row was seen; *last: the loop's last row. */
static int finish(ethd_fault row, ethd_loop_row *last) {
  int64_t seen = 0;
  ethd_loop_stop(loop);
  ck_assert_int_eq(ethd_loop_join(loop), ETHD_OK);
  while (ethd_loop_take(loop, last) == ETHD_OK) seen |= last->trace.sense.faults | last->trace.sense.grave;
  ethd_loop_destroy(loop);
  rig_close(&r);
  return (seen & ETHD_FAULT_BIT(row)) != 0;
}

static void stays_at_zero(int ticks) {
  for (int last = atomic_load(&d.reads) + ticks; atomic_load(&d.reads) < last; pause_for(200000))
    ck_assert(torque(0) == 0 && torque(1) == 0);
  ck_assert_int_eq(ethd_loop_armed(loop), 0);
}

static void expect_zero(const ethd_loop_row *row) {
  ck_assert(row->trace.fault != 0 && !row->armed && row->trace.tau[0] == 0 && row->trace.tau[1] == 0 &&
            torque(0) == 0 && torque(1) == 0);
}

/* ms from its death until the device was let go; NAN: void. */
static double die(int place, int tick, double period) {
  ethd_loop_row row = {.armed = 1};
  begin(place, tick, period, GAP * period);
  while (!atomic_load(&d.lived) && (ethd_loop_armed(loop) || atomic_load(&d.dead))) pause_for(200000);
  int died = atomic_load(&d.dead);
  if (died) stays_at_zero(AFTER);
  int seen = finish(ETHD_FAULT_LOOP, &row);
  if (!died) return (double)NAN;
  ck_assert(seen && !d.alone);
  expect_zero(&row);
  ck_assert(row.trace.fault == ETHD_FAULT_LOOP || row.trace.fault == ETHD_FAULT_OVERRUNS); /* late before */
  return 1e-6 * (double)(atomic_load(&d.let_go) - atomic_load(&d.died));
}

/* ---- the table ---- */

static void print(ethd_fault row, const char *when, const char *reaction, const char *how) {
  printf("%3d  %-62s %-20s %8s  %-7s good\n     | %s\n", row, ethd_fault_sentence(row), ethd_fault_bound(row), when,
         reaction, how);
}

static const char *const places[] = {"in the device's read", "in a law", "in the device's write"};

TEST_LOOP(test_dead, 0, PLACES) {
  double worst = 0;
  int done = 0, wider = 0;
  char how[120], when[20] = "-";
  for (int trial = 0; trial < TRIALS; trial++) {
    int tick = 10 + (int)(draw_bits((uint64_t)(_i * TRIALS + trial)) % 60), k = 0;
    double ms = (double)NAN;
    for (; k <= WIDER && isnan(ms); k++) ms = die(_i, tick, PERIOD * (1 << k));
    done += !isnan(ms);
    wider += k > 1;
    if (k == 1) worst = fmax(worst, ms);
  }
  snprintf(how, sizeof how, "it dies %s; %d trials, %d with a longer period", places[_i], done, wider);
  if (wider < TRIALS) snprintf(when, sizeof when, "%.2f ms", worst);
  print(ETHD_FAULT_LOOP, when, "zero", how);
  ck_assert_int_gt(done, 0);
}

/* By a second, where half a second is allowed; false: void. The ring is at rest. */
static int suspend(double period) {
  ethd_loop_row row = {.armed = 1};
  begin(NOWHERE, 0, period, 0.5);
  while (atomic_load(&d.reads) < 20) pause_for(200000);
  int armed = ethd_loop_armed(loop);
  atomic_fetch_add(&suspended, 1);
  for (int last = atomic_load(&d.reads) + 3; atomic_load(&d.reads) < last;) pause_for(200000);
  stays_at_zero(AFTER);
  ck_assert_int_eq(finish(ETHD_FAULT_CLOCK, &row), 1);
  expect_zero(&row);
  return armed;
}

TEST(test_suspended) {
  int k = 0;
  while (k <= WIDER && !suspend(PERIOD * (1 << k))) k++;
  print(ETHD_FAULT_CLOCK, "-", "stop", "the clock that counts a suspension goes on by a second");
  ck_assert_int_le(k, WIDER);
}

int suite_begin(void) {
  void *found = dlsym(RTLD_NEXT, "clock_gettime");
  memcpy(&true_clock, &found, sizeof found);
  return setvbuf(stdout, NULL, _IOLBF, 0);
}
