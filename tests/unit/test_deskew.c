/* Rays that are measured one after another while finger and ring move: the estimate with and without their
   lags told in the setup. */
#include <math.h>
#include <stdio.h>

#include "draw.h"
#include "ethd/config.h"
#include "proximity_ring/frame.h"
#include "unit/rig.h"

#define LATENCY_NS 2000000
#define NOISE 0.03e-3

/* The finger swings in x; the ring swings about it, or beside a finger that it doesn't follow. m, m/s. */
typedef struct swing {
  double finger, finger_speed; /* 0: at rest */
  double ring, ring_speed;     /* against the finger */
} swing;

static double swung(double amplitude, double speed, double t) {
  return amplitude > 0 ? amplitude * sin(speed / amplitude * t) : 0;
}

static ethd_vec finger_at(const swing *s, double t) {
  return (ethd_vec){0.25 + swung(s->finger, s->finger_speed, t), 0.25};
}

static ethd_vec ring_at(const swing *s, double t) {
  ethd_vec finger = finger_at(s, t);
  return (ethd_vec){finger.x + swung(s->ring, s->ring_speed, t), finger.y};
}

/* Ray by ray round the ring in 3.3 ms, or as the boards do it, four at a time. */
static void lags(int boards, double out[ETHD_RAYS]) {
  for (int k = 0; k < ETHD_RAYS; k++)
    out[k] = boards ? 1e-6 * ETHD__FRAME_SLOT_US * (1.5 - ETHD__FRAME_SLOT(k)) : 3.3e-3 * (0.5 - k / 15.0);
}

static void take(const swing *s, const double lag[ETHD_RAYS], int64_t sample_ns, uint64_t frame,
                 double rays[ETHD_RAYS]) {
  for (uint64_t k = 0; k < ETHD_RAYS; k++) {
    double t = 1e-9 * (double)sample_ns - lag[k], all[ETHD_RAYS];
    ethd_fit_rays(0.012, 0.0075, ethd_vec_sub(finger_at(s, t), ring_at(s, t)), all);
    rays[k] = all[k] + NOISE * draw_normal(frame * ETHD_RAYS + k);
  }
}

/* rms error of the finger, m. told: the setup knows the lags. */
static double error_of(const swing *s, ethd_fit_method fit, const double lag[ETHD_RAYS], int told) {
  rig r;
  double sum = 0;
  int64_t sample_ns = 0;
  uint64_t frame = 0, count = 0;
  rig_open(&r, NULL);
  ethd_setup_fit(&r.setup, fit);
  for (int k = 0; k < ETHD_RAYS && told; k++) r.setup.ray_lag[k] = lag[k];
  rig_start(&r);
  for (int64_t now = 1000000; now < INT64_C(1000000000); now += 1000000) {
    double t = 1e-9 * (double)now;
    motion m = {.x = ring_at(s, t)};
    ethd_sense sense = rig_sense(&r.setup.arm, &m);
    sense.have = 0;
    sense.time_ns = now;
    if (sample_ns + LATENCY_NS <= now) {
      take(s, lag, sense.sample_ns = sample_ns, frame, sense.rays);
      sense.have = ETHD_HAVE_RAYS;
      sample_ns = (int64_t)(++frame * 1000000000 / 300);
    }
    ck_assert_int_eq(rig_try(&r, &sense), ETHD_OK);
    if (now < 100000000) continue;
    ethd_vec e = ethd_vec_sub((ethd_vec){r.trace.xf[0], r.trace.xf[1]}, finger_at(s, t));
    sum += ethd_vec_dot(e, e);
    count++;
  }
  ck_assert_uint_eq(r.trace.tick + 1, 999);
  rig_close(&r);
  return sqrt(sum / (double)count);
}

TEST(test_gain) {
  static const struct {
    swing swing;
    const char *what;
    double most[2]; /* share of the error that may be left: 3.3 ms, 1.35 ms */
  } rows[] = {
      {{0, 0, 3.5e-3, 0.4}, "ring 0.4 m/s about a finger at rest", {0.3, 1.02}},
      {{0.1, 0.4, 3.5e-3, 0.4}, "ring 0.4 m/s about a finger at 0.4 m/s", {0.3, 1.02}},
      {{0.1, 0.4, 0, 0}, "both together at 0.4 m/s", {1.02, 1.02}},
      {{3.5e-3, 0.1, 3.5e-3, 0.1}, "the finger, too, to and fro", {0.9, 1.02}},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int boards = 0; boards < 2; boards++) {
      double lag[ETHD_RAYS];
      lags(boards, lag);
      double without = error_of(&rows[i].swing, ETHD_FIT_KASA, lag, 0),
             with = error_of(&rows[i].swing, ETHD_FIT_KASA, lag, 1);
      printf("%-38s %s: rms error %.3f mm, lags told %.3f mm\n", rows[i].what, boards ? "1.35 ms" : "3.3 ms ",
             1e3 * without, 1e3 * with);
      ck_assert_double_le(with, rows[i].most[boards] * without);
    }
}

/* What is left is noise, for every fit; a single late ray does no harm either. */
TEST(test_every_fit) {
  static const double one[ETHD_RAYS] = {[5] = 3e-3};
  static const swing still = {0.1, 0.4, 0, 0}, moving = {0.1, 0.4, 3.5e-3, 0.4};
  double lag[ETHD_RAYS];
  lags(0, lag);
  for (int fit = 0; fit < ETHD_FIT_COUNT; fit++) {
    if (fit == ETHD_FIT_VERTEX_MEAN) continue; /* gives half of an offset, by definition */
    double least = error_of(&still, (ethd_fit_method)fit, one, 1);
    printf("%s: %.3f mm, moving %.3f mm, one late %.3f mm\n", ethd_fit_methods[fit].id, 1e3 * least,
           1e3 * error_of(&moving, (ethd_fit_method)fit, lag, 1),
           1e3 * error_of(&moving, (ethd_fit_method)fit, one, 1));
    ck_assert_double_le(error_of(&moving, (ethd_fit_method)fit, lag, 1), least + 0.15e-3);
    ck_assert_double_le(error_of(&moving, (ethd_fit_method)fit, one, 1), least + 0.15e-3);
  }
}

TEST(test_checked) {
  ethd_setup setup = ethd_setup_default();
  ethd_error error;
  static const double bad[] = {0.0101, -0.0101, (double)INFINITY, (double)NAN};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    setup.ray_lag[i * 5] = bad[i];
    ck_assert_int_lt(ethd_setup_check(&setup, &error), 0);
    ck_assert_str_eq(error.name, "finger_fit.lag");
    setup.ray_lag[i * 5] = 0;
  }
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_OK);
}

static ethd_status parse(const char *text, ethd_config **out, char *message) {
  return ethd_config_parse(text, strlen(text), "x.ini", NULL, out, message);
}

TEST(test_configured) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ck_assert_int_eq(parse("[finger_fit]\nlag = 0 1e-3 2e-3 -1e-3 0 0 0 0 0 0 0 0 0 0 0 -0.01\n", &config, message),
                   ETHD_OK);
  const double *lag = config->setup.ray_lag;
  ck_assert(lag[0] == 0 && lag[1] == 1e-3 && lag[2] == 2e-3 && lag[3] == -1e-3 && lag[15] == -0.01);
  ethd_config_free(config);
  ck_assert_int_lt(parse("[finger_fit]\nlag = 0 1e-3\n", &config, message), 0);
  ck_assert_str_eq(message,
                   "x.ini:2: finger_fit.lag: found \"0 1e-3\", a time in s for each of the 16 rays is allowed");
  ck_assert_int_lt(parse("\n[finger_fit]\nlag = 0 0 0 0 0 0 0 0.02 0 0 0 0 0 0 0 0\n", &config, message), 0);
  ck_assert_str_eq(message, "x.ini:3: finger_fit.lag: found \"0.02\", -0.01 to 0.01 s is allowed");
}
