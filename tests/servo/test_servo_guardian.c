/* Zero torque when the program can't write it any more. The rules on instants that are made up; the process itself
   against a drive without a watchdog, with the program killed, stopped, and ended in order. Times are asserted where
   ETHD_STRESS is set: a busy machine's processes wake when they wake. */
#include <math.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clock.h"
#include "servo/device.h"
#include "servo/mock.h"
#include "servo/words.h"
#include "text/text.h"
#include "unit/rig.h"
#include "unit/suite.h"

#define MS 1000000

static const ethd_driver *const servo = &ethd_driver_servo;
static ethd_setup setup;
static mock drive;
static char message[ETHD_MESSAGE_MAX], folder[] = "/tmp/ethd-guard-XXXXXX";

/* ---- the rules ---- */

TEST(test_bound) {
  ethd__servo_map map = {.response = 0.003, .drain = 0.0008};
  ck_assert_int_eq(ethd__guardian_bound(&map, 1 * MS), 20 * MS);
  ck_assert_int_eq(ethd__guardian_bound(&map, 10 * MS), 20 * MS);
  ck_assert_int_eq(ethd__guardian_bound(&map, 15 * MS), 30 * MS); /* two message spacings */
  map.response = 0.015;
  ck_assert_int_eq(ethd__guardian_bound(&map, 1 * MS) / 1000, 31599);
}

static ethd__servo_map map;
static ethd__servo_plan plan;
static ethd__guardian guardian;
static ethd__guardian_page page;

static void make(int is_rtu) {
  mock_start(&drive, is_rtu);
  ck_assert_msg(ethd__servo_map_load("apps/config/plant.map", "plant.map", &map, message) == ETHD_OK, "%s", message);
  strcpy(map.port, drive.port);
  map.transport = is_rtu ? ETHD__SERVO_RTU : ETHD__SERVO_TCP;
  map.baud = 500000;
  map.response = 0.2;
  map.drain = 0.01;
  ethd__servo_plan_make(&map, &plan);
  ethd__guardian_make(&map, &plan, MS, &guardian);
  memset(&page, 0, sizeof page);
  guardian.page = &page;
}

/* Silence is what the last beat is old, and only while a torque may act. */
TEST(test_due) {
  make(0);
  guardian.limit_ns = 12 * MS;
  const int64_t t = 5000000000;
  page.beat_ns = t;
  ck_assert(!ethd__guardian_due(&guardian, t + 1000 * MS));
  ethd__guardian_arm(&guardian, true);
  ck_assert(!ethd__guardian_due(&guardian, t + 12 * MS));
  ck_assert(ethd__guardian_due(&guardian, t + 12 * MS + 1));
  page.beat_ns = t + 12 * MS;
  ck_assert(!ethd__guardian_due(&guardian, t + 24 * MS));
  ethd__guardian_arm(&guardian, false);
  ck_assert(!ethd__guardian_due(&guardian, t + 1000 * MS));
  /* what is left of the bound is for looking, quiet and the message */
  make(0);
  ck_assert_int_le(guardian.limit_ns, ethd__guardian_bound(&map, MS) * 6 / 10);
  mock_stop(&drive);
}

static atomic_int order[2]; /* requests at which torque and control became zero */
static mock_act note(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  if (!order[0] && !drive.words[MOCK_TORQUE1]) order[0] = (int)n + 1;
  if (!order[1] && !drive.words[MOCK_CONTROL]) order[1] = (int)n + 1;
  return (mock_act){n == 0 ? MOCK_DROP : MOCK_ANSWER, 0, 0}; /* the first one isn't heard */
}

/* Zero first, then [disable], asked again until they are answered, over tcp, rtu, and the other checksum. */
TEST_LOOP(test_act, 0, 3) {
  make(_i > 0);
  if (_i == 2) drive.crc_high = map.crc = ETHD__SERVO_CRC_HIGH_FIRST;
  ethd__guardian_make(&map, &plan, MS, &guardian);
  guardian.page = &page;
  bool at_once;
  ck_assert_msg(ethd__servo_port_open(&map, &guardian.line, &at_once, message) == ETHD_OK, "%s", message);
  drive.words[MOCK_TORQUE1] = 1234;
  drive.words[MOCK_TORQUE2] = 777;
  drive.words[MOCK_CONTROL] = 1;
  drive.words[MOCK_STATUS] = 2;
  order[0] = order[1] = 0;
  drive.act = note;
  ethd__guardian_arm(&guardian, true);
  ck_assert(ethd__guardian_act(&guardian));
  ck_assert_int_eq(drive.words[MOCK_TORQUE1] | drive.words[MOCK_TORQUE2] | drive.words[MOCK_CONTROL], 0);
  ck_assert_int_eq(drive.words[MOCK_STATUS], 0);
  ck_assert_int_eq(page.line, ETHD__GUARDIAN_FREE);
  ck_assert(page.acts == 1 && page.armed == 0 && guardian.line == -1);
  ck_assert(!ethd__guardian_act(&guardian)); /* once */
  mock_stop(&drive);
}

/* ---- the process ---- */

static ethd_status open_servo(void **device) {
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, 2, folder, "d.ini", 0, NULL};
  return servo->open(&def, device, message);
}

/* A program: enables, and pushes until something happens to it. */
static void push(void) {
  void *device;
  if (open_servo(&device) || servo->start(device)) _exit(1);
  for (;;) {
    const ethd_command command = {{0.5, 0.25}, 0, 0};
    (void)!servo->write(device, ethd__clock_now(), &command);
    (void)!servo->service(device, 0, ethd__clock_now());
  }
}

static bool pushes(void) { return drive.words[MOCK_TORQUE1] && drive.words[MOCK_STATUS] & 2; }

static int64_t await(bool (*is)(void), bool wanted) {
  for (int i = 0; i < 30000 && is() != wanted; i++) usleep(1000);
  ck_assert(is() == wanted);
  return ethd__clock_now();
}

/* When set-points came, until they are zero: the last one is that zero, the one before the program's last. */
static _Atomic int64_t latest, last_push;
static mock_act watch(void *user, uint64_t n, int function) {
  (void)user, (void)n;
  if (function == 16 && drive.words[MOCK_TORQUE1]) {
    last_push = latest;
    latest = ethd__clock_now();
  }
  return (mock_act){MOCK_ANSWER, 0, 0};
}

static bool is_quiet(void) { return !drive.words[MOCK_TORQUE1] && !drive.words[MOCK_TORQUE2]; }
static bool is_off(void) { return !(drive.words[MOCK_STATUS] & 2); }

/* A program that is killed, and one that is stopped (a debugger, a deadlock): zero, then disabled. */
TEST_LOOP(test_killed_and_stopped, 0, 3) {
  static const int signals[] = {SIGKILL, SIGSTOP, SIGSEGV};
  int signal_ = signals[_i];
  mock_start(&drive, 0);
  fflush(stdout);
  pid_t program = fork();
  if (program == 0) {
    close(drive.listener);
    push();
  }
  await(pushes, true);
  drive.act = watch;
  usleep(100000);
  kill(program, signal_);
  await(is_quiet, true);
  await(is_off, true);
  double ms = 1e-6 * (double)(latest - last_push);
  printf("%s: zero torque %.1f ms after the last set-point that the drive heard\n", strsignal(signal_), ms);
  const char *stress = getenv("ETHD_STRESS");
  if (stress) ck_assert_double_le(ms, 1e-6 * (double)ethd__guardian_bound(&map, MS) + 1);
  if (signal_ == SIGSTOP) {
    kill(program, SIGCONT); /* and when it goes on, it finds its line gone: nothing pushes any more */
    usleep(300000);
    ck_assert(is_quiet() && is_off());
    kill(program, SIGKILL);
  }
  waitpid(program, NULL, 0);
  mock_stop(&drive);
}

/* Whether a process holds the socket of our descriptor. */
static bool holds(pid_t process, int fd) {
  char path[64], ours[64] = "", its[64];
  snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
  ck_assert_int_gt(readlink(path, ours, sizeof ours - 1), 0);
  for (int i = 0; i < 256; i++) {
    memset(its, 0, sizeof its);
    snprintf(path, sizeof path, "/proc/%d/fd/%d", (int)process, i);
    if (readlink(path, its, sizeof its - 1) > 0 && !strcmp(its, ours)) return true;
  }
  return false;
}

/* In order: nothing is left to do, and no process stays. */
TEST(test_ended) {
  void *device;
  mock_start(&drive, 0);
  ck_assert_msg(open_servo(&device) == ETHD_OK, "%s", message);
  const ethd__servo_device *d = device;
  pid_t process = d->guardian.process;
  ck_assert_int_gt(process, 0);
  ck_assert(!holds(process, drive.listener)); /* from the first moment: a port that we close is closed */
  ck_assert_int_eq(kill(process, 0), 0);
  bool said = false;
  for (uint32_t i = 0; servo->remark(device, i); i++)
    said |= strstr(servo->remark(device, i), "a guardian process writes zero torque within") != NULL;
  ck_assert(said);
  /* what ends a program by its terminal or its manager doesn't end the guardian first */
  for (int s = 1; s < 16; s++)
    if (s == SIGTERM || s == SIGINT || s == SIGHUP || s == SIGQUIT) kill(process, s);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  for (int i = 0; i < 100; i++) {
    const ethd_command command = {{0.5, 0.25}, 0, 0};
    (void)!servo->write(device, ethd__clock_now(), &command);
    (void)!servo->service(device, 0, ethd__clock_now());
  }
  ck_assert(pushes());
  ck_assert_int_eq(servo->stop(device), ETHD_OK);
  ck_assert_uint_eq(d->guardian.page->acts, 0);
  ck_assert_int_eq(kill(process, 0), 0);
  servo->close(device);
  ck_assert_int_eq(kill(process, 0), -1);
  mock_stop(&drive);
}

/* The drive is unplugged and found again: the guardian follows to the new connection. */
TEST(test_follows) {
  void *device;
  mock_start(&drive, 0);
  ck_assert_msg(open_servo(&device) == ETHD_OK, "%s", message);
  mock_unplug(&drive);
  for (int i = 0; i < 20; i++) (void)!servo->service(device, 0, ethd__clock_now());
  mock_plug(&drive);
  for (int i = 0; i < 2000 && servo->start(device); i++) usleep(1000);
  ethd__servo_device *d = device;
  for (int i = 0; i < 100; i++) {
    const ethd_command command = {{0.5, 0.25}, 0, 0};
    (void)!servo->write(device, ethd__clock_now(), &command);
    (void)!servo->service(device, 0, ethd__clock_now());
  }
  ck_assert(pushes());
  await(is_quiet, true); /* we are silent now */
  await(is_off, true);
  for (int i = 0; i < 2000 && !d->guardian.page->acts; i++) usleep(1000);
  ck_assert_uint_eq(d->guardian.page->acts, 1);
  (void)!servo->service(device, 0, ethd__clock_now());
  ck_assert_int_eq(d->link.state, ETHD__SERVO_DOWN);
  ck_assert(strstr(d->link.message, "the guardian has taken the line") || strstr(d->link.message, "refused"));
  int good = ETHD_E_DEVICE; /* and enabling is a way out */
  for (int i = 0; i < 2000 && good; i++) good = servo->start(device), usleep(1000);
  ck_assert_int_eq(good, ETHD_OK);
  ck_assert_int_eq(servo->stop(device), ETHD_OK);
  servo->close(device);
  mock_stop(&drive);
}

/* The plant's map without a watchdog. A busy machine's drive answers late, and how late isn't what is tried: only where
   times are asserted do answers have the map's own time. */
static int write_map(const char *path) {
  char *text, *all;
  size_t length;
  if (ethd_text_read("apps/config/plant.map", 1 << 16, &text, &length, message)) return 1;
  char *at = strstr(text, "kind = silence"), *rest = strstr(text, "time = 0.05"),
       *response = strstr(text, "response = ");
  if (!getenv("ETHD_STRESS")) memcpy(response, "response = 0.5  ", strlen("response = 0.003"));
  if (asprintf(&all, "%.*skind = none\n%s", (int)(at - text), text, strchr(rest, '\n') + 1) < 0) return 1;
  ethd_status status = ethd_text_write(path, all, strlen(all), message);
  free(text);
  free(all);
  return status != ETHD_OK;
}

static char path[64];

int suite_begin(void) {
  const struct sched_param first = {.sched_priority = 50};
  if (getenv("ETHD_STRESS")) (void)!sched_setscheduler(0, SCHED_FIFO, &first); /* a drive has a processor of its own */
  signal(SIGPIPE, SIG_IGN); /* the drive answers to programs that were killed */
  if (!mkdtemp(folder)) return 1;
  snprintf(path, sizeof path, "%s/plant.map", folder);
  return write_map(path) || ethd__servo_map_load(path, path, &map, message);
}

int suite_end(int failed) {
  unlink(path);
  rmdir(folder);
  return failed;
}
