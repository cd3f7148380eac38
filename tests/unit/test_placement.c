/* Recorded movements as paths: a movement with known speeds, touched down and shifted. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tap/placement.h"
#include "unit/suite.h"

static const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};

/* x = A cos(w t), y = 0.3 t: toward the wall (-x) at A w sin(w t), at most A w at a quarter period. */
#define A 0.1
#define W 8.0

static ethd__movement swing(double rate, double duration) {
  ethd__movement m;
  m.count = (size_t)(rate * duration) + 1;
  m.samples = malloc(m.count * sizeof *m.samples);
  for (size_t i = 0; i < m.count; i++) {
    double t = (double)i / rate;
    m.samples[i] = (ethd_path_sample){t, A * cos(W * t), 0.3 * t};
  }
  return m;
}

/* Differences over +-h see sin(W h)/(W h) of the speed. */
TEST(test_speed) {
  static const double rates[] = {100, 200, 250, 300, 1000, 4000};
  for (size_t r = 0; r < sizeof rates / sizeof *rates; r++) {
    ethd__movement m = swing(rates[r], 0.3);
    for (size_t k = 1; k + 1 < m.count; k++) {
      if (rates[r] > 300 && (m.samples[k].t < 6e-3 || m.samples[k].t > 0.294)) continue;
      double v = A * W * sin(W * m.samples[k].t), h = fmax(5e-3, 1 / rates[r]);
      ck_assert_double_eq_tol(ethd__movement_speed(&m, k), v, v * W * W * h * h / 6 + 1e-9);
    }
    ethd__movement_free(&m);
  }
}

/* Jitter of 20 um at 200 Hz moves a central difference by at most 20e-6 / 5e-3. */
TEST(test_speed_with_noise) {
  ethd__movement m = swing(200, 0.3);
  for (size_t k = 0; k < m.count; k++) m.samples[k].x += k % 2 ? 20e-6 : -20e-6;
  for (size_t k = 1; k + 1 < m.count; k++)
    ck_assert_double_eq_tol(ethd__movement_speed(&m, k), A * W * sin(W * m.samples[k].t), 4e-3);
  ethd__movement_free(&m);
}

/* Falls to v at t with A w sin(w t) = v, the second time. */
TEST(test_touchdown) {
  ethd__movement m = swing(250, 0.39);
  for (double v = 0.1; v < 0.79; v += 0.1) {
    ethd__touchdown d;
    double t = (M_PI - asin(v / (A * W))) / W;
    ethd__movement_touchdown(&m, v, &d);
    ck_assert(!d.never_fast);
    ck_assert_double_eq_tol(d.t, t, 3e-4 / sqrt(1 - v * v / 0.6401)); /* flat near the peak */
    ck_assert_double_eq_tol(d.x.x, A * cos(W * d.t), 1e-5);
    ck_assert_double_eq_tol(d.x.y, 0.3 * d.t, 1e-5);
  }
  ethd__movement_free(&m);
}

TEST(test_never_that_fast) {
  ethd__movement m = swing(250, 0.39);
  ethd__touchdown d;
  ethd__movement_touchdown(&m, 0.81, &d);
  ck_assert(d.never_fast);
  ck_assert_double_eq_tol(d.t, M_PI / 2 / W, 4e-3);
  ethd__movement_free(&m);
}

/* Cut off while still fast: the last sample. */
TEST(test_never_slow_again) {
  ethd__movement m = swing(250, 0.25);
  ethd__touchdown d;
  ethd__movement_touchdown(&m, 0.4, &d);
  ck_assert(!d.never_fast);
  ck_assert_double_eq(d.t, m.samples[m.count - 1].t);
  ethd__movement_free(&m);
}

/* The whole movement is there, shifted by one vector, with the touchdown at the centre. */
TEST(test_place) {
  ethd__movement m = swing(250, 0.39);
  ethd_path_sample *out = malloc(m.count * sizeof *out);
  const ethd_vec centre = {0.2453, 0.25};
  ethd__touchdown d;
  ethd__movement_touchdown(&m, 0.4, &d);
  ck_assert_uint_eq(ethd__movement_place(&m, &d, centre, &arm, out), m.count);
  const ethd_path path = {.samples = out, .sample_count = m.count};
  ethd_vec x, v;
  ethd_path_at(&path, d.t, &x, &v);
  ck_assert_double_eq_tol(x.x, centre.x, 1e-12);
  ck_assert_double_eq_tol(x.y, centre.y, 1e-12);
  ck_assert_double_eq_tol(-v.x, 0.4, 2e-3);
  for (size_t k = 0; k < m.count; k++) {
    ck_assert_double_eq(out[k].t, m.samples[k].t);
    ck_assert_double_eq_tol(out[k].x - m.samples[k].x, out[0].x - m.samples[0].x, 1e-15);
    ck_assert_double_eq_tol(out[k].y - m.samples[k].y, out[0].y - m.samples[0].y, 1e-15);
  }
  free(out);
  ethd__movement_free(&m);
}

/* A straight line through the arm's reach, 0.5 m about the base: starts at the first sample within, ends
   at the last. */
TEST(test_reach) {
  enum { N = 301 };
  ethd_path_sample in[N], out[N];
  for (int k = 0; k < N; k++) in[k] = (ethd_path_sample){0.01 * k, 1.5 - 0.01 * k, 0};
  const ethd__movement m = {in, N};
  const ethd__touchdown d = {1.2547, {0.2453, 0}, false};
  size_t count = ethd__movement_place(&m, &d, (ethd_vec){0.2453, 0.25}, &arm, out);
  double edge = sqrt(0.25 - 0.0625);
  size_t first = (size_t)ceil((1.5 - edge) / 0.01), last = (size_t)floor((1.5 + edge) / 0.01);
  ck_assert_uint_eq(count, last - first + 1);
  ck_assert_double_eq(out[0].t, 0);
  ck_assert_double_eq_tol(out[0].x, 1.5 - 0.01 * (double)first, 1e-12);
  ck_assert_double_eq_tol(out[count - 1].x, 1.5 - 0.01 * (double)last, 1e-12);
  ck_assert_uint_eq(ethd__movement_place(&m, &d, (ethd_vec){0.4, 0.31}, &arm, out), 0);
}

/* ---- files ---- */

static ethd_status load_form(const char *text, const ethd__movement_form *form, ethd__movement *out, char *message) {
  char path[] = "/tmp/ethd-placement-XXXXXX";
  int fd = mkstemp(path);
  ck_assert_int_ge(fd, 0);
  ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
  close(fd);
  ethd_status status = ethd__movement_load(path, form, out, message);
  unlink(path);
  return status;
}

static ethd_status load(const char *text, ethd__movement *out, char *message) {
  return load_form(text, &ethd__movement_si, out, message);
}

TEST(test_file) {
  ethd__movement m;
  char message[ETHD_MESSAGE_MAX];
  ck_assert_int_eq(load("y_m,fy_n,t_s,x_m\n1,x,5,0.1\n2,x,5.5,0.2\n3,x,7,-0.4\n", &m, message), ETHD_OK);
  ck_assert_uint_eq(m.count, 3);
  ck_assert_double_eq(m.samples[0].t, 0);
  ck_assert_double_eq(m.samples[2].t, 2);
  ck_assert_double_eq(m.samples[2].x, -0.4);
  ck_assert_double_eq(m.samples[2].y, 3);
  ethd__movement_free(&m);
  const ethd__movement_form other = {{"Time (Seconds)", "-X", "Y"}, 1e-3, 0.01};
  ck_assert_int_eq(load_form("X;Time (Seconds);Y\n10;100;1\n10,5;200;2\n9;400;3\n", &other, &m, message), ETHD_OK);
  ck_assert_double_eq_tol(m.samples[1].x, -0.105, 1e-15);
  ck_assert_double_eq_tol(m.samples[2].y, 0.03, 1e-15);
  ck_assert_double_eq_tol(m.samples[2].t, 0.3, 1e-15);
  ethd__movement_free(&m);
}

TEST(test_bad_files) {
  static const struct {
    const char *text, *says;
  } bad[] = {
      {"t_s,x_m\n0,0\n1,0\n2,0\n", ":1: no column y_m"},
      {"t_s,x_m,y_m\n0,0,0\n1,0,0\n", "2 samples"},
      {"t_s,x_m,y_m\n0,0,0\n1,nan,0\n2,0,0\n", ":3: x_m: nan"},
      {"t_s,x_m,y_m\n0,0,0\n1,0,\n2,0,0\n", ":3: y_m: an empty cell"},
      {"t_s,x_m,y_m\n0,0,0\n1,0,0\n1,0,0\n", ":4: t_s: found 1 s after 1 s"},
      {"t_s,x_m,y_m\n0,0,0\n1,0,0\n0.5,0,0\n", ":4: t_s: found 0.5 s after 1 s"},
      {"t_s,x_m,y_m\n0,0,0\n1,1e4,0\n2,0,0\n", ":3: x_m: found 10000"},
      {"t_s,x_m,y_m\n0,0,0\n1,9,0\n2,-2,0\n", ":4: found a hand at 11 m/s"},
      {"t_s\tx_m\ty_m\n0\t0\t0\n1\t0,5\t0\n2\t1\t0\n", "--columns t_s,-x_m"},
      {"Format Version,1.23,Take Name,a\n\nFrame,Time (Seconds),X,Y\n0,0,0,0\n", ":1: an export of Motive"},
      {"t_s,x_m,y_m\n0,0,0\n1,0,0\n121,0,0\n", ":4: t_s: 121 s after the start"},
      {"t_s,x_m,y_m\n0,0,0\n1,0\n2,0,0\n", ":3"},
      {"", ""},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ethd__movement m;
    char message[ETHD_MESSAGE_MAX] = "";
    ck_assert_int_lt(load(bad[i].text, &m, message), 0);
    ck_assert_msg(strstr(message, bad[i].says) != NULL, "%s", message);
    ck_assert(!strchr(message, '\n') && message[0]);
    ck_assert_ptr_null(m.samples);
  }
}
