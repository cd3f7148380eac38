/* Several drivers behind one device: names, whose keys are whose, order, what is read and written. */
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ethd/control.h"
#include "ethd/driver.h"
#include "unit/suite.h"

typedef struct part {
  char name;
  uint32_t keys;
  char key[2][16];
} part;

static char log_[64], keys[2][16]; /* of what was opened last */

static void note(char what, char who) {
  size_t n = strlen(log_);
  log_[n] = what, log_[n + 1] = who, log_[n + 2] = 0;
}

static ethd_status open_part(char name, const ethd_device_def *def, void **device, char *message) {
  part *p = calloc(1, sizeof *p);
  p->name = name;
  for (uint32_t i = 0; i < def->setting_count && i < 2; i++) strncpy(p->key[i], def->settings[i].key, 15);
  p->keys = def->setting_count;
  *device = p;
  note('o', name);
  memcpy(keys, p->key, sizeof keys);
  if (p->keys && !strcmp(p->key[0], "mute")) return ETHD_E_DEVICE;
  if (p->keys && !strcmp(p->key[0], "bad")) return strcpy(message, "refused"), ETHD_E_DEVICE;
  return ETHD_OK;
}
static ethd_status open_a(const ethd_device_def *d, void **v, char m[ETHD_MESSAGE_MAX]) {
  return open_part('a', d, v, m);
}
static ethd_status open_b(const ethd_device_def *d, void **v, char m[ETHD_MESSAGE_MAX]) {
  return open_part('b', d, v, m);
}
static ethd_status start_status; /* of part a */
static ethd_status start(void *p) {
  note('s', ((part *)p)->name);
  return ((part *)p)->name == 'a' ? start_status : ETHD_OK;
}
static ethd_status stop(void *p) { return note('t', ((part *)p)->name), ETHD_OK; }
static void safe(void *p) { note('x', ((part *)p)->name); }
static void close_part(void *p) {
  note('c', ((part *)p)->name);
  free(p);
}
static ethd_status read_a(void *p, int64_t now, ethd_sense *out) {
  (void)p, out->q[0] = 1, out->time_ns = now;
  return ETHD_STATUS_STALE;
}
static ethd_status read_b(void *p, int64_t now, ethd_sense *out) {
  (void)p, (void)now, out->have |= ETHD_HAVE_RAYS, out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_SENSOR);
  return ETHD_OK;
}
static ethd_status write_a(void *p, int64_t now, const ethd_command *c) {
  return (void)p, (void)now, (void)c, note('w', 'a'), ETHD_OK;
}
static uint32_t one(const void *p) { return (void)p, 1; }
static uint32_t two(const void *p) { return (void)p, 2; }
static ethd_status service(void *p, uint32_t unit, int64_t now) {
  return (void)now, note((char)('0' + unit), ((part *)p)->name), ETHD_OK;
}
static ethd_limits limits_a(const void *p) {
  ethd_limits l = ethd_limits_none();
  return (void)p, l.torque = 2, l.speed = 3, l;
}
static ethd_limits limits_b(const void *p) {
  ethd_limits l = ethd_limits_none();
  return (void)p, l.torque = 1, l;
}
static uint32_t figures(const void *p, ethd_figure *out, uint32_t max) {
  if (max) out[0] = (ethd_figure){"age", "s", ((const part *)p)->name};
  return max ? 1 : 0;
}

static const ethd_driver a = {.size = sizeof a,
                              .abi = ETHD_DRIVER_ABI,
                              .id = "a",
                              .brief = "a",
                              .open = open_a,
                              .start = start,
                              .read = read_a,
                              .write = write_a,
                              .units = one,
                              .service = service,
                              .safe = safe,
                              .stop = stop,
                              .close = close_part,
                              .limits = limits_a,
                              .figures = figures};
static const ethd_driver b = {.size = sizeof b,
                              .abi = ETHD_DRIVER_ABI,
                              .id = "b",
                              .brief = "b",
                              .open = open_b,
                              .start = start,
                              .read = read_b,
                              .units = two,
                              .service = service,
                              .safe = safe,
                              .stop = stop,
                              .close = close_part,
                              .limits = limits_b,
                              .figures = figures};
static const ethd_driver *const both[] = {&a, &b, NULL};

static ethd_device *device;
static char message[ETHD_MESSAGE_MAX];

static ethd_status try(const char *ids, const char *k0, const char *k1) {
  const ethd_setting settings[] = {{k0, "1", 7}, {k1, "2", 8}};
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, (k0 != NULL) + (k1 != NULL), ".", "c.ini", 1, NULL};
  log_[0] = message[0] = 0;
  return ethd_device_open(ids, both, &def, &device, message);
}

TEST(test_alone) {
  ck_assert_int_eq(try("b", "b.port", "speed"), ETHD_OK);
  ck_assert_str_eq(keys[0], "port");
  ck_assert_str_eq(keys[1], "speed");
  ethd_device_close(device);
}

TEST(test_two) {
  ethd_sense s = {0};
  ethd_command c = {0};
  ethd_figure f[3];
  ck_assert_int_eq(try("a ,b", "b.port", "a.map"), ETHD_OK);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
  ck_assert_int_eq(ethd_device_read(device, 5, &s), ETHD_STATUS_STALE);
  ck_assert(s.q[0] == 1 && s.time_ns == 5 && s.have == ETHD_HAVE_RAYS && s.faults == ETHD_FAULT_BIT(18));
  ck_assert_int_eq(ethd_device_write(device, 5, &c), ETHD_OK);
  ck_assert_uint_eq(ethd_device_units(device), 3);
  for (uint32_t u = 0; u < 3; u++) ck_assert_int_eq(ethd_device_service(device, u, 5), ETHD_OK);
  ck_assert_int_eq(ethd_device_service(device, 3, 5), ETHD_E_ARGUMENT);
  ethd_device_safe(device);
  ethd_limits l = ethd_device_limits(device);
  ck_assert(l.torque == 1 && l.speed == 3);
  ck_assert_uint_eq(ethd_device_figures(device, f, 3), 2);
  ck_assert(f[0].value == 'a' && f[1].value == 'b');
  ck_assert_uint_eq(ethd_device_figures(device, f, 1), 1);
  ck_assert_int_eq(ethd_device_stop(device), ETHD_OK);
  ethd_device_close(device);
  ck_assert_str_eq(log_, "oaobsbsawa0a0b1bxaxbtatbcbca");
}

/* A start that fails leaves nothing started; an open that fails nothing open. A positive status is a failure after a start. */
TEST(test_undone) {
  ck_assert_int_eq(try("a,b", NULL, NULL), ETHD_OK);
  start_status = ETHD_E_DEVICE;
  ck_assert_int_eq(ethd_device_start(device), ETHD_E_DEVICE);
  start_status = ETHD_STATUS_STALE;
  ck_assert_int_eq(ethd_device_start(device), ETHD_E_DEVICE);
  start_status = ETHD_OK;
  ethd_device_close(device);
  ck_assert_str_eq(log_, "oaobsbsatbsbsatatbcbca");
  ck_assert_int_eq(try("a,b", "b.bad", NULL), ETHD_E_DEVICE);
  ck_assert_str_eq(log_, "oaobcbca");
  ck_assert_str_eq(message, "refused");
  ck_assert_int_eq(try("a,b", "b.mute", NULL), ETHD_E_DEVICE);
  ck_assert_str_eq(message, "device b: open: the device refused or failed");
}

/* What a driver hasn't is nothing: to do, to read, to limit; and a device has it all the same. */
static ethd_driver bare;
static const ethd_driver *const only_bare[] = {&bare, &a, NULL};

static ethd_status open_bare(const char *ids) {
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {&setup, NULL, 0, ".", NULL, 1, NULL};
  log_[0] = message[0] = 0;
  return ethd_device_open(ids, only_bare, &def, &device, message);
}

TEST(test_bare) {
  const ethd_limits none = ethd_limits_none();
  ethd_sense s = {0};
  ethd_command c = {0};
  ethd_figure f;
  bare = (ethd_driver){
      .size = sizeof bare, .abi = ETHD_DRIVER_ABI, .id = "bare", .brief = "bare", .open = open_b, .close = close_part};
  ck_assert_int_eq(open_bare("bare"), ETHD_OK);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
  ck_assert_int_eq(ethd_device_read(device, 5, &s), ETHD_OK);
  ck_assert_int_eq(ethd_device_write(device, 5, &c), ETHD_OK);
  ck_assert_uint_eq(ethd_device_units(device), 0);
  ethd_device_safe(device);
  ethd_limits l = ethd_device_limits(device);
  ck_assert_mem_eq(&l, &none, sizeof l);
  ck_assert_uint_eq(ethd_device_figures(device, &f, 1), 0);
  ck_assert(ethd_device_remark(device, 0) == NULL);
  ck_assert_int_eq(ethd_device_stop(device), ETHD_OK);
  ethd_device_close(device);
  ck_assert_str_eq(log_, "obcb");
  /* beside another; without a stop of its own it is made safe */
  bare.safe = safe;
  ck_assert_int_eq(open_bare("a, bare"), ETHD_OK);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
  l = ethd_device_limits(device);
  ck_assert(l.torque == 2 && l.speed == 3);
  ck_assert_int_eq(ethd_device_stop(device), ETHD_OK);
  ethd_device_close(device);
  ck_assert_str_eq(log_, "oaobsataxbcbca");
  /* what takes torque must let go */
  bare.safe = NULL;
  bare.write = write_a;
  ck_assert_int_eq(open_bare("bare"), ETHD_E_ARGUMENT);
  ck_assert_msg(strstr(message, "bare takes torque and has no safe") != NULL, "%s", message);
}

/* A child made by fork closes its copy of a device, and no driver hears of it. */
TEST(test_forked) {
  int status;
  bare = (ethd_driver){
      .size = sizeof bare, .abi = ETHD_DRIVER_ABI, .id = "bare", .brief = "bare", .open = open_b, .close = close_part};
  ck_assert_int_eq(open_bare("a, bare"), ETHD_OK);
  ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
  const pid_t child = fork();
  if (child == 0) {
    char before[sizeof log_];
    memcpy(before, log_, sizeof log_);
    const int refused = ethd_device_start(device) == ETHD_E_DEVICE && ethd_device_stop(device) == ETHD_E_DEVICE &&
                        ethd_device_home(device, NULL) == ETHD_E_DEVICE;
    ethd_device_close(device);
    _exit(refused && strcmp(before, log_) == 0 ? 0 : 1);
  }
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert_int_eq(status, 0);
  ck_assert_int_eq(ethd_device_stop(device), ETHD_OK);
  ethd_device_close(device);
}

/* ---- settings by a driver's own table ---- */

static const ethd_param params[] = {{"speed", "m/s", 0, 2, 1, "of it"}, {"mood", "good|bad", 0, 1, 0, "of it"}};
static const char *const texts[] = {"map", "port", NULL};
static const ethd_driver settled = {.id = "settled", .params = params, .param_count = 2, .keys = texts};

static const struct {
  const ethd_driver *driver;
  const char *key, *value, *says;
} settings[] = {{&settled, "speed", "1.5", ""},
                {&settled, "mood", "bad", ""},
                {&settled, "port", "x", ""},
                {&settled, "speed", "3", "c.ini:7: device.speed: found \"3\", 0 to 2 m/s is allowed"},
                {&settled, "speed", "nan", "c.ini:7: device.speed: found \"nan\""},
                {&settled, "speed", "1x", "c.ini:7: device.speed: found \"1x\""},
                {&settled, "mood", "sad", "c.ini:7: device.mood: found \"sad\", good|bad is allowed"},
                {&settled, "colour", "red", "c.ini:7: device.colour: settled knows map, port, speed, mood"},
                {&bare, "colour", "red", "c.ini:7: device.colour: bare has no settings"}};

/* A table of the first header of this ABI, at the end of a page before one that can't be read: nothing behind its last
   field is looked at. */
TEST(test_short_table) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  char *at = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ck_assert(at != MAP_FAILED);
  void *table = at + page - ETHD_DRIVER_MIN / 8 * 8;
  memcpy(table, &a, ETHD_DRIVER_MIN);
  ((ethd_driver *)table)->size = ETHD_DRIVER_MIN;
  ck_assert_int_eq(mprotect(at + page, page, PROT_NONE), 0);
  const ethd_driver *const from[] = {table, &b, NULL};
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {&setup, NULL, 0, ".", "c.ini", 1, NULL};
  for (int k = 0; k < 2; k++) {
    ethd_figure f[4];
    ck_assert_int_eq(ethd_device_open(k ? "a, b" : "a", from, &def, &device, message), ETHD_OK);
    ck_assert_int_eq(ethd_device_start(device), ETHD_OK);
    ck_assert_uint_eq(ethd_device_figures(device, f, 4), (unsigned)k); /* b's alone */
    ck_assert(ethd_device_remark(device, 0) == NULL);
    ck_assert_int_eq(ethd_device_stop(device), ETHD_OK);
    ethd_device_close(device);
  }
  munmap(at, 2 * page);
}

TEST_LOOP(test_settings, 0, sizeof settings / sizeof *settings) {
  const ethd_setting one = {settings[_i].key, settings[_i].value, 7}, *text[2] = {NULL, NULL};
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {&setup, &one, 1, ".", "c.ini", 1, NULL};
  double values[2] = {-1, -2};
  bare = (ethd_driver){.id = "bare"};
  message[0] = 0;
  ethd_status status = ethd_settings_read(settings[_i].driver, &def, values, text, message);
  ck_assert_msg(strncmp(message, settings[_i].says, strlen(settings[_i].says)) == 0, "%s", message);
  ck_assert_int_eq(status == ETHD_OK, settings[_i].says[0] == 0);
  ck_assert(values[0] == (_i == 0 ? 1.5 : -1) && values[1] == (_i == 1 ? 1 : -2));
  ck_assert(text[0] == NULL && text[1] == (_i == 2 ? &one : NULL));
}

TEST(test_refused) {
  static const struct {
    const char *ids, *key;
    ethd_status status;
    const char *says;
  } bad[] = {{"c", NULL, ETHD_E_UNKNOWN, "c.ini: device.driver: found \"c\"; a, b and file:PATH are allowed"},
             {"", NULL, ETHD_E_UNKNOWN, "found \"\""},
             {"a,", NULL, ETHD_E_UNKNOWN, "found \"\""},
             {"a b", NULL, ETHD_E_UNKNOWN, "found \"a b\""},
             {"a, a", NULL, ETHD_E_DUPLICATE, "a occurs twice"},
             {"a, b", "port", ETHD_E_UNKNOWN, "c.ini:7: device.port: with several drivers"},
             {"a, b", "c.port", ETHD_E_UNKNOWN, "c.ini:7: device.c.port"}};
  static const char *const twice[][3] = {
      {"b", "port", "b.port"}, {"b", "b.port", "port"}, {"a, b", "b.port", "b.port"}};
  for (size_t i = 0; i < sizeof twice / sizeof *twice; i++) {
    ck_assert_int_eq(try(twice[i][0], twice[i][1], twice[i][2]), ETHD_E_DUPLICATE);
    ck_assert_str_eq(message, "c.ini:8: device.port: occurs twice, first on line 7");
    ck_assert(device == NULL && !strchr(log_, 'b'));
  }
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_int_eq(try(bad[i].ids, bad[i].key, NULL), bad[i].status);
    ck_assert_msg(strstr(message, bad[i].says) != NULL, "%s", message);
    ck_assert(device == NULL);
  }
}
