/* The questions to a device in space, asked of drivers that keep the contract, and of those that break it. */
#include <string.h>
#include <time.h>

#include "ethd/conform.h"
#include "unit/mover_driver.h"
#include "unit/suite.h"

static ethd_driver driver;
static const ethd_driver *const only[] = {&driver, NULL};
static ethd_conform_answer answers[ETHD_SPACE_QUESTIONS];

static ethd_status ask(double push) {
  static ethd_space_setup setup;
  setup = ethd_space_setup_default();
  setup.speed = 0.5;
  setup.acceleration = 20;
  const ethd_device_def device = {.is_virtual = 1, .space = &setup};
  const ethd_conform_def def = {"mover", only, &device, push, NULL};
  return ethd_conform_space(&def, answers);
}

static const ethd_conform_answer *answer(const char *question) {
  for (int i = 0; i < ETHD_SPACE_QUESTIONS; i++)
    if (!strcmp(answers[i].question, question)) return &answers[i];
  ck_abort_msg("no question %s", question);
}

static ethd_status start_short(void *device) {
  ((mover_device *)device)->travel = 0.2;
  return mover_driver.start(device);
}

TEST(test_keeps) {
  driver = mover_driver;
  driver.start = start_short;
  ck_assert_int_eq(ask(0.2), ETHD_OK);
  for (int i = 0; i < ETHD_SPACE_QUESTIONS; i++)
    ck_assert_msg(answers[i].verdict == ETHD_VERDICT_KEPT, "%s: %s", answers[i].question, answers[i].found);
  ck_assert_str_eq(answer("table")->found, "mover; safe: zero speed");
  ck_assert_msg(strstr(answer("ends")->found, "it stopped after 0.2 to 0.2 m, at most"), "%s", answer("ends")->found);
  ck_assert_int_eq(ask(0), ETHD_OK); /* nothing may move */
  ck_assert_int_eq(answer("axes")->verdict, ETHD_VERDICT_NOT_ASKED);
  ck_assert_int_eq(answer("zero")->verdict, ETHD_VERDICT_KEPT);
}

/* The setup's limit is the most that is asked for: 0.5 m/s, of which the device takes 0.3 and says so. */
static ethd_status start_slow(void *device) {
  ((mover_device *)device)->speed = 0.3;
  return mover_driver.start(device);
}
TEST(test_cuts_and_says_so) {
  driver = mover_driver;
  driver.start = start_slow;
  ck_assert_int_eq(ask(9), ETHD_OK);
  ck_assert_msg(!strncmp(answer("axes")->found, "0.5 m/s along each axis", 23), "%s", answer("axes")->found);
}

/* A device that moves in a plane alone, and has no end there. */
static ethd_ability able_in_plane(const void *device, const double n[3]) ETHD_RT {
  (void)device;
  return (ethd_ability){.speed = n[2] != 0 ? 0 : 1};
}
static ethd_status write_in_plane(void *device, int64_t now, const ethd_space_command *command) ETHD_RT {
  ethd_space_command other = *command;
  other.value[2] = 0;
  return mover_driver.write_space(device, now, &other);
}
TEST(test_a_plane_without_end) {
  driver = mover_driver;
  driver.able = able_in_plane;
  driver.write_space = write_in_plane;
  ck_assert_int_eq(ask(0.2), ETHD_OK);
  ck_assert_int_eq(answer("axes")->verdict, ETHD_VERDICT_KEPT);
  ck_assert_int_eq(answer("ends")->verdict, ETHD_VERDICT_AT_RISK);
  ck_assert_str_eq(answer("ends")->found, "direction +1: no end of its travel within 3 m");
}

/* ---- what breaks it ---- */

static ethd_status read_silent(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  const ethd_status status = mover_driver.read_space(device, now, out);
  out->have &= ~ETHD_SPACE_HAVE_COMMANDED;
  return status;
}
static ethd_status read_ahead(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  return mover_driver.read_space(device, now + 5000000, out);
}
static ethd_status read_stale(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  return (void)device, (void)now, (void)out, ETHD_STATUS_STALE;
}
static ethd_status read_blocks(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  const struct timespec t = {.tv_nsec = 700000};
  nanosleep(&t, NULL);
  return mover_driver.read_space(device, now, out);
}
static ethd_status write_mirrored(void *device, int64_t now, const ethd_space_command *command) ETHD_RT {
  ethd_space_command other = *command;
  other.value[2] = -other.value[2];
  return mover_driver.write_space(device, now, &other);
}
static ethd_status write_drifting(void *device, int64_t now, const ethd_space_command *command) ETHD_RT {
  ethd_space_command other = *command;
  other.value[1] += 0.02;
  return mover_driver.write_space(device, now, &other);
}
static void safe_not(void *device) ETHD_RT { (void)device; }
static ethd_status start_badly(void *device) { return ((mover_device *)device)->starts++ ? ETHD_E_DEVICE : ETHD_OK; }

/* It stops at its end without saying so; it never comes back. */
static ethd_status read_silent_end(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  mover_device *d = device;
  d->travel = 0.2;
  return read_silent(device, now, out);
}
static ethd_status write_sticks(void *device, int64_t now, const ethd_space_command *command) ETHD_RT {
  mover_device *d = device;
  if (ethd_vec3_norm(d->at) > 0.1) d->speed = 0;
  return mover_driver.write_space(device, now, command);
}

static const struct {
  const char *question;
  ethd_driver change; /* its functions take the place of the mover's */
} breaks[] = {{"sense", {.read_space = read_ahead}},     {"sense", {.read_space = read_stale}},
              {"calls", {.read_space = read_blocks}},    {"axes", {.write_space = write_mirrored}},
              {"zero", {.write_space = write_drifting}}, {"safe", {.safe = safe_not}},
              {"restart", {.start = start_badly}},       {"axes", {.read_space = read_silent, .start = start_slow}},
              {"ends", {.read_space = read_silent_end}}, {"ends", {.write_space = write_sticks}}};

TEST_LOOP(test_breaks, 0, sizeof breaks / sizeof *breaks) {
  const ethd_driver *change = &breaks[_i].change;
  driver = mover_driver;
  if (change->start) driver.start = change->start;
  if (change->safe) driver.safe = change->safe;
  if (change->read_space) driver.read_space = change->read_space;
  if (change->write_space) driver.write_space = change->write_space;
  ck_assert_int_eq(ask(0.5), ETHD_E_DEVICE);
  const ethd_conform_answer *a = answer(breaks[_i].question);
  ck_assert_msg(a->verdict == ETHD_VERDICT_BROKEN, "%s: %s", a->question, a->found);
}

TEST(test_no_device) {
  driver = mover_driver;
  driver.safe = NULL;
  ck_assert_int_eq(ask(0.2), ETHD_E_DEVICE);
  ck_assert_int_eq(answer("table")->verdict, ETHD_VERDICT_BROKEN);
  ck_assert_int_eq(answer("safe")->verdict, ETHD_VERDICT_NOT_ASKED);
}

TEST(test_says_its_safe_state) {
  driver = mover_driver;
  driver.safe_is = ETHD_SAFE_BRAKES;
  ck_assert_int_eq(ask(0.2), ETHD_OK);
  ck_assert_str_eq(answer("table")->found, "mover; safe: brakes");
}
