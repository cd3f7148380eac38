/* Scripts of what a device does wrong: what a line may say, and what it does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "inject/inject.h"
#include "rig.h"
#include "unit/device_of.h"
#include "unit/suite.h"

#define MS 1000000

/* ---- a device whose numbers are its time ---- */

typedef struct plain {
  int64_t now;
  int reads, writes, safes, services;
  ethd_command last;
  ethd_status says;
  bool has_more; /* speeds, a finger and its centre */
  bool is_world; /* the readings are positions in R_0, with their noise */
} plain;

static plain p;

static ethd_status plain_open(const ethd_device_def *def, void **device, char *message) {
  (void)message;
  ck_assert_uint_eq(def->setting_count, 0);
  p = (plain){.says = ETHD_OK};
  *device = &p;
  return ETHD_OK;
}

/* q = t, 2 t; a reading in every third sample, the ray k being k + t. */
static ethd_status plain_read(void *d, int64_t now, ethd_sense *out) {
  (void)d;
  double t = 1e-9 * (double)now;
  p.now = now;
  if (p.reads++ % 3 == 0) {
    out->have = ETHD_HAVE_RAYS | ETHD_HAVE_RING;
    out->sample_ns = now;
    for (int k = 0; k < ETHD_RAYS; k++) out->rays[k] = k + t;
    out->ring[0] = 100 + t;
  }
  if (p.has_more) {
    out->have |= ETHD_HAVE_DQ | ETHD_HAVE_FINGER | ETHD_HAVE_CENTRE | ETHD_HAVE_RING;
    out->dq[0] = 10 + t, out->dq[1] = 20 + t;
    out->finger[0] = 30 + t, out->finger[1] = 40 + t;
    out->centre[0] = 50 + t, out->centre[1] = 60 + t;
    out->ring[0] = 70 + t, out->ring[1] = 80 + t;
    out->sample_ns = now;
  }
  if (p.is_world && out->have) {
    out->have = ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD;
    out->centre[0] = 50 + t;
    out->finger_noise = 1 + t;
  }
  out->time_ns = now;
  out->q[0] = t;
  out->q[1] = 2 * t;
  return p.says;
}
static ethd_status plain_write(void *d, int64_t now, const ethd_command *c) {
  return (void)d, (void)now, p.last = *c, p.writes++, ETHD_OK;
}
static uint32_t plain_units(const void *d) { return (void)d, 1; }
static ethd_status plain_service(void *d, uint32_t unit, int64_t now) {
  return (void)d, (void)unit, (void)now, p.services++, ETHD_OK;
}
static void plain_safe(void *d) { (void)d, p.safes++; }
static ethd_status plain_stop(void *d) { return (void)d, ETHD_OK; }
static void plain_close(void *d) { (void)d; }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "plain",
                                   .brief = "plain",
                                   .open = plain_open,
                                   .read = plain_read,
                                   .write = plain_write,
                                   .units = plain_units,
                                   .service = plain_service,
                                   .safe = plain_safe,
                                   .stop = plain_stop,
                                   .close = plain_close};
static const ethd_driver *const only[] = {&driver, NULL};

/* ---- with a script around it ---- */

typedef struct spoilt {
  ethd_device *device;
  int64_t now;
  ethd_sense s;
  ethd_status status;
} spoilt;

static spoilt open_script(const char *text) {
  char name[] = "/tmp/ethd-inject-XXXXXX", message[ETHD_MESSAGE_MAX] = "";
  FILE *f = fdopen(mkstemp(name), "w");
  fputs(text, f);
  fclose(f);
  ethd_setup setup = ethd_setup_default();
  const ethd_setting settings[] = {{"inject", name, 3}};
  const ethd_device_def def = {&setup, settings, 1, NULL, "c.ini", 1, NULL};
  spoilt x = {.now = 41 * (int64_t)MS};
  ck_assert_msg(!ethd_device_open("plain", only, &def, &x.device, message), "%s", message);
  ck_assert_int_eq(ethd_device_start(x.device), ETHD_OK);
  unlink(name);
  return x;
}

/* One sample, a period later than the last; t is told in ms since the first. */
static const ethd_sense *sample(spoilt *x) {
  memset(&x->s, 0, sizeof x->s);
  x->status = ethd_device_read(x->device, x->now, &x->s);
  x->now += MS;
  return &x->s;
}

static double at(double ms) { return 1e-3 * (41 + ms); }

static void close_script(spoilt *x) { ethd_device_close(x->device); }

TEST(test_values) {
  spoilt x = open_script("0.002 q1 freeze for=0.003\n"
                         "3t q2 offset by=0.5 # one sample\n"
                         "0.006 q reverse for=0.002\n"
                         "9t q1 nan\n0.010 q2 scale by=-2\n0.011 q1 value by=7\n"
                         "0.012 time offset by=0.1\n");
  for (int ms = 0; ms < 14; ms++) {
    const ethd_sense *s = sample(&x);
    double q1 = ms >= 2 && ms < 5 ? at(2) : ms == 7 ? 2 * at(6) - at(7) : ms == 11 ? 7 : at(ms);
    double q2 = ms == 3 ? 2 * at(3) + 0.5 : ms == 7 ? 4 * at(6) - 2 * at(7) : ms == 10 ? -4 * at(10) : 2 * at(ms);
    if (ms == 9)
      ck_assert(isnan(s->q[0]));
    else
      ck_assert_double_eq_tol(s->q[0], q1, 1e-12);
    ck_assert_double_eq_tol(s->q[1], q2, 1e-12);
    ck_assert_int_eq(s->time_ns, (41 + ms) * (int64_t)MS + (ms == 12 ? 100 * MS : 0));
    ck_assert_int_eq((s->have & ETHD_HAVE_RAYS) != 0, ms % 3 == 0);
  }
  ethd_figure f[2];
  ck_assert_uint_eq(ethd_device_figures(x.device, f, 2), 1);
  ck_assert_double_eq(f[0].value, 3 + 1 + 2 + 1 + 1 + 1 + 1);
  close_script(&x);
}

/* Each channel's own numbers and no others; a channel that the sample hasn't got stays as it is. */
TEST(test_channels) {
  spoilt x = open_script("0 dq1 offset by=1 for=0.002\n0 finger2 value by=7 for=0.002\n0 centre nan for=0.002\n"
                         "0 ring1 scale by=2 for=0.002\n0 time freeze for=0.002\n");
  p.has_more = true;
  for (int ms = 0; ms < 3; ms++) {
    const ethd_sense *s = sample(&x);
    bool bad = ms < 2;
    ck_assert_double_eq_tol(s->dq[0], 10 + at(ms) + bad, 1e-12);
    ck_assert_double_eq_tol(s->dq[1], 20 + at(ms), 1e-12);
    ck_assert_double_eq_tol(s->finger[0], 30 + at(ms), 1e-12);
    ck_assert_double_eq_tol(s->finger[1], bad ? 7 : 40 + at(ms), 1e-12);
    ck_assert_int_eq(isnan(s->centre[0]) && isnan(s->centre[1]), bad);
    ck_assert_double_eq_tol(s->ring[0], (1 + bad) * (70 + at(ms)), 1e-12);
    ck_assert_int_eq(s->time_ns, (41 + (bad ? 0 : ms)) * (int64_t)MS);
  }
  close_script(&x);
  x = open_script("0 dq offset by=1 for=inf\n0 finger nan for=inf\n0 centre nan for=inf\n");
  const ethd_sense *s = sample(&x);
  ck_assert(s->dq[0] == 0 && s->finger[0] == 0 && s->centre[0] == 0);
  ethd_figure f;
  ck_assert_uint_eq(ethd_device_figures(x.device, &f, 1), 1);
  ck_assert_double_eq(f.value, 0);
  close_script(&x);
}

/* What isn't spoilt is the device's own: its limits, units, end and remarks, after one that says what this is. */
TEST(test_passes_on) {
  spoilt x = open_script("1 q1 nan\n");
  ck_assert_str_eq(ethd_device_remark(x.device, 0), "faults are injected: don't trust this run");
  ck_assert_ptr_null(ethd_device_remark(x.device, 1));
  ck_assert_uint_eq(ethd_device_units(x.device), 1);
  ck_assert(isinf(ethd_device_limits(x.device).torque));
  ck_assert(isnan(ethd_device_dynamics(x.device).mass[0]) || ethd_device_dynamics(x.device).mass[0] == 0);
  ck_assert_str_eq(ethd_device_why(x.device), "");
  ethd_device_clear(x.device);
  ck_assert_int_eq(ethd_device_home(x.device, NULL), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_device_stop(x.device), ETHD_OK);
  close_script(&x);
}

TEST(test_noise) {
  spoilt x = open_script("0 q1 noise by=0.1 for=inf\n");
  double least = 1, most = -1;
  for (int ms = 0; ms < 1000; ms++) {
    double e = sample(&x)->q[0] - at(ms);
    least = fmin(least, e);
    most = fmax(most, e);
  }
  ck_assert(least >= -0.1 - 1e-12 && least < -0.099 && most <= 0.1 + 1e-12 && most > 0.099);
  close_script(&x);
}

TEST(test_readings) {
  spoilt x = open_script("0 ray5 nan for=0.004\n"
                         "0.006 reading drop\n"
                         "0.009 reading delay by=0.004 for=0.001\n"
                         "0.015 reading freeze for=0.004\n"
                         "0.021 rays value by=0.01\n");
  for (int ms = 0; ms < 24; ms++) {
    const ethd_sense *s = sample(&x);
    int have = (s->have & ETHD_HAVE_RAYS) != 0;
    int expected = ms == 13 || (ms % 3 == 0 && ms != 6 && ms != 9);
    ck_assert_msg(have == expected, "%d ms", ms);
    if (!have) continue;
    double sampled = ms == 13 ? 9 : ms, content = ms == 15 || ms == 18 ? 9 : sampled;
    ck_assert_int_eq(s->sample_ns, (41 + (int64_t)sampled) * MS);
    if (ms <= 3) ck_assert(isnan(s->rays[4]));
    if (ms == 21)
      ck_assert(s->rays[0] == 0.01 && s->rays[15] == 0.01);
    else
      ck_assert_double_eq_tol(s->rays[7], 7 + at(content), 1e-12);
  }
  close_script(&x);
}

/* A reading in R_0 stays one, and keeps its noise, whether it passes or comes late. */
TEST(test_world) {
  spoilt x = open_script("0.003 reading delay by=0.002\n0.006 reading freeze\n");
  p.is_world = true;
  for (int ms = 0; ms < 10; ms++) {
    const ethd_sense *s = sample(&x);
    if (ms != 5 && (ms % 3 != 0 || ms == 3)) {
      ck_assert(!(s->have & (ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD)));
      continue;
    }
    ck_assert_int_eq(s->have, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
    double content = ms == 5 || ms == 6 ? 3 : ms;
    ck_assert_double_eq_tol(s->centre[0], 50 + at(content), 1e-12);
    ck_assert_double_eq_tol(s->finger_noise, 1 + at(content), 1e-12);
  }
  close_script(&x);
}

TEST(test_calls) {
  spoilt x = open_script("2t read fail\n4t read stale for=0.002\n"
                         "0.001 write fail\n0.002 write drop\n0.003 write scale by=0.5\n"
                         "0.005 write delay by=0.002 for=0.002\n"
                         "0.002 service fail\n0.003 service drop\n");
  for (int ms = 0; ms < 8; ms++) {
    int64_t now = x.now;
    ck_assert_int_eq(ethd_device_service(x.device, 0, now), ms == 2   ? ETHD_E_DEVICE
                                                            : ms == 3 ? ETHD_STATUS_EMPTY
                                                                      : ETHD_OK);
    sample(&x);
    ck_assert_int_eq(x.status, ms == 2 ? ETHD_E_DEVICE : ms == 4 || ms == 5 ? ETHD_STATUS_STALE : ETHD_OK);
    if (x.status) ck_assert_double_eq(x.s.q[0], 0);
    ethd_command c = {{ms, -ms}, 0, 0};
    ethd_status status = ethd_device_write(x.device, now, &c);
    ck_assert_int_eq(status, ms == 1 ? ETHD_E_DEVICE : ETHD_OK);
    double expected = ms == 1 || ms == 2 ? 0 : ms == 3 ? 1.5 : ms == 5 || ms == 6 ? ms - 2 : ms;
    ck_assert_double_eq(p.last.torque[0], expected);
  }
  ck_assert(p.reads == 5 && p.writes == 6 && p.services == 6);
  ethd_device_safe(x.device);
  ck_assert_int_eq(p.safes, 1);
  close_script(&x);
}

TEST(test_rows_and_start) {
  spoilt x = open_script("0.001 fault9 set for=0.002\n0.002 fault11 grave\n0.002 read stale\n");
  ck_assert_int_eq(sample(&x)->faults, 0);
  ck_assert_int_eq(sample(&x)->faults, ETHD_FAULT_BIT(9));
  ck_assert_int_eq(sample(&x)->faults, ETHD_FAULT_BIT(9) | ETHD_FAULT_BIT(11));
  ck_assert_int_eq(x.s.grave, ETHD_FAULT_BIT(11));
  ck_assert_int_eq(sample(&x)->faults, 0);
  ck_assert_int_eq(ethd_device_start(x.device), ETHD_OK); /* from the first sample again */
  ck_assert_int_eq(sample(&x)->faults, 0);
  ck_assert_int_eq(sample(&x)->faults, ETHD_FAULT_BIT(9));
  close_script(&x);
  ethd__script script;
  char message[ETHD_MESSAGE_MAX];
  const char *text = "0 start fail";
  ck_assert_int_eq(ethd__script_parse(text, strlen(text), "s", (ethd__script_of){0.001, false}, &script, message),
                   ETHD_OK);
  ethd_device device;
  device_of(&device, &driver, &p);
  device.inject = ethd__inject_create(&script, false);
  ck_assert_int_eq(ethd_device_start(&device), ETHD_E_DEVICE);
  ethd__inject_free(device.inject);
}

/* What has come into the sense before, by a sample that was held, isn't spoilt twice. */
TEST(test_adds_once) {
  spoilt x = open_script("0 rays offset by=1 for=inf\n0 q offset by=1 for=inf\n");
  p.says = ETHD_STATUS_STALE;
  sample(&x);
  ck_assert(x.status == ETHD_STATUS_STALE && x.s.q[0] == 0);
  double ray = x.s.rays[2];
  ck_assert_double_eq_tol(ray, 3 + at(0), 1e-12);
  p.says = ETHD_OK;
  x.status = ethd_device_read(x.device, x.now, &x.s);
  ck_assert_double_eq(x.s.rays[2], ray);
  ck_assert_double_eq_tol(x.s.q[0], 1 + at(1), 1e-12);
  close_script(&x);
}

/* ---- what a script may say ---- */

static const struct {
  const char *text, *says;
} bad[] = {
    {"x q1 nan", ":1: found \"x\""},
    {"\n-1 q1 nan", ":2: found \"-1\""},
    {"0 q3 nan", "found \"q3\"; channels are"},
    {"0 ray17 nan", "ray17"},
    {"0 ray0 nan", "ray0"},
    {"0 ray05 nan", "ray05"},
    {"0 fault40 set", "fault40"},
    {"0 fault set", "fault"},
    {"0 write1 drop", "write1"},
    {"0 q1 drop", "kinds of this channel are freeze offset reverse scale noise value nan"},
    {"0 q1", "found the line's end"},
    {"0", "found the line's end"},
    {"0 q1 offset", "needs by=NUMBER"},
    {"0 q1 nan by=1", "has no by="},
    {"0 q1 offset by=1 by=1", "by= may occur once"},
    {"0 q1 nan for=1 for=1", "for= may occur once"},
    {"0 q1 offset by=0x1", "by= is"},
    {"0 q1 noise by=-1", "by= is 0 to"},
    {"0 reading delay by=1.5", "by= is 0 to 1"},
    {"0 q1 nan for=0", "for= is 1e-9"},
    {"0 q1 nan for=1e-10", "for= is 1e-9"},
    {"0 q1 nan for=nan", "for= is 1e-9"},
    {"0 q1 nan then", "found \"then\""},
    {"1e300 q1 nan", "1e300"},
};

TEST_LOOP(test_refused, 0, sizeof bad / sizeof *bad) {
  ethd__script script;
  char message[ETHD_MESSAGE_MAX] = "";
  ck_assert_int_lt(
      ethd__script_parse(bad[_i].text, strlen(bad[_i].text), "s", (ethd__script_of){0.001, false}, &script, message),
      0);
  ck_assert_msg(strstr(message, bad[_i].says) && !strncmp(message, "s:", 2), "%s", message);
  ck_assert_ptr_null(script.at);
}

TEST(test_no_file) {
  ethd_setup setup = ethd_setup_default();
  const ethd_setting settings[] = {{"inject", "missing.inject", 3}};
  const ethd_device_def def = {&setup, settings, 1, "/nowhere", "c.ini", 1, NULL};
  ethd_device *device;
  char message[ETHD_MESSAGE_MAX] = "";
  ck_assert_int_eq(ethd_device_open("plain", only, &def, &device, message), ETHD_E_FILE);
  ck_assert_msg(strstr(message, "/nowhere/missing.inject"), "%s", message);
  ck_assert_ptr_null(device);
}
