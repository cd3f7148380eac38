/* The guard's stop on a slow bus, in true time: the loop, the servo's driver and a drive whose answers take most of an
   exchange. Behind the drive a ring moves freely, worked out here, apart from the library's own device: two links
   without coupling or friction. The ring moves at 0.3 m/s when the application is gone. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "ethd/loop.h"
#include "servo/mock.h"
#include "text/text.h"
#include "unit/device_of.h"
#include "unit/rig.h"
#include "unit/suite.h"

#define LINK 0.25 /* m */
#define RATIO 9.8
#define COUNT (2 * M_PI / (4000 * RATIO)) /* rad of the joint */
#define SPEED 0.3                         /* m/s of the ring */
#define HEARTBEAT 0.15                    /* s */
#define TRIES 8                           /* of a trial that a busy machine spoils */

static const ethd_driver *const servo = &ethd_driver_servo;
static mock drive;
static char message[ETHD_MESSAGE_MAX], folder[] = "/tmp/ethd-stop-XXXXXX", *registers;

static void pause_for(double seconds) { nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL); }

/* ---- the ring ---- */

static struct {
  pthread_mutex_t lock;
  double mass, exchange; /* kg, s */
  int sign;              /* -1: the encoders are reversed */
  bool stops;            /* the application is gone */
  int64_t at, asked;     /* ns: of the state below; when the last set-points came */
  double q[2], v[2];     /* rad, m/s of the links */
  double torque[2];      /* Nm, which acts */
  double arrived;        /* m/s when the stop's first torque came, -1: none came */
  double fastest;        /* m/s from then on */
  double time;           /* s from then on until the last torque ended */
  double late;           /* s: the longest time between two set-points */
  int64_t first;         /* ns: when it came */
  bool early;            /* something else stopped it before: jitter looks like speed */
  bool dead;             /* the machine was so late that the loop disarmed before that */
} ring = {.lock = PTHREAD_MUTEX_INITIALIZER};

static double speed(void) { return hypot(ring.v[0], ring.v[1]); }

/* A constant torque acts from the state's instant to this one, so the motion is exact and its ends are fastest. */
static void move(int64_t t) {
  const double dt = 1e-9 * (double)(t - ring.at);
  for (int i = 0; i < 2; i++) {
    const double a = ring.torque[i] / LINK / ring.mass;
    ring.q[i] += (ring.v[i] + a * dt / 2) * dt / LINK;
    ring.v[i] += a * dt;
  }
  ring.at = t;
  if (ring.arrived >= 0) ring.fastest = fmax(ring.fastest, speed());
}

static void show(void) {
  static const double start[2] = {M_PI / 2, 0};
  for (int i = 0; i < 2; i++) {
    int32_t count = (int32_t)lrint((start[i] + ring.sign * (ring.q[i] - start[i])) / COUNT);
    drive.words[MOCK_POSITION1 + 2 * i] = (uint16_t)((uint32_t)count >> 16);
    drive.words[MOCK_POSITION1 + 2 * i + 1] = (uint16_t)count;
  }
}

/* What the message before this one told the drive acts since then. */
static void heed(void) {
  bool was = ring.torque[0] != 0 || ring.torque[1] != 0;
  for (int i = 0; i < 2; i++)
    ring.torque[i] = drive.words[MOCK_STATUS] & 2 ? 1e-4 * RATIO * (int16_t)drive.words[MOCK_TORQUE1 + i] : 0;
  bool is = ring.torque[0] != 0 || ring.torque[1] != 0;
  ring.early |= is && !ring.stops;
  if (is && ring.arrived < 0) ring.arrived = ring.fastest = speed(), ring.first = ring.at;
  if (was && !is) ring.time = 1e-9 * (double)(ring.at - ring.first);
}

/* A message waits in the drive for a quarter of its answer's time, is heeded, and the rest passes until the answer. */
static mock_act act(void *user, uint64_t n, int function) {
  const double answer = 0.3 * ring.exchange; /* of an exchange's two, which begin a fifth after a tick */
  (void)user, (void)n;
  pause_for(0.25 * answer);
  pthread_mutex_lock(&ring.lock);
  int64_t t = ethd__clock_now();
  heed();
  move(t);
  show();
  if (function == 16 && ring.asked) ring.late = fmax(ring.late, 1e-9 * (double)(t - ring.asked));
  if (function == 16) ring.asked = t;
  pthread_mutex_unlock(&ring.lock);
  return (mock_act){MOCK_LATE, 0, (int64_t)(0.75e6 * answer)};
}

/* ---- a trial ---- */

typedef struct trial {
  double exchange, mass;      /* s, kg */
  bool told, reversed, beats; /* the dynamics are told; the application stops beating rather than reporting itself */
  bool fast;                  /* the loop has a tick for each exchange, else one a millisecond */
} trial;

/* The plant's map without a finger, for exchanges as slow as this; answers have half a second. */
static void write_map(const trial *t) {
  char path[64], *all;
  int length =
      asprintf(&all,
               "[bus]\ntransport = tcp\nport = 127.0.0.1:1\ndivisor = %d\nconnect = 5\nresponse = 0.5\ndrain = 0.02\n"
               "[watchdog]\nkind = silence\ntime = 0.5\n%s",
               t->fast ? 1 : (int)lrint(1e3 * t->exchange), registers);
  snprintf(path, sizeof path, "%s/plant.map", folder);
  ck_assert_msg(ethd_text_write(path, all, (size_t)length, message) == ETHD_OK, "%s", message);
  free(all);
}

static ethd_setup setup_of(const trial *t) {
  ethd_setup setup = ethd_setup_default();
  setup.period = t->fast ? t->exchange : 1e-3;
  if (!t->told) return setup;
  setup.dynamics.mass[0] = setup.dynamics.mass[1] = t->mass;
  setup.dynamics.delay = t->exchange; /* the driver's figure "delay from measurement to torque" */
  return setup;
}

/* The device's limits, and time for a stop from its fastest. */
static void limit(ethd_setup *setup, const void *device) {
  ethd_limits own = servo->limits(device);
  ethd_velocity velocity;
  setup->limits = ethd_limits_narrower(&own, &setup->limits);
  ck_assert_int_eq(ethd_velocity_prepare(setup->velocity, setup->velocity_p, setup->period, &velocity, NULL), ETHD_OK);
  ethd_guard_device as = ethd_guard_device_of(&setup->arm, &setup->dynamics, setup->limits.gap, setup->period,
                                              ethd_velocity_lag(&velocity));
  setup->limits.stop_time = fmax(ETHD_STOP_TIME, ethd_guard_stop_time(&as, &setup->limits));
}

static void place(const trial *t) {
  ring.mass = t->mass;
  ring.exchange = t->exchange;
  ring.sign = t->reversed ? -1 : 1;
  ring.stops = ring.early = ring.dead = false;
  ring.at = ethd__clock_now();
  ring.asked = 0;
  ring.q[0] = M_PI / 2, ring.q[1] = 0;
  ring.v[0] = ring.v[1] = ring.torque[0] = ring.torque[1] = 0;
  ring.arrived = -1;
  ring.fastest = ring.time = ring.late = 0;
}

/* Beats for a while. */
static void live(ethd_loop *loop, double seconds) {
  for (int64_t end = ethd__clock_now() + (int64_t)(1e9 * seconds); ethd__clock_now() < end; pause_for(2e-3))
    ethd_loop_beat(loop);
}

/* Pushes the ring, which moves until the application is gone, and waits for what the guard makes of it. */
static void run(const trial *t, ethd_loop *loop, double stop_time) {
  live(loop, 4 * t->exchange + 0.05);
  pthread_mutex_lock(&ring.lock);
  ring.v[0] = 0.8 * SPEED, ring.v[1] = 0.6 * SPEED;
  pthread_mutex_unlock(&ring.lock);
  live(loop, 4 * t->exchange + 0.05);
  pthread_mutex_lock(&ring.lock);
  ring.stops = true;
  ring.dead = !ethd_loop_armed(loop);
  ring.late = 0;
  pthread_mutex_unlock(&ring.lock);
  if (!t->beats) ethd_loop_raise(loop, ETHD_FAULT_APPLICATION);
  const double most = (t->beats ? HEARTBEAT : 0) + stop_time + 4 * t->exchange + 0.02;
  for (int64_t end = ethd__clock_now() + (int64_t)(1e9 * most); ethd__clock_now() < end && ethd_loop_armed(loop);)
    pause_for(1e-3);
  pause_for(4 * t->exchange + 0.02); /* and nothing comes after it */
}

/* False: the machine was late, by the drive's own clock or so that a row says so. */
static bool stop(const trial *t, double *stop_time) {
  ethd_setup setup = setup_of(t);
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}, {"speed", "0.5", 3}};
  const ethd_device_def device_def = {&setup, settings, 3, folder, "d.ini", 0, NULL};
  ethd_loop_def def = ethd_loop_default();
  ethd_control *control;
  ethd_loop *loop;
  ethd_error error;
  void *device;
  write_map(t);
  pthread_mutex_lock(&ring.lock);
  place(t);
  pthread_mutex_unlock(&ring.lock);
  ck_assert_msg(servo->open(&device_def, &device, message) == ETHD_OK, "%s", message);
  limit(&setup, device);
  *stop_time = setup.limits.stop_time;
  ck_assert_msg(ethd_control_create(&setup, &control, &error) == ETHD_OK, "%s", error.name);
  static ethd_device of_servo;
  device_of(&of_servo, servo, device);
  def.device = &of_servo;
  def.control = control;
  def.period = setup.period;
  def.gap = setup.limits.gap;
  def.heartbeat = t->beats ? HEARTBEAT : (double)INFINITY;
  def.stack = (size_t)4 << 20; /* sanitizers keep their own things there */
  ck_assert_int_eq(ethd_loop_create(&def, &loop, NULL), ETHD_OK);
  ck_assert_msg(servo->start(device) == ETHD_OK, "%s", servo->why(device));
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  run(t, loop, *stop_time);
  bool armed = ethd_loop_armed(loop);
  ethd_loop_stats stats;
  ethd_loop_stop(loop);
  ck_assert_int_eq(ethd_loop_join(loop), ETHD_OK);
  ethd_loop_read(loop, &stats);
  ethd_loop_destroy(loop);
  servo->close(device);
  ethd_control_destroy(control);
  ck_assert(!armed);
  const bool old = stats.faults[ETHD_FAULT_FEEDBACK_OLD] || stats.faults[ETHD_FAULT_LOOP] ||
                   stats.faults[ETHD_FAULT_OVERRUNS] || stats.faults[ETHD_FAULT_CLOCK];
  return !ring.dead && !ring.early && !old && ring.late < 1.2 * t->exchange + 2e-3;
}

static void check(const trial *t, double stop_time) {
  const double times = ring.arrived < 0 ? 1 : ring.fastest / ring.arrived;
  char what[160];
  snprintf(what, sizeof what, "%g ms, %g kg, told %d, reversed %d, beats %d, fast %d", 1e3 * t->exchange, t->mass,
           t->told, t->reversed, t->beats, t->fast);
  printf("%s: %.0f ms (%.0f), %.2f times as fast, %.3f m/s left\n", what, 1e3 * ring.time, 1e3 * stop_time, times,
         speed());
  ck_assert_msg(!ring.torque[0] && !ring.torque[1] && ring.time <= stop_time + t->exchange + 2e-3, "%s: %g s of torque",
                what, ring.time);
  ck_assert_msg(times <= 1.4, "%s: %g times as fast", what, times);
  if (t->told) ck_assert_msg(ring.arrived >= 0, "%s: let go at once", what);
  if (t->told && !t->reversed) ck_assert_msg(speed() <= 0.05, "%s: let go at %g m/s", what, speed());
}

/* Notes for main, which is another process, that the machine spoilt all tries of a trial. */
static void spoil(void) {
  char path[64];
  snprintf(path, sizeof path, "%s/spoilt", folder);
  ck_assert_int_eq(ethd_text_write(path, "", 0, message), ETHD_OK);
}

TEST_LOOP(test_stop, 0, 48) {
  static const double exchanges[] = {5e-3, 10e-3, 25e-3};
  const trial t = {.exchange = exchanges[_i / 16],
                   .mass = _i & 1 ? 6 : 0.1173,
                   .told = _i & 2,
                   .reversed = _i & 4,
                   .fast = _i & 8,
                   .beats = (_i & 1) ^ (_i >> 1 & 1)};
  double stop_time;
  mock_start(&drive, 0);
  drive.act = act;
  for (int i = 0; i < TRIES; i++)
    if (stop(&t, &stop_time)) {
      mock_stop(&drive);
      check(&t, stop_time);
      return;
    }
  mock_stop(&drive);
  spoil();
}

int suite_begin(void) {
  char *text, *reading, *enable;
  size_t length;
  if (!mkdtemp(folder) || ethd_text_read("apps/config/plant.map", 1 << 16, &text, &length, message)) return 1;
  reading = strstr(text, "[register reading_x]");
  enable = strstr(text, "[enable]");
  memmove(reading, enable, strlen(enable) + 1);
  registers = strstr(text, "[register control]");
  return 0;
}

int suite_end(int failed) {
  char path[64];
  snprintf(path, sizeof path, "%s/plant.map", folder);
  unlink(path);
  snprintf(path, sizeof path, "%s/spoilt", folder);
  bool spoilt = unlink(path) == 0;
  rmdir(folder);
  if (spoilt && !failed) puts("SKIP: this machine is too busy for a drive in true time; the other trials passed");
  return failed ? failed : spoilt ? 77 : 0;
}
