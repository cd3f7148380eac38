/* Encoders behind the kernel's counters, with a stand-in for the kernel. */
#include <math.h>
#include <string.h>

#include "unit/mock_counter.h"
#include "unit/rig.h"

#define MS 1000000
#define D ethd_driver_counter

static const double PER_COUNT = 6.283185307179586 / 48000;

static ethd_status try(const ethd_setting *settings, uint32_t n, void **device, char *message) {
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, n, NULL, "c.ini", 1, NULL};
  message[0] = 0;
  ethd_status status = D.open(&def, device, message);
  if (status && *device) D.close(*device), *device = NULL; /* as a caller must */
  return status;
}

static void *open_with(const char *const *pairs) {
  ethd_setting settings[16] = {{"ratio", "12", 1}};
  uint32_t n = 1;
  for (; *pairs; pairs += 2, n++) settings[n] = (ethd_setting){pairs[0], pairs[1], (int)n + 1};
  char message[ETHD_MESSAGE_MAX];
  void *device;
  ck_assert_msg(!try(settings, n, &device, message), "%s", message);
  return device;
}

static ethd_sense sample(void *device, int64_t ms, ethd_status expected) {
  ethd_sense s = {0};
  (void)!D.service(device, 0, ms * MS);
  ck_assert_int_eq(D.read(device, ms * MS, &s), expected);
  return s;
}

/* ---- angles ---- */

TEST(test_counts_become_angles) {
  mock_counter_install();
  void *d = open_with((const char *const[]){"offset1", "0.5", "sign2", "-1", NULL});
  ck_assert_int_eq(D.start(d), ETHD_OK);
  for (int i = 0; i < 100; i++) {
    counter_mock.count[0] = (uint64_t)(10 * i);
    counter_mock.count[1] = 0xFFFFFFFF & (uint64_t)(-20 * i);
    ethd_sense s = sample(d, i + 1, ETHD_OK);
    ck_assert_double_eq_tol(s.q[0], 0.5 + PER_COUNT * 10 * i, 1e-12);
    ck_assert_double_eq_tol(s.q[1], PER_COUNT * 20 * i, 1e-12);
    ck_assert_int_eq(s.time_ns, (i + 1) * (int64_t)MS);
    ck_assert_int_eq(s.faults | s.have, 0);
  }
  ethd_sense s = {0};
  ck_assert_int_eq(D.read(d, 0, &s), ETHD_STATUS_STALE); /* nothing newer */
  ck_assert_int_eq(counter_mock.open_files, 3);          /* the device once, two counts */
  ck_assert_int_eq(counter_mock.pauses, 100);
  D.close(d);
  ck_assert_int_eq(counter_mock.open_files, 0);
}

TEST(test_two_devices) {
  mock_counter_install();
  void *d = open_with((const char *const[]){"device2", "/dev/counter1", "count2", "0", NULL});
  ck_assert_int_eq(counter_mock.open_files, 4);
  D.close(d);
  ck_assert(counter_mock.open_files == 0 && !counter_mock.enabled);
}

/* A count of 10 bits comes round every 1024. */
TEST(test_ceiling_of_the_kernel) {
  mock_counter_install();
  for (int j = 0; j < 2; j++) strcpy(counter_mock.ceiling[j], "1023");
  void *d = open_with((const char *const[]){"speed_max", "20", NULL});
  for (int i = 0; i < 200; i++) {
    counter_mock.count[0] = (uint64_t)(50 * i) % 1024;
    ck_assert_double_eq_tol(sample(d, i + 1, ETHD_OK).q[0], PER_COUNT * 50 * i, 1e-12);
  }
  D.close(d);
  for (int j = 0; j < 2; j++) strcpy(counter_mock.ceiling[j], "100");
  char message[ETHD_MESSAGE_MAX];
  const ethd_setting ratio = {"ratio", "12", 1};
  ck_assert_int_eq(try(&ratio, 1, &d, message), ETHD_E_RANGE); /* 30 rad/s are 229 counts in a period */
  ck_assert_msg(strstr(message, "speed_max"), "%s", message);
  ck_assert_int_eq(counter_mock.open_files, 0);
}

/* ---- index and edges ---- */

static int64_t homing;

static void turn_by_hand(int64_t ns) {
  homing += ns / MS;
  counter_mock.count[0] = 1000 + 2 * (uint64_t)homing;
  counter_mock.count[1] = 3000 + 2 * (uint64_t)homing;
  if (homing == 100) mock_counter_event(COUNTER_EVENT_INDEX, 0, 1190, 0);
  if (homing == 200) mock_counter_event(COUNTER_EVENT_INDEX, 1, 3390, 0);
}

TEST(test_homing) {
  mock_counter_install();
  void *d = open_with((const char *const[]){"home", "yes", "offset1", "0.25", NULL});
  ck_assert_uint_eq(counter_mock.watch_count, 2);
  ck_assert_int_eq(counter_mock.enabled, 1);
  homing = 0;
  counter_mock.on_pause = turn_by_hand;
  counter_mock.count[0] = 1000, counter_mock.count[1] = 3000;
  ck_assert_int_eq(D.start(d), ETHD_OK);
  counter_mock.on_pause = NULL;
  ck_assert(homing >= 200 && homing < 203);
  /* the mark at 1190 is the whole turn 0, the one at 3390 the whole turn 1 */
  ethd_sense s = sample(d, 1, ETHD_OK);
  ck_assert_double_eq_tol(s.q[0], 0.25 + PER_COUNT * (double)((int64_t)counter_mock.count[0] - 1190), 1e-12);
  ck_assert_double_eq_tol(s.q[1], PER_COUNT * (double)((int64_t)counter_mock.count[1] - 3390 + 4000), 1e-12);
  ck_assert_int_eq(D.start(d), ETHD_OK); /* at home */
  counter_mock.count[0] = 5190;          /* a turn later, by and by */
  for (int i = 2; i < 100; i++) counter_mock.count[0] = 1404 + (uint64_t)(38 * i), sample(d, i, ETHD_OK);
  mock_counter_event(COUNTER_EVENT_INDEX, 0, 5192, 0); /* two counts too far */
  s = sample(d, 100, ETHD_OK);
  ck_assert_int_eq(s.faults, ETHD_FAULT_BIT(ETHD_FAULT_INDEX));
  ck_assert_int_eq(sample(d, 101, ETHD_OK).faults, 0);
  ck_assert_int_eq(D.start(d), ETHD_E_DEVICE); /* not another run like that */
  ck_assert_msg(strstr(D.remark(d, 0), "index marks"), "%s", D.remark(d, 0));
  D.close(d);
}

TEST(test_homing_takes_too_long) {
  mock_counter_install();
  void *d = open_with((const char *const[]){"home", "yes", "home_time", "0.5", NULL});
  ck_assert_int_eq(D.start(d), ETHD_E_DEVICE);
  ck_assert_int_eq(counter_mock.pauses, 500);
  D.close(d);
}

/* A steady 0.9 edges in a ms: the speed is known to the ns, not to a count in a ms. */
TEST(test_stamps) {
  mock_counter_install();
  void *d = open_with((const char *const[]){"stamps", "yes", NULL});
  ck_assert_uint_eq(counter_mock.watch_count, 4);
  int64_t edge = 0;
  for (int ms = 1; ms < 200; ms++) {
    for (; (edge + 1) * 1111111 <= ms * MS; edge++)
      for (int j = 0; j < 2; j++) {
        uint64_t count = (uint64_t)(j ? -(edge + 1) : edge + 1) & 0xFFFFFFFF;
        mock_counter_event(COUNTER_EVENT_CHANGE_OF_STATE, j, count, (edge + 1) * 1111111);
      }
    ethd_sense s = sample(d, ms, ETHD_OK);
    if (ms < 4) continue;
    ck_assert_int_eq(s.have, ETHD_HAVE_DQ);
    ck_assert_double_eq_tol(s.dq[0], PER_COUNT / 1.111111e-3, 1e-9);
    ck_assert_double_eq_tol(s.dq[1], -PER_COUNT / 1.111111e-3, 1e-9);
  }
  for (int ms = 200; ms < 220; ms++) /* no more edges: at most what one just now would show */
    ck_assert_double_le(fabs(sample(d, ms, ETHD_OK).dq[0]), PER_COUNT / (1e-3 * (ms - 199)));
  D.close(d);
}

/* ---- what goes wrong ---- */

TEST(test_gone) {
  mock_counter_install();
  void *d = open_with((const char *const[]){NULL});
  sample(d, 1, ETHD_OK);
  counter_mock.gone = 1;
  ck_assert_int_eq(D.service(d, 0, 2 * MS), ETHD_E_DEVICE);
  sample(d, 3, ETHD_E_DEVICE);
  counter_mock.gone = 0;
  sample(d, 4, ETHD_OK);
  ethd_figure f[4];
  ck_assert_uint_eq(D.figures(d, f, 4), 4);
  ck_assert_double_eq(f[2].value, 2);
  D.close(d);
}

/* Without a setting, too: a joint that stands under a changed torque is frozen, but not once the device has let go of the torque. */
TEST(test_frozen_only_under_torque) {
  int64_t seen[2] = {0, 0};
  mock_counter_install();
  for (int is_safe = 0; is_safe < 2; is_safe++) {
    void *d = open_with((const char *const[]){NULL});
    const ethd_command none = {{0, 0}, 0, 0}, push = {{0.5, 0}, 0, 0};
    ck_assert_int_eq(D.start(d), ETHD_OK);
    for (int i = 0; i < 200; i++) {
      ck_assert_int_eq(D.write(d, i * (int64_t)MS, i < 100 ? &none : &push), ETHD_OK);
      if (is_safe && i == 100) D.safe(d);
      ethd_sense s = sample(d, i + 1, ETHD_OK);
      seen[is_safe] |= s.faults | s.grave;
    }
    D.close(d);
  }
  ck_assert_int_eq(seen[0], ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_FROZEN));
  ck_assert_int_eq(seen[1], 0);
}

static const struct {
  const char *key, *value, *says;
} bad[] = {
    {"colour", "red", "c.ini:7: device.colour"},
    {"ratio", "0", "c.ini:7: device.ratio"},
    {"ratio", "x", "c.ini:7: device.ratio"},
    {"sign1", "0.5", "c.ini:7: device.sign1"},
    {"width", "12.5", "c.ini:7: device.width"},
    {"home", "maybe", "c.ini:7: device.home"},
    {"count1", "256", "c.ini:7: device.count1"},
    {"count1", "1.5", "c.ini:7: device.count1"},
    {"freeze_torque", "nan", "c.ini:7: device.freeze_torque"},
    {"device", "/dev/counter9", "/dev/counter9: no such counter"},
    {"device",
     "/a/path/that/is/much/longer/than/any/device/has/ever/been/and/still/goes/on/and/on/until/it/is/too/long",
     "c.ini:7: device.device: "},
};

TEST_LOOP(test_refused, 0, sizeof bad / sizeof *bad) {
  mock_counter_install();
  const ethd_setting s = {bad[_i].key, bad[_i].value, 7};
  char message[ETHD_MESSAGE_MAX];
  void *d = &counter_mock;
  ck_assert_int_lt(try(&s, 1, &d, message), 0);
  ck_assert_msg(strstr(message, bad[_i].says), "%s", message);
  ck_assert(!d && counter_mock.open_files == 0);
}

static ethd_status open_plain(const char *key, const char *value, char *message) {
  const ethd_setting s = {key, value, 7};
  void *d;
  ethd_status status = try(&s, 1, &d, message);
  if (!status) D.close(d);
  ck_assert_int_eq(counter_mock.open_files, 0);
  return status;
}

TEST(test_kernel_disagrees) {
  char message[ETHD_MESSAGE_MAX];
  mock_counter_install();
  strcpy(counter_mock.function, "increase");
  ck_assert_int_eq(open_plain("ratio", "1", message), ETHD_OK);
  ck_assert_str_eq(counter_mock.function, "quadrature x4");
  strcpy(counter_mock.function, "increase");
  counter_mock.deaf = 1;
  ck_assert_int_eq(open_plain("ratio", "1", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "found increase after setting quadrature x4"), "%s", message);
  mock_counter_install();
  for (int j = 0; j < 2; j++) strcpy(counter_mock.ceiling[j], "many");
  ck_assert_int_eq(open_plain("ratio", "1", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "many"), "%s", message);
  mock_counter_install();
  counter_mock.ceiling[0][0] = counter_mock.ceiling[1][0] = 0; /* the kernel doesn't say: `width` does */
  ck_assert_int_eq(open_plain("width", "16", message), ETHD_OK);
  mock_counter_install();
  counter_mock.refuse_event = COUNTER_EVENT_INDEX;
  ck_assert_int_eq(open_plain("ratio", "1", message), ETHD_OK);
  ck_assert_int_eq(open_plain("home", "yes", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "has no index event"), "%s", message);
  counter_mock.refuse_event = COUNTER_EVENT_CHANGE_OF_STATE;
  ck_assert_int_eq(open_plain("stamps", "yes", message), ETHD_E_DEVICE);
}

/* Every driver of the kernel that can count an encoder does, whatever it says when it is loaded: a joint turns by half
   a radian, and back by a quarter below where it began. */
TEST_LOOP(test_drivers_of_the_kernel, 0, 5) {
  static const struct {
    const char *name, *width;
  } cases[] = {
      {"intel-qep", NULL}, {"ti-eqep", NULL}, {"stm32-timer-cnt", NULL}, {"104-quad-8", NULL}, {"ftm-quaddec", "16"}};
  static const uint64_t ceilings[] = {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFF, 0x1FFFFFF, 0xFFFF};
  mock_counter_load(cases[_i].name);
  void *d = open_with((const char *const[]){cases[_i].width ? "width" : NULL, cases[_i].width, NULL});
  ck_assert_int_eq(D.start(d), ETHD_OK);
  ck_assert_str_eq(counter_mock.function, "quadrature x4");
  ck_assert(!counter_mock.has_enable || (counter_mock.on[0] && counter_mock.on[1]));
  int64_t at = 0, faults = 0;
  for (int i = 1; i <= 500; i++) {
    at += i <= 200 ? 20 : -20;
    for (int j = 0; j < 2; j++) counter_mock.count[j] = (uint64_t)at & ceilings[_i];
    ethd_sense s = sample(d, i, ETHD_OK);
    faults |= s.faults | s.grave;
    ck_assert_double_eq_tol(s.q[0], PER_COUNT * (double)at, 1e-12);
    ck_assert_double_eq_tol(s.q[1], PER_COUNT * (double)at, 1e-12);
  }
  ck_assert_int_eq(faults, 0);
  D.close(d);
}

/* The kernel's own calls, where it has a counter or not. */
TEST(test_this_machine) {
  ethd__counter_calls_now = &ethd__counter_kernel;
  const ethd_setting s = {"device", "/dev/counter97", 7};
  char message[ETHD_MESSAGE_MAX];
  void *d;
  ck_assert_int_eq(try(&s, 1, &d, message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "/dev/counter97: no such counter"), "%s", message);
}
