/* The screen's geometry and the led hand; no window is needed. */
#include <math.h>

#include "screen/hand.h"
#include "screen/view.h"
#include "unit/draw.h"
#include "unit/suite.h"

static const double walls[ETHD_WALLS] = {0.238, (double)NAN, (double)NAN, (double)NAN};

static ethd__room room(void) { return ethd__room_of(walls, (ethd_vec){0.2816, 0.25}, 0.0075, 1280, 720); }

static void inside(const ethd__room *r, ethd_vec x) {
  ethd_vec a = ethd__room_avatar(r, x);
  ck_assert(a.x - r->finger >= r->left - 1e-15 && a.x + r->finger <= r->right + 1e-15);
  ck_assert(a.y - r->finger >= r->bottom - 1e-15 && a.y + r->finger <= r->top + 1e-15);
}

TEST(test_stays_inside) {
  ethd__room r = room();
  uint64_t seed = 5;
  for (int k = 0; k < 100000; k++)
    inside(&r, (ethd_vec){draw(seed + 2 * (uint64_t)k, -1, 1), draw(seed + 2 * (uint64_t)k + 1, -1, 1)});
  inside(&r, (ethd_vec){(double)NAN, (double)INFINITY});
  inside(&r, (ethd_vec){-(double)INFINITY, 1e300});
  ethd_vec within = {0.26, 0.251}, same = ethd__room_avatar(&r, within);
  ck_assert(same.x == within.x && same.y == within.y);
  ck_assert_double_eq_tol(ethd__room_avatar(&r, (ethd_vec){0.2, 0.25}).x, 0.2455, 1e-15); /* stands at the wall */
}

/* Everything fits into any window, and pixels are points. */
TEST(test_pixels) {
  static const int sizes[][2] = {{1280, 720}, {320, 200}, {720, 1280}, {16384, 300}};
  for (int i = 0; i < 4; i++) {
    ethd__room r = ethd__room_of(walls, (ethd_vec){0.2816, 0.25}, 0.0075, sizes[i][0], sizes[i][1]);
    ethd_vec low = ethd__room_pixel(&r, (ethd_vec){r.left, r.bottom}),
             high = ethd__room_pixel(&r, (ethd_vec){r.right, r.top});
    ck_assert(low.x > 0 && high.x < sizes[i][0] && high.y > 0 && low.y < sizes[i][1] && high.y < low.y);
    ethd_vec back = ethd__room_point(&r, high.x, high.y);
    ck_assert(fabs(back.x - r.right) < 1e-12 && fabs(back.y - r.top) < 1e-12);
  }
}

/* What the path says at t when the simulation is there is what it says ever after: nothing changes behind or
   under it. And it comes to where the pointer stays. */
TEST(test_hand_is_causal) {
  enum { TICKS = 2000 };
  static ethd_vec seen[TICKS], speed[TICKS];
  ethd__hand hand;
  ethd_vec pointer = {0.28, 0.25};
  uint64_t seed = 9;
  ck_assert_int_eq(ethd__hand_create(&hand, pointer, 3), ETHD_OK);
  ethd_path path = ethd__hand_path(&hand);
  for (int k = 0; k < TICKS; k++) {
    if (k < TICKS / 2 && k % 16 == 0)
      pointer = (ethd_vec){draw(seed + 2 * (uint64_t)k, 0.2, 0.3), draw(seed + 2 * (uint64_t)k + 1, 0.2, 0.3)};
    if (k % 16 == 0) ethd__hand_move(&hand, 1e-3 * k, pointer);
    ethd__hand_lead(&hand, 1e-3 * k);
    ethd_path_at(&path, 1e-3 * k + 0.00099, &seen[k], &speed[k]);
  }
  ck_assert_double_eq_tol(seen[TICKS - 1].x, pointer.x, 1e-9);
  ck_assert_double_eq_tol(seen[TICKS - 1].y, pointer.y, 1e-9);
  for (int k = 0; k < TICKS; k++) {
    ethd_vec x, v;
    ethd_path_at(&path, 1e-3 * k + 0.00099, &x, &v);
    ck_assert_msg(x.x == seen[k].x && x.y == seen[k].y && v.x == speed[k].x && v.y == speed[k].y, "tick %d", k);
  }
  ethd__hand_free(&hand);
}

/* A pointer that jumps is followed within 60 ms to a tenth. */
TEST(test_hand_is_quick) {
  ethd__hand hand;
  ethd_vec x, v;
  ck_assert_int_eq(ethd__hand_create(&hand, (ethd_vec){0.3, 0.25}, 1), ETHD_OK);
  ethd_path path = ethd__hand_path(&hand);
  for (int k = 0; k < 71; k++) {
    if (k == 10) ethd__hand_move(&hand, 1e-3 * k, (ethd_vec){0.2, 0.25});
    ethd__hand_lead(&hand, 1e-3 * k);
  }
  ethd_path_at(&path, 0.010, &x, &v);
  ck_assert_double_eq_tol(x.x, 0.3, 1e-12);
  ethd_path_at(&path, 0.070, &x, &v);
  ck_assert_double_lt(x.x, 0.21);
  ethd__hand_free(&hand);
}

/* A pointer that is led at 0.200 m/s, on whole pixels, heard of `rate` times a second and up to 1 ms late: the hand's
   speeds from 0.1 s on. */
static void lead_steadily(double rate, double scale, double *least, double *most, double *mean) {
  ethd__hand hand;
  ethd_vec x, v, first = {0, 0};
  double told = 0;
  uint64_t seed = 77;
  ck_assert_int_eq(ethd__hand_create(&hand, (ethd_vec){0.3, 0.25}, 1), ETHD_OK);
  ethd_path path = ethd__hand_path(&hand);
  *least = INFINITY, *most = -INFINITY;
  for (int k = 0; k < 500; k++) {
    double t = 1e-3 * k;
    for (; told <= t; told += 1 / rate)
      ethd__hand_move(&hand, told + draw(seed++, 0, fmin(1e-3, 0.5 / rate)),
                      (ethd_vec){round((0.3 - 0.2 * told) * scale) / scale, 0.25});
    ethd__hand_lead(&hand, t);
    ethd_path_at(&path, t, &x, &v);
    if (k == 100) first = x;
    if (k < 100) continue;
    *least = fmin(*least, -v.x);
    *most = fmax(*most, -v.x);
  }
  *mean = (first.x - x.x) / 0.399;
  ethd__hand_free(&hand);
}

TEST(test_hand_is_as_fast_as_the_pointer) {
  static const double rates[] = {60, 90, 125, 500, 1000};
  for (int i = 0; i < 5; i++)
    for (double scale = 3500; scale < 20000; scale *= 2) {
      double least, most, mean;
      lead_steadily(rates[i], scale, &least, &most, &mean);
      ck_assert_msg(least > 0.184 && most < 0.216, "%g Hz, %g px/m: %.4f to %.4f m/s", rates[i], scale, least, most);
      ck_assert_msg(fabs(mean - 0.2) < 0.0004, "%g Hz, %g px/m: %.4f m/s", rates[i], scale, mean);
    }
}
