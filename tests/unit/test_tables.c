/* What is wrong with the table of a foreign driver, or of numbers, in one line that names the place. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "device/driver_file.h"
#include "settings/plugin_fault.h"
#include "unit/rig.h"

static char what[ETHD_MESSAGE_MAX];

/* ---- numbers ---- */

static const ethd_param good = {"gain", "N/m", 0, 10, 5, "how stiff it is"};

static void expect_rows(const ethd_param *rows, uint32_t count, const char *said) {
  what[0] = 0;
  ck_assert_int_eq(ethd__table_fault(rows, count, what), ETHD_E_TABLE);
  ck_assert_str_eq(what, said);
}

TEST(test_numbers) {
  static const struct {
    ethd_param row;
    const char *said;
  } cases[] = {
      {{NULL, "1", 0, 1, 0, "b"}, "row 1: its name is NULL, 1 to 31 of a-z 0-9 _ are allowed"},
      {{"", "1", 0, 1, 0, "b"}, "row 1: its name is \"\", 1 to 31 of a-z 0-9 _ are allowed"},
      {{"Gain", "1", 0, 1, 0, "b"}, "row 1: its name is \"Gain\", 1 to 31 of a-z 0-9 _ are allowed"},
      {{"a23456789012345678901234567890123", "1", 0, 1, 0, "b"},
       "row 1: its name is \"a23456789012345678901234567890123\", 1 to 31 of a-z 0-9 _ are allowed"},
      {{"gain", NULL, 0, 1, 0, "b"},
       "row 1, gain: its unit is NULL, one line of 1 to 200 printable characters is allowed (\"1\": none)"},
      {{"gain", "\x1b[2J", 0, 1, 0, "b"},
       "row 1, gain: its unit is \"?[2J\", one line of 1 to 200 printable characters is allowed (\"1\": none)"},
      {{"gain", "1", 0, 1, 0, ""},
       "row 1, gain: its brief is \"\", one line of 1 to 200 printable characters is allowed"},
      {{"gain", "1", -INFINITY, 1, 0, "b"},
       "row 1, gain: found min -inf, max 1, default 0; min <= default <= max and a finite min are needed"},
      {{"gain", "1", 1, 2, 0, "b"},
       "row 1, gain: found min 1, max 2, default 0; min <= default <= max and a finite min are needed"},
      {{"gain", "1", 0, 2, 3, "b"},
       "row 1, gain: found min 0, max 2, default 3; min <= default <= max and a finite min are needed"},
      {{"gain", "1", 0, (double)NAN, 0, "b"},
       "row 1, gain: found min 0, max nan, default 0; min <= default <= max and a finite min are needed"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) expect_rows(&cases[i].row, 1, cases[i].said);
  const ethd_param twice[] = {good, good};
  expect_rows(twice, 2, "row 2, gain: an earlier row has that name");
  expect_rows(NULL, 3, "NULL, but 3 rows are promised");
  expect_rows(&good, ETHD_PARAMS_MAX + 1, "17 rows, at most 16 are allowed");
  ck_assert_int_eq(ethd__table_fault(&good, 1, what), ETHD_OK);
  ck_assert_int_eq(ethd__table_fault(NULL, 0, what), ETHD_OK);
}

/* ---- drivers ---- */

static ethd_status open_it(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  return (void)def, (void)device, (void)message, ETHD_OK;
}
static void one(void *device) { (void)device; }
static uint32_t units(const void *device) { return (void)device, 1; }
static ethd_status service(void *device, uint32_t unit, int64_t now) {
  return (void)device, (void)unit, (void)now, ETHD_OK;
}
static ethd_status write_it(void *device, int64_t now, const ethd_command *command) {
  return (void)device, (void)now, (void)command, ETHD_OK;
}

static ethd_status write_in_space(void *device, int64_t now, const ethd_space_command *command) {
  return (void)device, (void)now, (void)command, ETHD_OK;
}

static const ethd_driver sound = {.size = sizeof sound,
                                  .abi = ETHD_DRIVER_ABI,
                                  .id = "sound",
                                  .brief = "a sound one",
                                  .open = open_it,
                                  .close = one,
                                  .write = write_it,
                                  .safe = one,
                                  .units = units,
                                  .service = service};

static void expect_driver(const ethd_driver *driver, ethd_status status, const char *said) {
  what[0] = 0;
  ck_assert_int_eq(ethd__driver_check(driver, what), status);
  ck_assert_str_eq(what, said);
}

#define REFUSED(status, said, ...)   \
  do {                               \
    ethd_driver d = sound;           \
    __VA_ARGS__;                     \
    expect_driver(&d, status, said); \
  } while (0)

TEST(test_drivers) {
  static const char *many[70];
  static const char *const odd[] = {"port", "Port", NULL}, *const words[] = {"port", NULL};
  static const ethd_param out_of_range[] = {{"gain", "1", 0, 1, 7, "b"}};
  for (int i = 0; i < 66; i++) many[i] = "port";
  expect_driver(&sound, ETHD_OK, "");
  REFUSED(ETHD_OK, "", d.keys = words);
  REFUSED(ETHD_OK, "", d.units = NULL, d.service = NULL);
  REFUSED(ETHD_OK, "", d.write = NULL, d.safe = NULL);
#define BUILT_FOR(version) \
  "it was built for version " version " of the drivers' interface, this is version 4: build it with these headers"
  REFUSED(ETHD_E_ABI, "its table doesn't say its abi: .abi = ETHD_DRIVER_ABI is needed", d.abi = 0);
  REFUSED(ETHD_E_ABI, BUILT_FOR("9"), d.abi = 9);
  REFUSED(ETHD_E_ABI, BUILT_FOR("2"), d.abi = 20736);
  REFUSED(ETHD_E_ABI, BUILT_FOR("5"), d.abi += 1u << 28);
#define BUILT_WITH(name, there, here) \
  "it was built with an " name " of " there " bytes, here it has " here ": build it with these headers"
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_sense", "504", "512"), d.abi -= 1u << 21);
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_space_sense", "320", "312"), d.abi += 1u << 15);
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_limits", "200", "192"), d.abi += 1u << 9);
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_space_command", "48", "56"), d.abi -= 1u << 6);
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_command", "32", "24"), d.abi += 1u << 3);
  REFUSED(ETHD_E_ABI, BUILT_WITH("ethd_dynamics", "48", "40"), d.abi += 1u);
  REFUSED(ETHD_E_ARGUMENT, "its id isn't 1 to 31 of a-z 0-9 - _", d.id = NULL);
  REFUSED(ETHD_E_ARGUMENT, "its id isn't 1 to 31 of a-z 0-9 - _", d.id = "");
  REFUSED(ETHD_E_ARGUMENT, "its id isn't 1 to 31 of a-z 0-9 - _", d.id = "Sound");
  REFUSED(ETHD_E_ARGUMENT, "its id isn't 1 to 31 of a-z 0-9 - _", d.id = "a2345678901234567890123456789012");
  REFUSED(ETHD_E_ARGUMENT, "the brief of sound isn't one line of 1 to 200 printable characters", d.brief = NULL);
  REFUSED(ETHD_E_ARGUMENT, "the brief of sound isn't one line of 1 to 200 printable characters", d.brief = "a\nb");
  REFUSED(ETHD_E_ARGUMENT, "the brief of sound isn't one line of 1 to 200 printable characters", d.brief = "a\x7f");
  REFUSED(ETHD_E_TABLE, "sound: params: NULL, but 2 rows are promised", d.param_count = 2);
  REFUSED(
      ETHD_E_TABLE,
      "sound: params: row 1, gain: found min 0, max 1, default 7; min <= default <= max and a finite min are needed",
      d.params = out_of_range, d.param_count = 1);
  REFUSED(ETHD_E_TABLE, "sound: keys: not words, or no NULL behind them", d.keys = odd);
  REFUSED(ETHD_E_TABLE, "sound: keys: not words, or no NULL behind them", d.keys = many);
  REFUSED(ETHD_E_ARGUMENT, "sound has no open", d.open = NULL);
  REFUSED(ETHD_E_ARGUMENT, "sound has no close", d.close = NULL);
  REFUSED(ETHD_E_ARGUMENT, "sound takes commands in space and has no safe to end them", d.safe = NULL, d.write = NULL,
          d.write_space = write_in_space);
  REFUSED(ETHD_E_ARGUMENT, "sound has a safe_is that isn't one of ethd_safe_state", d.safe_is = (ethd_safe_state)3);
  REFUSED(ETHD_E_ARGUMENT, "sound takes torque and has no safe to remove it", d.safe = NULL);
  REFUSED(ETHD_E_ARGUMENT, "sound has units of I/O and no service", d.service = NULL);
  REFUSED(ETHD_E_ARGUMENT, "sound has a service and no units", d.units = NULL);
}

/* A table's size is all that may be read of it. */
TEST(test_sizes) {
  char said[ETHD_MESSAGE_MAX];
  const uint32_t sizes[] = {0, ETHD_DRIVER_MIN - 1, sizeof sound + 1};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    snprintf(said, sizeof said, "its table has %u bytes, %zu to %zu are allowed: build it with these headers", sizes[i],
             (size_t)ETHD_DRIVER_MIN, sizeof sound);
    REFUSED(ETHD_E_SIZE, said, d.size = sizes[i]);
  }
}
