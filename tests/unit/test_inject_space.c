/* Faults injected around a device in space: late, missing and wrong samples, commands that are dropped or changed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "inject/script.h"
#include "unit/mover_driver.h"
#include "unit/suite.h"

#define MS 1000000
#define BEGIN (7 * (int64_t)MS) /* instant of the first sample */

static ethd_device *device;
static const ethd_driver *only[] = {&mover_driver, NULL};
static char message[ETHD_MESSAGE_MAX];
static ethd_space_sense s;

static ethd_status open_script(const char *text) {
  char name[] = "/tmp/ethd-inject-XXXXXX";
  FILE *f = fdopen(mkstemp(name), "w");
  fputs(text, f);
  fclose(f);
  const ethd_space_setup setup = ethd_space_setup_default();
  const ethd_setting settings[] = {{"inject", name, 3}};
  const ethd_device_def def = {.settings = settings, .setting_count = 1, .file = "c.ini", .space = &setup};
  const ethd_status status = ethd_device_open("mover", only, &def, &device, message);
  unlink(name);
  return status;
}

static void begin(const char *text) {
  ck_assert_msg(open_script(text) == ETHD_OK, "%s", message);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
}

/* The sample `ms` after the first one, after a command of 1 m/s along x. */
static ethd_status sample(int ms) {
  const ethd_space_command c = {.value = {1, 0, 0}, .kind = ETHD_SPACE_VELOCITY};
  memset(&s, 0, sizeof s);
  const ethd_status status = ethd_device_read_space(device, BEGIN + ms * (int64_t)MS, &s);
  (void)!ethd_device_write_space(device, BEGIN + ms * (int64_t)MS, &c);
  return status;
}

TEST(test_wrong_samples) {
  begin("2t x2 offset by=0.5\n"
        "3t v3 nan\n"
        "4t finger value by=0.25\n"
        "5t x1 freeze for=0.003\n"
        "8t time offset by=-0.001\n");
  for (int k = 0; k < 10; k++) {
    ck_assert_int_eq(sample(k), ETHD_OK);
    ck_assert_double_eq_tol(s.x[0], 1e-3 * (k == 6 || k == 7 ? 5 : k), 1e-15);
    ck_assert(s.x[1] == (k == 2 ? 0.5 : 0) && isnan(s.v[2]) == (k == 3));
    for (int i = 0; i < 3; i++) ck_assert(s.finger[i] == (k == 4 ? 0.25 : 0));
    ck_assert_int_eq(s.time_ns, BEGIN + (k == 8 ? 7 : k) * (int64_t)MS);
  }
  ethd_device_close(device);
}

/* A finger that is dropped, is late by 2 ms, stands still. */
static ethd_vec3 finger_at(int ms) { return (ethd_vec3){0.1 * ms, 0, 0}; }
static int now_ms;
static ethd_status read_moving(void *d, int64_t now, ethd_space_sense *out) ETHD_RT {
  const ethd_status status = mover_driver.read_space(d, now, out);
  ethd_vec3_put(finger_at(now_ms), out->finger);
  out->have |= ETHD_SPACE_HAVE_READING;
  out->sample_ns = now;
  ethd_vec3_put(finger_at(2 * now_ms), out->reading);
  return status;
}

TEST(test_late_and_missing_readings) {
  static ethd_driver moving;
  moving = mover_driver;
  moving.read_space = read_moving;
  only[0] = &moving;
  begin("2t reading drop\n"
        "4t reading delay by=0.002\n"
        "5t reading drop for=0.002\n"
        "9t reading freeze for=0.002\n"
        "12t centre1 offset by=9\n");
  const int64_t both = ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_READING;
  for (now_ms = 0; now_ms < 14; now_ms++) {
    ck_assert_int_eq(sample(now_ms), ETHD_OK);
    const bool stands = now_ms == 9 || now_ms == 10, late = now_ms == 6;
    const int shown = stands ? 8 : late ? 4 : now_ms;
    ck_assert_int_eq(s.have & both, now_ms == 2 || now_ms == 4 || now_ms == 5 ? 0 : both);
    if (!(s.have & both)) continue;
    ck_assert_double_eq(s.finger[0], finger_at(shown).x);
    ck_assert_double_eq(s.reading[0], finger_at(2 * shown).x + (now_ms == 12 ? 9 : 0));
    ck_assert_int_eq(s.sample_ns, BEGIN + (late ? 4 : now_ms) * (int64_t)MS); /* one that stands still says it is new */
  }
  ethd_device_close(device);
  only[0] = &mover_driver;
}

TEST(test_calls) {
  begin("2t read stale\n3t read fail\n4t fault5 grave\n");
  for (int k = 0; k < 6; k++) {
    ck_assert_int_eq(sample(k), k == 2 ? ETHD_STATUS_STALE : k == 3 ? ETHD_E_DEVICE : ETHD_OK);
    ck_assert(s.faults == (k == 4 ? 1 << 5 : 0) && s.grave == s.faults);
  }
  ethd_device_close(device);
  ck_assert_int_eq(open_script("0 start fail for=inf\n"), ETHD_OK);
  ck_assert_int_eq(ethd_device_start(device), ETHD_E_DEVICE);
  ethd_device_close(device);
}

/* The effector moves 1 mm for each command that arrives. */
TEST(test_commands) {
  begin("2t write drop\n4t write scale by=0.5\n6t write delay by=0.004 for=0.002\n");
  double x = 0;
  for (int k = 0; k < 10; k++) {
    ck_assert_int_eq(sample(k), ETHD_OK);
    ck_assert_double_eq_tol(s.x[0], x, 1e-15);
    x += k == 2 ? 0 : k == 4 ? 0.5e-3 : 1e-3; /* also the command of 4 ms ago was 1 m/s */
  }
  ethd_device_close(device);
  begin("0t write delay by=0.5 for=inf\n"); /* nothing has been commanded yet */
  for (int k = 0; k < 3; k++) ck_assert_int_eq(sample(k), ETHD_OK);
  ck_assert(s.x[0] == 0);
  ethd_device_close(device);
}

TEST_LOOP(test_refused_words, 0, 4) {
  static const char *const words[] = {"q1", "dq", "ring2", "rays"};
  char text[32], found[64];
  snprintf(text, sizeof text, "1 %s nan\n", words[_i]);
  snprintf(found, sizeof found, ":1: found \"%s\"; channels in space are x1 x2 x3 v1 ", words[_i]);
  ck_assert_int_eq(open_script(text), ETHD_E_UNKNOWN);
  ck_assert_msg(strstr(message, found) != NULL, "%s", message);
}

/* The words of space mean nothing in the plane. */
TEST(test_refused_in_the_plane) {
  ethd__script script;
  ck_assert_int_eq(ethd__script_parse("1 x1 nan\n", 9, "s", (ethd__script_of){1e-3, false}, &script, message),
                   ETHD_E_UNKNOWN);
  ck_assert_msg(strstr(message, "s:1: found \"x1\"; channels are q1 q2 ") != NULL, "%s", message);
}
