/* A thread of the loop that hangs: in a law, in a law's rehearsal, in the device's read and write. The device is let
   go, the loop says where it hangs, join fails within its second, and the rest of the process goes on. Should the
   thread live again, it leaves the device alone. */
#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "clock.h"
#include "ethd/loop.h"
#include "unit/device_of.h"
#include "unit/rig.h"

enum { IN_STEP, IN_REHEARSAL, IN_READ, IN_WRITE, PLACES };

static atomic_int place, hangs, safe, safe_before, last_safe, reads, writes, releases;

/* Of all threads of this process. */
static int64_t cpu_time(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static void pause_for(long ns) { nanosleep(&(struct timespec){.tv_nsec = ns}, NULL); }

static void hang(void) {
  atomic_store(&safe_before, atomic_load(&safe));
  atomic_store(&hangs, 1);
  while (!atomic_load(&releases)) pause_for(1000000);
}

static ethd_sense sense;

static ethd_status dev_read(void *d, int64_t now_ns, ethd_sense *out) ETHD_RT {
  (void)d;
  *out = sense;
  out->time_ns = now_ns;
  if (atomic_fetch_add(&reads, 1) == 20 && place == IN_READ) hang();
  return ETHD_OK;
}

static ethd_status dev_write(void *d, int64_t now_ns, const ethd_command *command) ETHD_RT {
  (void)d, (void)now_ns;
  atomic_store(&last_safe, command->safe);
  if (atomic_fetch_add(&writes, 1) == 20 && place == IN_WRITE) hang();
  return ETHD_OK;
}

static void dev_safe(void *d) ETHD_RT { (void)d, atomic_store(&safe, 1); }
static ethd_status dev_stop(void *d) { return (void)d, ETHD_OK; }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "hangs",
                                   .brief = "hangs",
                                   .read = dev_read,
                                   .write = dev_write,
                                   .safe = dev_safe,
                                   .stop = dev_stop};

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  int wanted = place == IN_STEP || place == IN_REHEARSAL;
  if (wanted && atomic_load(&reads) == 20 && !atomic_load(&hangs)) hang();
  return ethd_tracking_pd.step(p, state, in, tau);
}

static void begin(rig *r, ethd_tracking_law *law, ethd_loop **loop, double gap) {
  motion m = rig_at(0.01, 0, 0.001);
  rig_open(r, NULL);
  double p[ETHD_PARAMS_MAX];
  memcpy(p, r->setup.tracking_p, sizeof p);
  *law = ethd_tracking_pd;
  law->step = track;
  law->law.id = "endless";
  ethd_setup_tracking(&r->setup, law);
  memcpy(r->setup.tracking_p, p, sizeof p);
  rig_start(r);
  sense = rig_sense(&r->setup.arm, &m);
  ethd_loop_def def = ethd_loop_default();
  static ethd_device of_it;
  device_of(&of_it, &driver, &sense);
  def.device = &of_it;
  def.control = r->control;
  def.gap = gap;
  def.soft_start = 0;
  if (place == IN_REHEARSAL) def.early_wake = 200e-6;
  def.stack = (size_t)4 << 20; /* sanitizers keep their own things there */
  ck_assert_int_eq(ethd_loop_create(&def, loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(*loop, NULL), ETHD_OK);
}

/* On a busy machine the loop can be late by the gap before anything hangs. The torque is zero then, the device safe, and
   no law is asked at the 20th tick: that loop is ended and another begun. */
static void begin_and_hang(rig *r, ethd_tracking_law *law, ethd_loop **loop, double gap) {
  begin(r, law, loop, gap);
  for (int tries = 1;; pause_for(1000000)) {
    bool hanging = atomic_load(&hangs);
    if (hanging && !atomic_load(&safe_before)) return;
    if (!hanging && !atomic_load(&safe) && atomic_load(&reads) < 60) continue;
    ck_assert_msg(tries++ < 50, "the machine is too busy for a gap of %g s", gap);
    atomic_store(&releases, 1);
    ethd_loop_stop(*loop);
    ck_assert_int_eq(ethd_loop_join(*loop), ETHD_OK);
    ethd_loop_destroy(*loop);
    rig_close(r);
    atomic_store(&reads, 0), atomic_store(&writes, 0), atomic_store(&hangs, 0), atomic_store(&safe, 0);
    atomic_store(&releases, 0);
    begin(r, law, loop, gap);
  }
}

/* Without any limit; only a law can be seen then, and with a gap of 5 ms. */
TEST_LOOP(test_hangs, 0, 2 * PLACES) {
  static rig r;
  static ethd_tracking_law law;
  static ethd_loop *loop;
  static ethd_loop_stats stats;
  const ethd_law *found = NULL;
  place = _i % PLACES;
  int in_law = place == IN_STEP || place == IN_REHEARSAL;
  int watched = in_law || _i >= PLACES;
  begin_and_hang(&r, &law, &loop, _i < PLACES ? (double)INFINITY : 0.005);
  int64_t from = ethd__clock_now();
  while (!ethd_loop_hangs(loop, &found)) pause_for(1000000);
  ck_assert_ptr_eq(found, in_law ? &law.law : NULL);
  ck_assert_int_eq(atomic_load(&safe), watched);
  ck_assert_int_eq(ethd_loop_armed(loop), !watched);
  ethd_loop_read(loop, &stats);
  ck_assert_uint_eq(stats.faults[ETHD_FAULT_LOOP], (unsigned)watched);
  int64_t cpu = cpu_time(), begin_ns = ethd__clock_now();
  pause_for(100000000); /* who watches takes no processor while it waits */
  ck_assert_int_lt(cpu_time() - cpu, (ethd__clock_now() - begin_ns) / 2);
  ethd_loop_stop(loop);
  ethd_status status = ethd_loop_join(loop);
  double took = 1e-9 * (double)(ethd__clock_now() - from);
  ck_assert_int_eq(status, in_law ? ETHD_E_LAW : ETHD_E_DEVICE);
  ck_assert_int_eq(ethd_loop_join(loop), status);
  ck_assert_int_eq(ethd_loop_ended(loop), 0);
  printf("%s: join gave it up %.2f s after it hung\n", found ? found->id : "device", took);
  int read_before = atomic_load(&reads), written_before = atomic_load(&writes);
  ethd_loop_destroy(loop); /* frees nothing that the thread may touch */
  atomic_store(&releases, 1);
  pause_for(50000000);
  if (in_law) {
    ck_assert_int_eq(atomic_load(&reads), read_before);
    ck_assert_int_eq(atomic_load(&writes), written_before);
  } else { /* the device is still the thread's: it lets it go and ends */
    ck_assert_int_eq(ethd_loop_ended(loop), 1);
    ck_assert_int_eq(atomic_load(&last_safe), 1);
  }
}

/* The clean end, with the thread that watches now always there, is as quick as ever. */
TEST(test_ends) {
  static rig r;
  static ethd_tracking_law law;
  static ethd_loop *loop;
  place = PLACES;
  begin(&r, &law, &loop, (double)INFINITY);
  while (atomic_load(&reads) < 20) pause_for(1000000);
  ck_assert_int_eq(ethd_loop_hangs(loop, NULL), 0);
  ethd_loop_stop(loop);
  ck_assert_int_eq(ethd_loop_join(loop), ETHD_OK);
  ck_assert_int_eq(atomic_load(&safe), 1);
  ethd_loop_destroy(loop);
  rig_close(&r);
}
