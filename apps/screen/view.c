#include "screen/view.h"

#include <math.h>

#define BEHIND 0.015 /* m of free space behind the start */
#define SHARE 0.55   /* of the window that the free space may fill */

ethd__room ethd__room_of(const double wall[ETHD_WALLS], ethd_vec start, double finger, int width, int height) {
  ethd__room f = {.width = width, .height = height, .left = wall[ETHD_WALL_LEFT], .start = start, .finger = finger};
  for (int i = 0; i < ETHD_WALLS; i++) f.there[i] = !isnan(wall[i]);
  f.right = f.there[ETHD_WALL_RIGHT] ? wall[ETHD_WALL_RIGHT] : start.x + finger + BEHIND;
  double half = 0.3 * (f.right - f.left);
  f.bottom = f.there[ETHD_WALL_BOTTOM] ? wall[ETHD_WALL_BOTTOM] : start.y - half;
  f.top = f.there[ETHD_WALL_TOP] ? wall[ETHD_WALL_TOP] : start.y + half;
  f.scale = SHARE * fmin(width / (f.right - f.left), height / (f.top - f.bottom));
  return f;
}

ethd_vec ethd__room_pixel(const ethd__room *f, ethd_vec x) {
  return (ethd_vec){f->width / 2.0 + f->scale * (x.x - (f->left + f->right) / 2),
                    f->height / 2.0 - f->scale * (x.y - (f->bottom + f->top) / 2)};
}

ethd_vec ethd__room_point(const ethd__room *f, double px, double py) {
  return (ethd_vec){(f->left + f->right) / 2 + (px - f->width / 2.0) / f->scale,
                    (f->bottom + f->top) / 2 - (py - f->height / 2.0) / f->scale};
}

/* NaN is clamped to the low end. */
static double between(double value, double low, double high) { return value > low ? fmin(value, high) : low; }

ethd_vec ethd__room_avatar(const ethd__room *f, ethd_vec x) {
  return (ethd_vec){between(x.x, f->left + f->finger, f->right - f->finger),
                    between(x.y, f->bottom + f->finger, f->top - f->finger)};
}
