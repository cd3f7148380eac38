/* Encoders behind the kernel's counters: each call of the kernel that fails and each setting that can't be is one
   message, which says where and why, and nothing stays open. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "unit/mock_counter.h"
#include "unit/rig.h"

#define D ethd_driver_counter
#define SYS "/sys/bus/counter/devices/counter0/count"

static char message[ETHD_MESSAGE_MAX];

static ethd_status try(const char *key, const char *value, void **device) {
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_setting settings[] = {{"ratio", "12", 1}, {key, value, 2}};
  const ethd_device_def def = {&setup, settings, key ? 2 : 1, NULL, "c.ini", 1, NULL};
  message[0] = 0;
  *device = NULL;
  ethd_status status = D.open(&def, device, message);
  if (status && *device) D.close(*device), *device = NULL; /* as a caller must */
  return status;
}

static void expect(const char *key, const char *value, ethd_status expected, const char *said) {
  void *device;
  ethd_status status = try(key, value, &device);
  ck_assert_msg(status == expected && !strcmp(message, said), "%d, not %d: %s", status, expected, message);
  ck_assert_int_eq(counter_mock.open_files, 0);
}

TEST(test_calls_that_fail) {
  static const struct {
    mock_failure open, read, write;
    const char *function, *said;
  } cases[] = {
      {.open = {"/dev/counter0", 0, EACCES}, .said = "/dev/counter0: can't be opened: Permission denied"},
      {.open = {"count0/count", 0, EACCES}, .said = SYS "0/count: can't be opened: Permission denied"},
      {.open = {"count1/count", 0, EMFILE}, .said = SYS "1/count: can't be opened: Too many open files"},
      {.open = {"count0/function", 0, EACCES}, .said = SYS "0/function: can't be read: Permission denied"},
      {.read = {"count0/function", 0, EIO}, .said = SYS "0/function: can't be read: Input/output error"},
      {.open = {"count0/function", 1, EACCES},
       .function = "pulse",
       .said = SYS "0/function: quadrature x4: Permission denied"},
      {.write = {"count0/function", 0, EINVAL},
       .function = "pulse",
       .said = SYS "0/function: quadrature x4: Invalid argument"},
      {.read = {"count0/function", 1, EIO},
       .function = "pulse",
       .said = SYS "0/function: can't be read: Input/output error"},
      {.open = {"count0/enable", 0, EACCES}, .said = SYS "0/enable: can't be enabled: Permission denied"},
      {.write = {"count1/enable", 0, EIO}, .said = SYS "1/enable: can't be enabled: Input/output error"},
      {.read = {"count1/enable", 0, EIO}, .said = SYS "1/enable: can't be read: Input/output error"},
      {.open = {"count1/ceiling", 0, EACCES}, .said = SYS "1/ceiling: can't be read: Permission denied"},
      {.read = {"count0/ceiling", 0, EIO}, .said = SYS "0/ceiling: can't be read: Input/output error"},
      {.read = {"count0/count", 0, EIO}, .said = "/dev/counter0: count 0 can't be read"},
      {.read = {"count1/count", 0, EIO}, .said = "/dev/counter0: count 1 can't be read"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    mock_counter_install();
    counter_mock.open = cases[i].open;
    counter_mock.read = cases[i].read;
    counter_mock.write = cases[i].write;
    if (cases[i].function) strcpy(counter_mock.function, cases[i].function);
    expect(NULL, NULL, ETHD_E_DEVICE, cases[i].said);
  }
}

TEST(test_events_that_fail) {
  mock_counter_install();
  counter_mock.ioctl_reason = ENODEV;
  expect("home", "yes", ETHD_E_DEVICE, "/dev/counter0: events: No such device");
}

/* A ceiling and a count that are no numbers. */
TEST(test_texts_of_the_kernel) {
  static const char *const ceilings[] = {"-1", "abc", "12x", "99999999999999999999999"};
  for (size_t i = 0; i < sizeof ceilings / sizeof *ceilings; i++) {
    char said[ETHD_MESSAGE_MAX];
    mock_counter_install();
    for (int j = 0; j < 2; j++) strcpy(counter_mock.ceiling[j], ceilings[i]);
    snprintf(said, sizeof said, SYS "0/ceiling: found \"%s\"; a whole number is expected", ceilings[i]);
    expect(NULL, NULL, ETHD_E_DEVICE, said);
  }
}

/* A counter that can't count an encoder, or that stays off, is told apart from one that stands. */
TEST(test_counters_that_do_not_count) {
  mock_counter_load("interrupt-cnt");
  expect(NULL, NULL, ETHD_E_DEVICE, SYS "0/function: quadrature x4: Permission denied");
  mock_counter_load("ftm-quaddec");
  expect(NULL, NULL, ETHD_E_DEVICE,
         SYS "0/ceiling: this counter has none: counter.width must say its bits (ftm-quaddec: 16)");
  mock_counter_install();
  counter_mock.stays_off = 1;
  expect(NULL, NULL, ETHD_E_DEVICE, SYS "0/enable: found 0 after writing 1: it doesn't count");
  mock_counter_load("ti-eqep");
  counter_mock.on[0] = 1; /* somebody has enabled it without a ceiling */
  expect(NULL, NULL, ETHD_E_DEVICE, SYS "0/ceiling: is 0 and can't be set: Device or resource busy");
  mock_counter_load("ti-eqep");
  counter_mock.ceiling_fixed = 1;
  expect("width", "16", ETHD_E_DEVICE, SYS "0/ceiling: found 0 after setting 65535");
  mock_counter_install();
  counter_mock.on[1] = 1;
  counter_mock.write = (mock_failure){"count1/enable", 0, EACCES}; /* it is on, and that is enough */
  void *d;
  ck_assert_msg(try(NULL, NULL, &d) == ETHD_OK, "%s", message);
  D.close(d);
}

/* What is switched off is said; an encoder whose marks are right has nothing to say. */
TEST(test_remarks) {
  void *d;
  mock_counter_install();
  ck_assert_int_eq(try(NULL, NULL, &d), ETHD_OK);
  ck_assert_str_eq(D.why(d), "");
  ck_assert_str_eq(D.remark(d, 0), "counter.reverse_torque is inf: a reversed encoder isn't noticed");
  ck_assert_ptr_null(D.remark(d, 1));
  D.close(d);
  ck_assert_int_eq(try("freeze_torque", "inf", &d), ETHD_OK);
  ck_assert_str_eq(D.remark(d, 0), "counter.freeze_torque is inf: a frozen encoder isn't noticed");
  ck_assert_str_eq(D.remark(d, 1), "counter.reverse_torque is inf: a reversed encoder isn't noticed");
  ck_assert_ptr_null(D.remark(d, 2));
  D.close(d);
}
