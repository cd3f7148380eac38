/* Homing on a joint of the paper's size with dry friction and two stops, sampled as a slow bus samples it; and a servo
   whose joints must be found before it is enabled. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "servo/driven.h"
#include "servo/homing.h"
#include "text/text.h"

#define INERTIA 0.01
#define FRICTION 0.06
#define STEP 1e-4

typedef struct joint {
  double q, w;
  double from, to;      /* stops */
  double sense;         /* 1, or -1: its encoder counts the other way round */
  double fastest, most; /* rad/s, Nm that it saw */
  bool stuck;
} joint;

static void move(joint *j, double torque, double seconds) {
  j->most = fmax(j->most, fabs(torque));
  for (double t = 0; t < seconds - STEP / 2 && !j->stuck; t += STEP) {
    if (j->w == 0 && fabs(torque) <= FRICTION) continue;
    double push = torque - copysign(FRICTION, j->w != 0 ? j->w : torque), w = j->w + push / INERTIA * STEP;
    j->w = j->w * w < 0 ? 0 : w;
    j->q += j->w * STEP;
    if (j->q < j->from || j->q > j->to) j->q = fmin(fmax(j->q, j->from), j->to), j->w = 0;
    j->fastest = fmax(j->fastest, fabs(j->w));
  }
}

static double encoder(const joint *j) { return j->sense * COUNT * rint(j->q / COUNT); }

/* s that it took; what came of it in *status. */
static double home(joint *j, const ethd__homing_def *def, ethd__homing *h, double dt, ethd_status *status) {
  double torque = 0, mark = 0.2345, t = 0, before = j->q;
  memset(h, 0, sizeof *h);
  for (; t < 120; t += dt) {
    bool passed = (before - mark) * (j->q - mark) < 0;
    before = j->q;
    *status = ethd__homing_turn(def, h, encoder(j), dt, passed, &torque);
    if (*status != ETHD_STATUS_BUSY) return t;
    move(j, torque, dt);
  }
  return t;
}

static const double paces[] = {0.001, 0.004, 0.010};

/* Both ways, from the middle and from either stop, by 1 to 10 ms an exchange: at the stop, at three times the speed at
   most, with no more torque. */
TEST_LOOP(test_stop, 0, 3) {
  for (int way = -1; way <= 1; way += 2)
    for (int from = -1; from <= 1; from++) {
      joint j = {.q = from * 0.5, .from = -0.5, .to = 0.5, .sense = 1};
      const ethd__homing_def def = {ETHD__HOMING_STOP, way, 0.1, 0.18};
      ethd__homing h;
      ethd_status status;
      double took = home(&j, &def, &h, paces[_i], &status);
      ck_assert_msg(status == ETHD_OK, "%s", h.failure);
      ck_assert_double_eq_tol(j.q, way * 0.5, 1e-9);
      ck_assert_double_le(j.fastest, 0.3);
      ck_assert_double_le(j.most, 0.18 + 1e-12);
      ck_assert_double_le(took, 15);
    }
}

TEST(test_mark) {
  joint j = {.q = -0.1, .from = -0.5, .to = 0.5, .sense = 1};
  const ethd__homing_def def = {ETHD__HOMING_INDEX, 1, 0.1, 0.18}, wrong = {ETHD__HOMING_INDEX, -1, 0.1, 0.18};
  ethd__homing h;
  ethd_status status;
  home(&j, &def, &h, 0.004, &status);
  ck_assert_int_eq(status, ETHD_OK);
  ck_assert_double_eq_tol(j.q, 0.2345, 2 * 0.1 * 0.004);
  j = (joint){.q = -0.1, .from = -0.5, .to = 0.5, .sense = 1};
  home(&j, &wrong, &h, 0.004, &status);
  ck_assert_int_eq(status, ETHD_E_DEVICE);
  ck_assert_msg(strstr(h.failure, "before its index mark"), "%s", h.failure);
}

/* An encoder that stands, one that is reversed, a torque under the friction: no stop is found where there is none. */
TEST(test_not_found) {
  const ethd__homing_def def = {ETHD__HOMING_STOP, 1, 0.1, 0.18}, weak = {ETHD__HOMING_STOP, 1, 0.1, 0.05};
  joint stuck = {.from = -0.5, .to = 0.5, .sense = 1, .stuck = true}, turned = {.from = -5, .to = 5, .sense = -1},
        still = {.from = -0.5, .to = 0.5, .sense = 1};
  ethd__homing h;
  ethd_status status;
  home(&stuck, &def, &h, 0.004, &status);
  ck_assert(status == ETHD_E_DEVICE && strstr(h.failure, "doesn't move"));
  home(&still, &weak, &h, 0.004, &status);
  ck_assert(status == ETHD_E_DEVICE && strstr(h.failure, "doesn't move"));
  double took = home(&turned, &def, &h, 0.004, &status);
  ck_assert(status == ETHD_E_DEVICE && strstr(h.failure, "runs away"));
  ck_assert_double_le(took, 1);
  ck_assert_double_le(turned.fastest, 1.2); /* ten times the speed, and a sample */
}

/* ---- a servo whose counts begin anew with its power ---- */

static ethd_status open_servo(const ethd_setting *more, uint32_t count) {
  ethd_setting settings[8] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  if (count) memcpy(settings + 2, more, count * sizeof *more);
  now = 0;
  return open_with(settings, 2 + count);
}

static ethd_sense sensed(void) {
  (void)tick(0, 0);
  return sense;
}

static void count(int at, int64_t n) {
  drive.words[at] = (uint16_t)(n >> 16);
  drive.words[at + 1] = (uint16_t)n;
}

static void refused_for(int which) {
  char says[64];
  int control = drive.words[MOCK_CONTROL];
  snprintf(says, sizeof says, "the angle of joint %d is unknown", which);
  ck_assert_int_eq(servo->start(device), ETHD_E_DEVICE);
  ck_assert_msg(strstr(servo->why(device), says), "%s", servo->why(device));
  ck_assert_int_eq(drive.words[MOCK_CONTROL], control); /* nothing was written for it */
}

/* In the jig: said when it is opened, or by the command; lost with the connection, and with a counter that
   begins anew. */
TEST(test_reference) {
  const double jig[2] = {0.7, -0.3};
  mock_start(&drive, 0);
  count(MOCK_POSITION1, 500);
  ck_assert_msg(open_servo(NULL, 0) == ETHD_OK, "%s", message);
  refused_for(1);
  ck_assert_int_eq(servo->home(device, NULL), ETHD_E_DEVICE);
  ck_assert_msg(strstr(servo->why(device), "device.home is jig"), "%s", servo->why(device));
  ck_assert_int_eq(servo->home(device, jig), ETHD_OK);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  ethd_sense s = sensed();
  ck_assert(fabs(s.q[0] - 0.7) < 1e-12 && fabs(s.q[1] + 0.3) < 1e-12);
  count(MOCK_POSITION1, 520);
  s = sensed();
  ck_assert_double_eq_tol(s.q[0], 0.7 + 20 * COUNT, 1e-12);
  /* unplugged: who knows what happened meanwhile */
  mock_unplug(&drive);
  for (int i = 0; i < 20; i++) sensed();
  mock_plug(&drive);
  for (int i = 0; i < 5000 && ((ethd__servo_device *)device)->link.state < ETHD__SERVO_IDENTIFIED; i++)
    sensed(), usleep(100);
  refused_for(1);
  ck_assert_int_eq(servo->home(device, jig), ETHD_OK);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  /* its counter begins anew on a line that stays: 46 cm at the paper's ring, and no pose to trust */
  sensed(); /* the start was by another clock, after which no step is a jump */
  count(MOCK_POSITION1, 72000);
  for (int i = 0; i < 3000; i++) s = sensed();
  servo->safe(device);
  for (int i = 0; i < 10; i++) sensed();
  refused_for(1);
  servo->close(device);
  mock_stop(&drive);
}

/* Given in the configuration, the arm in its jig when the program begins; or for one joint only. */
TEST(test_given) {
  mock_start(&drive, 0);
  ethd_setting both[] = {{"q1", "0.7", 3}, {"q2", "-0.3", 4}};
  ck_assert_msg(open_servo(both, 2) == ETHD_OK, "%s", message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  servo->close(device);
  ck_assert_msg(open_servo(both, 1) == ETHD_OK, "%s", message);
  drive.words[MOCK_CONTROL] = drive.words[MOCK_STATUS] = 0;
  refused_for(2);
  servo->close(device);
  static const struct {
    ethd_setting one;
    const char *says;
  } bad[] = {{{"home", "floor", 3}, "d.ini:3: device.home: found \"floor\", jig|stop|index"},
             {{"home", "stop", 3}, "device.q1 is missing: its angle at the stop"},
             {{"home_way1", "0.5", 3}, "device.home_way1: found \"0.5\", 1|-1 is allowed"},
             {{"home_torque", "-1", 3}, "d.ini:3: device.home_torque"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_int_lt(open_servo(&bad[i].one, 1), 0);
    ck_assert_msg(strstr(message, bad[i].says) && !strchr(message, '\n'), "%s", message);
  }
  ethd_setting index[] = {{"q1", "0.7", 3}, {"q2", "-0.3", 4}, {"home", "index", 5}};
  ck_assert_int_lt(open_servo(index, 3), 0);
  ck_assert_msg(strstr(message, "device.home = index needs a [register index1] in plant.map"), "%s", message);
  mock_stop(&drive);
}

/* A drive whose joints turn while it is enabled and pushes: 5 counts a set-point, past a mark at 1203. */
#define MARK 1203
static mock_act turning(void *user, uint64_t n, int function) {
  static int64_t at[2];
  (void)user;
  if (n == 0) at[0] = at[1] = 0;
  for (int i = 0; i < 2 && function == 16 && drive.words[MOCK_STATUS] & 2; i++) {
    int16_t torque = (int16_t)drive.words[MOCK_TORQUE1 + i];
    int64_t before = at[i];
    at[i] += torque > 0 ? 5 : torque < 0 ? -5 : 0;
    if ((before < MARK) != (at[i] < MARK)) count(i ? 22 : 20, MARK);
    count(i ? MOCK_POSITION2 : MOCK_POSITION1, at[i]);
  }
  return (mock_act){MOCK_ANSWER, 0, 0};
}

/* By index marks, through the driver: what the joint went past its mark while the answer was under way counts. */
TEST(test_index) {
  char *text, *all, path[64];
  size_t length;
  snprintf(path, sizeof path, "%s/plant.map", folder);
  ck_assert_int_eq(ethd_text_read(path, 1 << 16, &text, &length, message), ETHD_OK);
  const char marks[] = "direction = read\ntype = i32\norder = high-first\nunit = count\ncounts = 4000\nratio = 9.80\n";
  char *at = strstr(text, "[enable]");
  ck_assert_int_ge(asprintf(&all, "%.*s[register index1]\naddress = 20\n%s[register index2]\naddress = 22\n%s%s",
                            (int)(at - text), text, marks, marks, at),
                   0);
  ck_assert_int_eq(ethd_text_write(path, all, strlen(all), message), ETHD_OK);
  free(all);
  mock_start(&drive, 0);
  drive.act = turning;
  ethd_setting index[] = {{"q1", "0.7", 3}, {"q2", "-0.3", 4}, {"home", "index", 5}, {"home_speed", "1", 6}};
  ck_assert_msg(open_servo(index, 4) == ETHD_OK, "%s", message);
  refused_for(1);
  ck_assert_msg(servo->home(device, NULL) == ETHD_OK, "%s", servo->why(device));
  ck_assert(!(drive.words[MOCK_STATUS] & 2)); /* it is off again */
  drive.act = (mock_plan)0;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  const ethd_sense s = sensed();
  for (int i = 0; i < 2; i++) {
    const _Atomic uint16_t *w = drive.words + (i ? MOCK_POSITION2 : MOCK_POSITION1);
    double past = (double)((int32_t)((uint32_t)w[0] << 16 | w[1]) - MARK) * COUNT;
    ck_assert(past > 1.5 * COUNT && past < 0.02);
    ck_assert_double_eq_tol(s.q[i], (i ? -0.3 : 0.7) + past, 1e-9);
  }
  servo->close(device);
  mock_stop(&drive);
  ck_assert_int_eq(ethd_text_write(path, text, length, message), ETHD_OK);
  free(text);
}

/* A map whose positions aren't absolute. */
static void set_up(void) {
  char path[64];
  driven_set_up();
  char *text = map_text();
  for (char *at; (at = strstr(text, "absolute = yes"));) memcpy(at, "absolute = no ", 14);
  snprintf(path, sizeof path, "%s/plant.map", folder);
  ck_assert_int_eq(ethd_text_write(path, text, strlen(text), message), ETHD_OK);
  free(text);
}

FIXTURE(set_up, driven_tear_down)
