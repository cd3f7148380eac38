/* Devices in space: which drivers have a part in them, what they add up to, and what their safe state is. */
#include <math.h>
#include <string.h>

#include "ethd/control.h"
#include "ethd/driver.h"
#include "unit/suite.h"

static char log_[32], message[ETHD_MESSAGE_MAX];
static ethd_device *device;
static int opened_without_setup;

static void note(char what) { log_[strlen(log_)] = what; }

static ethd_status open_it(const ethd_device_def *def, void **state, char said[ETHD_MESSAGE_MAX]) {
  (void)said;
  opened_without_setup += def->space && !def->setup && def->space->radius == 0.0175;
  *state = log_;
  return ETHD_OK;
}
static void close_it(void *d) { (void)d; }
static ethd_status start_arm(void *d) { return (void)d, note('A'), ETHD_OK; }
static ethd_status start_tracker(void *d) { return (void)d, note('T'), ETHD_OK; }

static ethd_status read_arm(void *d, int64_t now, ethd_space_sense *out) ETHD_RT {
  (void)d;
  out->time_ns = now;
  out->x[2] = 0.5;
  return ETHD_OK;
}
static ethd_status write_arm(void *d, int64_t now, const ethd_space_command *c) ETHD_RT {
  (void)d, (void)now;
  note(c->value[1] == 2 ? 'w' : '?');
  return ETHD_E_DEVICE;
}
static ethd_ability able(const void *d, const double n[3]) ETHD_RT {
  (void)d;
  return (ethd_ability){.speed = 1 + n[2], .acceleration = 20, .delay = 0.008, .mass = 3, .force = 9, .friction = 0};
}
static void safe(void *d) ETHD_RT { (void)d; }

static ethd_status read_tracker(void *d, int64_t now, ethd_space_sense *out) ETHD_RT {
  (void)d;
  out->have |= ETHD_SPACE_HAVE_READING;
  out->sample_ns = now - 30;
  return ETHD_STATUS_STALE;
}
static ethd_status read_plane(void *d, int64_t now, ethd_sense *out) ETHD_RT {
  return (void)d, (void)now, (void)out, ETHD_OK;
}

#define DRIVER(name, ...)       \
  {.size = sizeof(ethd_driver), \
   .abi = ETHD_DRIVER_ABI,      \
   .id = name,                  \
   .brief = name,               \
   .open = open_it,             \
   .close = close_it,           \
   __VA_ARGS__}
static ethd_driver arm =
    DRIVER("arm", .start = start_arm, .read_space = read_arm, .write_space = write_arm, .able = able, .safe = safe);
static const ethd_driver tracker = DRIVER("tracker", .start = start_tracker, .read_space = read_tracker);
static const ethd_driver plane = DRIVER("plane", .read = read_plane), nothing = DRIVER("nothing", .start = start_arm);
static const ethd_driver *const all[] = {&arm, &tracker, &plane, &nothing, NULL};

static ethd_status try(const char *ids, bool in_space) {
  static ethd_setup setup;
  static ethd_space_setup space;
  setup = ethd_setup_default();
  space = ethd_space_setup_default();
  const ethd_device_def def = {.setup = in_space ? NULL : &setup, .file = "c.ini", .space = in_space ? &space : NULL};
  memset(log_, 0, sizeof log_);
  return ethd_device_open(ids, all, &def, &device, message);
}

TEST(test_parts) {
  ethd_space_sense s = {0};
  const ethd_space_command c = {.value = {0, 2, 0}};
  const double n[3] = {0, 0, 1};
  ck_assert_int_eq(try("arm, tracker", true), ETHD_OK);
  ck_assert_int_eq(opened_without_setup, 2);
  ck_assert_int_eq(ethd_device_in_space(device), 1);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK); /* what moves starts last */
  ck_assert_int_eq(ethd_device_read_space(device, 50, &s), ETHD_STATUS_STALE);
  ck_assert(s.time_ns == 50 && s.x[2] == 0.5 && s.have == ETHD_SPACE_HAVE_READING && s.sample_ns == 20);
  ck_assert_int_eq(ethd_device_write_space(device, 50, &c), ETHD_E_DEVICE);
  ck_assert_str_eq(log_, "TAw");
  const ethd_ability a = ethd_device_able(device, n);
  ck_assert(a.speed == 2 && a.acceleration == 20 && a.delay == 0.008 && a.mass == 3 && a.force == 9);
  ethd_device_close(device);
}

TEST(test_able_to_do_what_nobody_knows) {
  const double n[3] = {1, 0, 0};
  arm.able = NULL;
  ck_assert_int_eq(try("arm", true), ETHD_OK);
  const ethd_ability a = ethd_device_able(device, n);
  ck_assert(isnan(a.speed) && isnan(a.acceleration) && isnan(a.delay) && isnan(a.mass) && isnan(a.force) &&
            isnan(a.friction));
  ethd_device_close(device);
}

TEST(test_refused) {
  static const struct {
    const char *ids;
    bool in_space;
    const char *says;
  } rows[] = {{"arm, plane", true, "c.ini: device.driver: plane has no part in a device in space"},
              {"nothing", true, "c.ini: device.driver: nothing has no part in a device in space"},
              {"plane, tracker", false, "c.ini: device.driver: tracker has no part in a device in the plane"},
              {"tracker", true, "c.ini: device.driver: \"tracker\": none takes commands in space"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    ck_assert_int_eq(try(rows[i].ids, rows[i].in_space), ETHD_E_ARGUMENT);
    ck_assert_str_eq(message, rows[i].says);
  }
  ck_assert_int_eq(try("plane, nothing", false), ETHD_OK);
  ck_assert_int_eq(ethd_device_in_space(device), 0);
  ck_assert(!ethd_device_remark(device, 0) && ethd_device_safe_is(device) == ETHD_SAFE_NO_TORQUE);
  ethd_device_close(device);
}

TEST(test_safe_states_have_words) {
  static const char *const says[] = {"safe is zero torque: ", "safe is zero speed: ", "safe is closed brakes: "};
  for (int k = 0; k < 3; k++) {
    arm.safe_is = (ethd_safe_state)k;
    ck_assert_int_eq(try("tracker, arm", true), ETHD_OK);
    ck_assert_int_eq(ethd_device_safe_is(device), k);
    ck_assert_msg(!strncmp(ethd_device_remark(device, 0), says[k], strlen(says[k])), "%s",
                  ethd_device_remark(device, 0));
    ck_assert_ptr_null(ethd_device_remark(device, 1));
    ethd_device_close(device);
  }
}
