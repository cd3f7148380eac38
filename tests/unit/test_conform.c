/* A driver that keeps its contract, and one that breaks it in each way that is asked for. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/conform.h"
#include "unit/suite.h"

enum {
  SOUND,
  NO_SAFE,
  NO_SERVICE,
  NO_BRIEF,
  BAD_TABLE,
  LEAKS,
  NO_LIMIT,
  OUTSIDE,
  NAN_ANGLE,
  BACKWARDS,
  FAULTY,
  DRIFTS,
  REVERSED,
  JUMPS,
  NO_WATCHDOG,
  UNSAFE,
  OLD_TORQUE,
  COUNTED,
  COARSE,
  COASTS,
  BLOCKED,
  ROLLS,   /* the torque acts until 10 ms after its stop, and without friction it rolls on */
  LATCHES, /* its own watchdog leaves a fault, which refuses the next start until it is cleared */
  WAYS
};

static int way;
static int latched, clearing;
static int halts, opened, starts_after, pushes_after,
    safe_after; /* a signal comes while a joint is pushed: what follows it */
static volatile int halted;
static double coasting[2]; /* rad/s, that a closed device keeps */

typedef struct fake {
  double q[2], w[2], torque[2], home[2];
  int64_t now, written, ticks;
  int safe;
} fake;

static ethd_status open_fake(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  fake *f = calloc(1, sizeof *f);
  (void)message;
  opened++;
  *device = f;
  if (way == LEAKS) (void)!dup(0);
  if (way == COASTS) memcpy(f->w, coasting, sizeof f->w);
  ethd_status status = ethd_arm_angles(&def->setup->arm, (ethd_vec){0.25, 0.25}, -1, f->q);
  memcpy(f->home, f->q, sizeof f->home);
  return status;
}

static ethd_status start(void *device) {
  fake *f = device;
  starts_after += halted;
  if (latched) return ETHD_E_DEVICE;
  f->safe = 0;
  f->now = 0;
  if (way != COASTS && way != ROLLS) f->w[0] = f->w[1] = 0;
  if (way != OLD_TORQUE) f->torque[0] = f->torque[1] = 0;
  return ETHD_OK;
}

static ethd_status read_fake(void *device, int64_t now, ethd_sense *out) {
  fake *f = device;
  double dt = f->now ? 1e-9 * (double)(now - f->now) : 0;
  int alive = (!f->safe || way == UNSAFE) && (now - f->written <= 20000000 || way == NO_WATCHDOG || way == BLOCKED);
  latched |= way == LATCHES && !f->safe && !alive && f->torque[0] != 0;
  f->now = now;
  for (int i = 0; i < 2; i++) {
    f->w[i] += dt / 0.02 * (alive ? f->torque[i] : 0) * (way == REVERSED && i ? -1 : 1) + (way == DRIFTS ? dt * 5 : 0);
    out->q[i] = f->q[i] += dt * f->w[i];
  }
  /* friction: 2 rad/s^2 */
  for (int i = 0; i < 2 && way == COASTS; i++) f->w[i] -= copysign(fmin(fabs(f->w[i]), 2 * dt), f->w[i]);
  if (way == COASTS) memcpy(coasting, f->w, sizeof coasting);
  for (int i = 0; i < 2 && way == BLOCKED; i++)
    if (fabs(f->q[i] - f->home[i]) > 0.02)
      f->w[i] = 0, out->q[i] = f->q[i] = f->home[i] + copysign(0.02, f->q[i] - f->home[i]);
  for (int i = 0; i < 2 && way == COARSE; i++) out->q[i] = rint(f->q[i] / 0.002) * 0.002;
  if (way == JUMPS && ++f->ticks == 50) f->q[0] += 1;
  if (way == NAN_ANGLE && ++f->ticks == 50) out->q[1] = (double)NAN;
  out->time_ns = way == BACKWARDS && ++f->ticks == 50 ? now - 5000000 : now;
  if (way == FAULTY) out->faults = ETHD_FAULT_BIT(ETHD_FAULT_DRIVE);
  if (way == COUNTED) out->faults = ETHD_FAULT_BIT(ETHD_FAULT_REPLY_MISSING);
  return ETHD_OK;
}

static ethd_status write_fake(void *device, int64_t now, const ethd_command *command) {
  fake *f = device;
  memcpy(f->torque, command->torque, sizeof f->torque);
  f->written = now;
  const bool pushes = command->torque[0] != 0 || command->torque[1] != 0;
  pushes_after += halted && pushes;
  if (halts && pushes && !--halts) halted = 1;
  return ETHD_OK;
}

static void safe(void *device) {
  ((fake *)device)->safe = 1;
  safe_after += halted;
}

static void close_fake(void *device) {
  opened--;
  free(device);
}
static ethd_status stop(void *device) {
  fake *f = device;
  for (int i = 0; i < 2 && way == ROLLS; i++) f->w[i] += 0.01 / 0.02 * f->torque[i];
  return safe(device), ETHD_OK;
}
static void clear(void *device) { (void)device, clearing = 1; }
static ethd_status service(void *device, uint32_t unit, int64_t now) {
  (void)device, (void)unit, (void)now;
  if (clearing) latched = clearing = 0;
  return ETHD_OK;
}
static uint32_t one(const void *device) { return (void)device, 1; }
static ethd_limits limits(const void *device) {
  ethd_limits l = ethd_limits_none();
  (void)device;
  l.torque = way == NO_LIMIT ? (double)INFINITY : 1;
  if (way == OUTSIDE) l.workspace[1] = 0.2;
  return l;
}

static uint32_t none(const void *device) { return (void)device, 0; }
static const ethd_param unnamed = {"", "1", 0, 1, 0, "without a name"};

/* With OLD_TORQUE the start forgets nothing: the driver begins with what it was told last. */
static ethd_verdict ask(const char *question, double torque, ethd_status *status) {
  static ethd_driver driver;
  static ethd_conform_answer answers[ETHD_QUESTIONS];
  driver = (ethd_driver){.size = sizeof driver,
                         .abi = ETHD_DRIVER_ABI,
                         .id = "fake",
                         .brief = way == NO_BRIEF ? "" : "fake",
                         .open = open_fake,
                         .start = start,
                         .read = read_fake,
                         .write = write_fake,
                         .safe = way == NO_SAFE ? NULL : safe,
                         .stop = stop,
                         .close = close_fake,
                         .units = way == NO_SERVICE ? none
                                  : way == LATCHES  ? one
                                                    : NULL,
                         .service = way == LATCHES ? service : NULL,
                         .clear = clear,
                         .params = &unnamed,
                         .param_count = way == BAD_TABLE,
                         .limits = limits};
  const ethd_driver *const from[] = {&driver, NULL};
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def device = {&setup, NULL, 0, ".", NULL, 1, NULL};
  const ethd_conform_def def = {"fake", from, &device, torque, &halted};
  *status = ethd_conform(&def, answers);
  for (int i = 0; i < ETHD_QUESTIONS; i++) {
    ck_assert_msg(answers[i].found[0], "%s says nothing", answers[i].question);
    if (!strcmp(answers[i].question, question)) return answers[i].verdict;
  }
  ck_abort_msg("%s isn't asked", question);
  return ETHD_VERDICT_BROKEN;
}

static const struct {
  const char *question;
  ethd_verdict verdict;
} expected[WAYS] = {[NO_SAFE] = {"table", ETHD_VERDICT_BROKEN},   [NO_SERVICE] = {"table", ETHD_VERDICT_BROKEN},
                    [NO_BRIEF] = {"table", ETHD_VERDICT_BROKEN},  [BAD_TABLE] = {"table", ETHD_VERDICT_BROKEN},
                    [LEAKS] = {"open", ETHD_VERDICT_BROKEN},      [NO_LIMIT] = {"limits", ETHD_VERDICT_AT_RISK},
                    [OUTSIDE] = {"limits", ETHD_VERDICT_BROKEN},  [NAN_ANGLE] = {"sense", ETHD_VERDICT_BROKEN},
                    [BACKWARDS] = {"sense", ETHD_VERDICT_BROKEN}, [FAULTY] = {"sense", ETHD_VERDICT_BROKEN},
                    [DRIFTS] = {"zero", ETHD_VERDICT_BROKEN},     [REVERSED] = {"sign", ETHD_VERDICT_BROKEN},
                    [JUMPS] = {"counts", ETHD_VERDICT_BROKEN},    [NO_WATCHDOG] = {"watchdog", ETHD_VERDICT_AT_RISK},
                    [UNSAFE] = {"safe", ETHD_VERDICT_BROKEN},     [OLD_TORQUE] = {"restart", ETHD_VERDICT_BROKEN},
                    [COUNTED] = {"sense", ETHD_VERDICT_AT_RISK},  [COARSE] = {"watchdog", ETHD_VERDICT_NOT_ASKED},
                    [COASTS] = {"restart", ETHD_VERDICT_KEPT},    [BLOCKED] = {"watchdog", ETHD_VERDICT_NOT_ASKED},
                    [ROLLS] = {"restart", ETHD_VERDICT_KEPT},     [LATCHES] = {"restart", ETHD_VERDICT_KEPT}};

TEST_LOOP(test_way, SOUND + 1, WAYS) {
  ethd_status status;
  way = _i;
  ck_assert_int_eq(ask(expected[_i].question, 0.1, &status), expected[_i].verdict);
  ck_assert_int_eq(status, expected[_i].verdict == ETHD_VERDICT_BROKEN ? ETHD_E_DEVICE : ETHD_OK);
}

TEST(test_sound) {
  static const char *const all[] = {"table", "open",   "limits",   "sense", "zero",
                                    "sign",  "counts", "watchdog", "safe",  "restart"};
  ethd_status status;
  way = SOUND;
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) ck_assert_int_eq(ask(all[i], 0.1, &status), ETHD_VERDICT_KEPT);
  ck_assert_int_eq(ask("silence", 0.1, &status), ETHD_VERDICT_NOT_ASKED); /* on a virtual clock */
  ck_assert_int_eq(status, ETHD_OK);
  const double none[] = {0, -0.1, NAN, INFINITY};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    ck_assert_int_eq(ask("sign", none[i], &status), ETHD_VERDICT_NOT_ASKED);
  ck_assert_int_eq(ask("zero", 0, &status), ETHD_VERDICT_KEPT);
}

/* Stopped at any push: no torque and no start follow, the device is made safe and closed, and the rest isn't asked. */
TEST(test_stopped) {
  static const int at[] = {1, 2, 100, 101, 350, 500, 700, 900};
  for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
    ethd_status status;
    way = SOUND;
    halts = at[i];
    halted = opened = starts_after = pushes_after = safe_after = 0;
    ck_assert_int_eq(ask("restart", 0.1, &status), ETHD_VERDICT_NOT_ASKED);
    ck_assert_int_eq(status, ETHD_E_UNFINISHED);
    ck_assert(halted && !starts_after && !pushes_after && safe_after > 0);
    ck_assert_int_eq(opened, 0);
  }
}
