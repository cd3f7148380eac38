/* What the law that looks ahead is made of, each against its closed form: curve, observer, learnt deceleration. */
#include <math.h>
#include <string.h>

#include "ethd/law.h"
#include "law/brake_curve.h"
#include "law/brake_learner.h"
#include "law/ring_observer.h"
#include "unit/rig.h"

#define T 1e-3

/* Value and slope of line and root meet at a/rate^2, `way` is the other way round, and a point that moves by the curve
   in small steps needs v^2/(2a) + d_l/2, until it is on the line. */
TEST(test_curve) {
  const ethd__brake_curve c = ethd__brake_curve_of(40, 400, T);
  const double at = 40.0 / (400 * 400), h = 1e-7 * at;
  ck_assert_double_eq_tol(c.linear, at, 1e-15);
  ck_assert(c.rate == 400 && ethd__brake_curve_of(40, 400, 2e-3).rate == 250); /* half of the distance in a tick */
  double below = ethd__brake_curve_speed(&c, at - h), on = ethd__brake_curve_speed(&c, at),
         above = ethd__brake_curve_speed(&c, at + h);
  ck_assert_double_eq_tol((on - below) / h, 400, 0.01);
  ck_assert_double_eq_tol((above - on) / h, 400, 0.01);
  for (double v = 0.01; v < 1; v *= 1.3)
    ck_assert_double_eq_tol(ethd__brake_curve_speed(&c, ethd__brake_curve_way(&c, v)), v, 1e-12);
  double d = ethd__brake_curve_way(&c, 0.5), v = 0.5, t = 0;
  ck_assert_double_eq_tol(d, 0.5 * 0.5 / 80 + at / 2, 1e-12);
  for (; d > at; t += 1e-6) {
    double a = ethd__brake_curve_slope(&c, d, v);
    d -= v * 1e-6 + a * 5e-13;
    v += a * 1e-6;
  }
  ck_assert_double_eq_tol(v, 400 * at, 1e-4); /* it is still on the curve */
  ck_assert_double_eq_tol(t, (0.5 - 400 * at) / 40, 2e-6);
  ck_assert(ethd__brake_curve_of(40, 2000, T).rate == 500); /* half a period's inverse */
}

/* What white noise of the distances makes of the speed, by the squares of its answer to one of them: Morrison's closed
   form. A constant disturbance leaves no error. */
TEST_LOOP(test_observer, 0, 3) {
  const double b = 0.5 + 0.2 * _i;
  ethd__ring_observer o = {0, 0, 0};
  double squares = 0;
  for (int i = 0; i < 3000; i++) {
    ethd__ring_correct(&o, ethd__ring_predict(&o, 0, i == 0, T), b, T);
    squares += o.v * o.v;
  }
  double closed = pow(1 - b, 3) * (13 + 50 * b + 49 * b * b) / (2 * pow(1 + b, 5)) / (T * T);
  ck_assert_double_eq_tol(squares / closed, 1, 1e-9);
  o = (ethd__ring_observer){0.3, 0.2, 0};
  for (int i = 1; i <= 400; i++) { /* brakes at 3 m/s^2, where the model has 2 */
    double t = i * T, e = ethd__ring_predict(&o, -2, 0.3 - 0.2 * t + 1.5 * t * t, T);
    ethd__ring_correct(&o, e, b, T);
  }
  ck_assert_double_eq_tol(o.v, 0.2 - 3 * 0.4, 1e-9);
  ck_assert_double_eq_tol(o.w, -1, 1e-6);
}

/* A braking of 15 ms from 0.5 m/s: the ring has k times the model's deceleration, and a transmission that has given way
   by `stretch` within 3 ms. */
static void brake(double *memory, double k, double stretch, double deeper) {
  ethd__brake_learner l;
  ethd__brake_learner_begin(&l, 0.01, 0.5);
  for (int i = 1; i <= 15; i++) {
    double t = i * T, model = i % 2 ? -44 : -36, x = 0, speed = 0; /* and not a constant one */
    for (int j = 1; j <= i; j++) {
      double a = j % 2 ? -44 : -36;
      x += speed * T + a * T * T / 2;
      speed += a * T;
    }
    ethd__brake_learner_add(&l, model, 0.01 - 0.5 * t - k * x + (i < 3 ? i / 3.0 : 1) * stretch, T, 0);
  }
  ethd__brake_learner_end(&l, deeper, 0.3, memory);
  ethd__brake_learner_end(&l, deeper, 0.3, memory); /* once */
}

TEST_LOOP(test_learner, 0, 6) {
  static const double ks[] = {0.7, 0.96, 1.3};
  static const double stretches[] = {0, 6e-4};
  double memory[ETHD_MEMORY] = {0}, k = ks[_i % 3], stretch = stretches[_i / 3];
  for (int i = 0; i < 30; i++) brake(memory, k, stretch, 0);
  ck_assert_double_eq_tol(memory[0] / memory[1], k, 1e-9);
  double sure = k > 1.05 ? k - 0.05 : k < 0.95 ? k + 0.05 : 1;
  ck_assert_double_eq_tol(ethd__brake_learnt(memory), sure, 0.02); /* the prior's share */
}

/* What went too deep never says that there is more deceleration; the other way round it counts. */
TEST(test_learner_is_careful) {
  double memory[ETHD_MEMORY] = {0};
  brake(memory, 1.3, 0, 1e-4);
  ck_assert(memory[0] == 0 && memory[1] == 0);
  brake(memory, 0.8, 0, 1e-4);
  ck_assert(memory[1] > 0 && ethd__brake_learnt(memory) < 0.9);
  double was = memory[0];
  brake(memory, 9, 0, 0); /* no ring */
  ck_assert(memory[0] == was);
}
