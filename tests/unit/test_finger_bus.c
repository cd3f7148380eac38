/* Light barriers and the nail's plate on the proximity ring's line: a pty, on the virtual clock. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "ethd/driver.h"
#include "finger/nail.h"
#include "finger/zones.h"
#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"
#include "unit/pty.h"
#include "unit/rig.h"

#define F 0.0075
#define DELAY 1200000                        /* ns */
#define VIRTUAL INT64_C(4000000000000000000) /* far from CLOCK_MONOTONIC: nothing waits */

static char folder[] = "/tmp/ethd-finger-XXXXXX", port_path[64], message[ETHD_MESSAGE_MAX];
static int master;
static atomic_int stop;

static void set_up(void) {
  char path[64];
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(port_path, sizeof port_path, "%s/port", folder);
  master = pty_open(port_path, path);
  ck_assert_int_ge(master, 0);
}

static void tear_down(void) {
  char path[80];
  close(master);
  unlink(port_path);
  snprintf(path, sizeof path, "%s/nail.ini", folder);
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0);
}

static ethd__ring_frame frame_at(uint32_t i, const uint16_t counts[16]) {
  ethd__ring_frame f = {.type = ETHD__FRAME_TYPE, .seq = (uint16_t)i};
  f.t_us = (uint32_t)((uint64_t)i * 1000000 / ETHD__FRAME_RATE);
  memcpy(f.counts, counts, sizeof f.counts);
  return f;
}

static void send_frame(uint32_t i, const uint16_t counts[16]) {
  ethd__ring_frame f = frame_at(i, counts);
  uint8_t wire[ETHD__FRAME_WIRE];
  ethd__frame_encode(&f, wire);
  ck_assert_int_eq(write(master, wire, sizeof wire), sizeof wire);
}

static void *send_frames(void *unused) {
  static const uint16_t dark[16] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  struct timespec pause = {.tv_nsec = 2000000};
  for (uint32_t i = 0; !atomic_load(&stop); i++, nanosleep(&pause, NULL)) send_frame(i, dark);
  return unused;
}

static ethd_status open_driver(const ethd_driver *driver, const ethd_setting *settings, uint32_t count, void **device) {
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, folder, "x.ini", 1, NULL};
  pthread_t thread;
  atomic_store(&stop, 0);
  message[0] = 0;
  ck_assert_int_eq(pthread_create(&thread, NULL, send_frames, NULL), 0);
  ethd_status status = driver->open(&def, device, message);
  if (status && *device) driver->close(*device), *device = NULL;
  atomic_store(&stop, 1);
  pthread_join(thread, NULL);
  return status;
}

static int64_t arrival(uint32_t i) { return VIRTUAL + (int64_t)((uint64_t)i * 1000000000 / ETHD__FRAME_RATE) + DELAY; }

/* Serves until the frame is through, then reads. */
static ethd_sense pass(const ethd_driver *driver, void *device, uint32_t i, const uint16_t counts[16]) {
  struct timespec pause = {.tv_nsec = 50000};
  int64_t now = arrival(i);
  ethd_sense s = {0};
  ethd_figure before[4], after[4];
  driver->figures(device, before, 4);
  send_frame(i, counts);
  for (int k = 0; k < 20000; k++, nanosleep(&pause, NULL)) {
    ck_assert_int_ge(driver->service(device, 0, now), 0);
    driver->figures(device, after, 4);
    if (after[0].value + after[2].value > before[0].value + before[2].value) break;
  }
  ck_assert_int_eq(driver->read(device, now, &s), ETHD_OK);
  return s;
}

/* Frames that wait when it starts are dropped: nobody knows when they came. The one that comes then is the first reading.
 */
static void settle(const ethd_driver *driver, void *device, const uint16_t counts[16]) {
  struct timespec pause = {.tv_nsec = 50000000};
  ethd_figure figures[4];
  for (uint32_t i = 0; i < 20; i++) send_frame(i, counts);
  nanosleep(&pause, NULL);
  for (int k = 0; k < 3; k++, nanosleep(&pause, NULL))
    ck_assert_int_eq(driver->service(device, 0, arrival(29998)), ETHD_OK);
  ck_assert_uint_eq(driver->figures(device, figures, 4), 4);
  ck_assert(figures[0].value == 0 && figures[1].value == 0 && figures[2].value == 0);
  ck_assert_int_eq(pass(driver, device, 29999, counts).faults, 0);
}

TEST(test_zones) {
  const ethd_setting settings[] = {{"port", "port", 2}, {"patience", "30", 3}, {"zones", "12", 4}};
  const ethd_driver *driver = &ethd_driver_zones;
  uint16_t counts[16] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  ethd__zones z;
  void *device;
  ck_assert_msg(open_driver(driver, settings, 3, &device) == ETHD_OK, "%s", message);
  settle(driver, device, counts);
  ethd__zones_prepare(12, 3.5e-3, 0.012, F, 1e-4, &z);
  for (uint32_t i = 30000; i < 30060; i++) {
    ethd_vec finger = {2.5e-3 * cos(0.2 * i), 2.5e-3 * sin(0.2 * i)};
    for (uint32_t k = 0; k < 12; k++) counts[k] = ethd__zones_distance(&z, F, finger, k) <= 3.5e-3 ? 40000 : 300;
    ethd_sense s = pass(driver, device, i, counts);
    ck_assert_int_eq(s.have, ETHD_HAVE_CENTRE);
    ck_assert_double_lt(hypot(s.centre[0] - finger.x, s.centre[1] - finger.y), 3 * s.finger_noise);
    ck_assert_int_le(llabs(s.sample_ns - (arrival(i) - DELAY)), 2000); /* its clock counts us */
    ck_assert_int_eq(s.faults, 0);
  }
  /* two barriers that no finger lights together: refused, and a failing sensor from the fifth on */
  for (uint32_t i = 30060; i < 30070; i++) {
    for (int k = 0; k < 16; k++) counts[k] = k == 0 || k == 6 ? 40000 : 300;
    ethd_sense s = pass(driver, device, i, counts);
    ck_assert_int_eq(s.have, 0);
    ck_assert_int_eq(s.faults & ETHD_FAULT_BIT(ETHD_FAULT_SENSOR), i < 30064 ? 0 : ETHD_FAULT_BIT(ETHD_FAULT_SENSOR));
  }
  counts[3] = ETHD__FRAME_MISSING; /* a barrier that doesn't answer */
  ck_assert_int_eq(pass(driver, device, 30070, counts).have, 0);
  driver->close(device);
}

TEST(test_nail) {
  const ethd_setting settings[] = {{"port", "port", 2},
                                   {"patience", "30", 3},
                                   {"calibration", "nail.ini", 4},
                                   {"sensor", "5", 5},
                                   {"angle", "0", 6}};
  const ethd_driver *driver = &ethd_driver_nail;
  uint16_t counts[16] = {0};
  ethd__calibration truth = ethd__calibration_default();
  char path[80];
  void *device;
  truth.level = ETHD__LEVEL_COMMON;
  for (int k = 0; k < 16; k++) truth.sensors[k].dark = 200;
  snprintf(path, sizeof path, "%s/nail.ini", folder);
  ck_assert_msg(ethd__calibration_save(&truth, path, message) == ETHD_OK, "%s", message);
  ck_assert_msg(open_driver(driver, settings, 5, &device) == ETHD_OK, "%s", message);
  ck_assert_ptr_nonnull(driver->remark(device, 0));
  settle(driver, device, counts);
  for (uint32_t i = 30000; i < 30040; i++) {
    double x = 3e-3 * cos(0.3 * i);
    counts[5] = (uint16_t)rint(ethd__sensor_counts(&truth.sensors[5], 5e-3 - x));
    ethd_sense s = pass(driver, device, i, counts);
    ck_assert_int_eq(s.have, ETHD_HAVE_CENTRE);
    ck_assert_double_eq_tol(s.centre[0], x, 2 * s.finger_noise);
    ck_assert_double_eq_tol(s.centre[1], 0, 1e-15);
    ck_assert_double_ge(s.finger_noise, 0.02e-3);
    ck_assert_double_lt(s.finger_noise, 0.1e-3);
  }
  counts[5] = 201; /* far beyond its range: no plate */
  ck_assert_int_eq(pass(driver, device, 30040, counts).have, 0);
  driver->close(device);
}

TEST(test_refused) {
  static const struct {
    const ethd_driver *driver;
    const char *key, *value, *says;
  } rows[] = {
      {&ethd_driver_zones, NULL, NULL, "x.ini: device.port is missing: the barriers' serial port"},
      {&ethd_driver_zones, "zones", "7", "x.ini:3: device.zones: found \"7\", a whole number from 8 to 16 is allowed"},
      {&ethd_driver_zones, "zones", "8.5",
       "x.ini:3: device.zones: found \"8.5\", a whole number from 8 to 16 is allowed"},
      {&ethd_driver_zones, "port", "nowhere", "nowhere: No such file"},
      {&ethd_driver_nail, NULL, NULL, "x.ini: device.port is missing: the sensor's serial port"},
      {&ethd_driver_nail, "angle", "0", "x.ini: device.calibration is missing"},
      {&ethd_driver_nail, "calibration", "nowhere.ini", "nowhere.ini: No such file"},
  };
  void *device;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const ethd_setting settings[] = {{"port", "port", 2}, {rows[i].key, rows[i].value, 3}};
    ck_assert_int_lt(open_driver(rows[i].driver, settings, rows[i].key ? 2 : 0, &device), 0);
    ck_assert_msg(strstr(message, rows[i].says) != NULL, "%s", message);
    ck_assert_ptr_null(device);
  }
}

FIXTURE(set_up, tear_down)
