#include "finger/zones.h"

#include <math.h>

#include "ethd/maths.h"

#define PI 3.14159265358979323846
#define GRID 201 /* points across the ring, of the grid of centres */

double ethd__zones_distance(const ethd__zones *z, double finger_radius, ethd_vec centre, uint32_t k) {
  double along = ethd_vec_dot(z->ray[k], centre), across = ethd_vec_cross(z->ray[k], centre);
  if (fabs(across) > finger_radius) return (double)INFINITY;
  return z->ring_radius - (along + sqrt((finger_radius - across) * (finger_radius + across)));
}

/* A run of neighbouring barriers on the circle. */
typedef struct arc {
  uint32_t length, first;
} arc;

static bool find_arc(uint32_t count, uint32_t lit, arc *out) {
  uint32_t begins = 0;
  *out = (arc){0, 0};
  for (uint32_t k = 0; k < count; k++) {
    bool on = lit >> k & 1, before = lit >> (k ? k - 1 : count - 1) & 1;
    out->length += on;
    if (on && !before) begins++, out->first = k;
  }
  return begins <= 1;
}

/* Returns the direction of the run's middle; no barrier and all barriers have none. */
static ethd_vec middle(const ethd__zones *z, arc a) {
  if (a.length == 0 || a.length == z->count) return (ethd_vec){0, 0};
  uint32_t half = a.first + (a.length - 1) / 2;
  ethd_vec u = z->ray[half % z->count];
  if (a.length % 2) return u;
  u = ethd_vec_add(u, z->ray[(half + 1) % z->count]);
  return ethd_vec_scale(1 / ethd_vec_norm(u), u);
}

bool ethd__zones_centre(const ethd__zones *z, uint32_t lit, ethd_vec *centre, double *noise) {
  arc a;
  if (lit >> z->count || !find_arc(z->count, lit, &a) || !(z->noise[a.length] >= 0)) return false;
  *centre = ethd_vec_scale(z->offset[a.length], middle(z, a));
  *noise = z->noise[a.length];
  return true;
}

/* ---- the table ---- */

typedef struct zone_sums {
  double n, along, square; /* number of centres, sum of their offsets toward the middle, sum of squared offsets */
} zone_sums;

static uint32_t lit_at(const ethd__zones *z, double finger_radius, ethd_vec centre) {
  uint32_t lit = 0;
  for (uint32_t k = 0; k < z->count; k++)
    lit |= (uint32_t)(ethd__zones_distance(z, finger_radius, centre, k) <= z->reach) << k;
  return lit;
}

static void count_centre(const ethd__zones *z, double finger_radius, ethd_vec centre, zone_sums *by_length) {
  arc a;
  if (!find_arc(z->count, lit_at(z, finger_radius, centre), &a)) return;
  zone_sums *s = &by_length[a.length];
  s->n++;
  s->along += ethd_vec_dot(middle(z, a), centre);
  s->square += ethd_vec_dot(centre, centre);
}

void ethd__zones_prepare(uint32_t count, double reach, double ring_radius, double finger_radius, double switching,
                         ethd__zones *out) {
  zone_sums by_length[ETHD__ZONES_MAX + 1] = {{0}};
  double room = ring_radius - finger_radius, step = 2 * room / (GRID - 1);
  *out = (ethd__zones){.count = count, .ring_radius = ring_radius, .reach = reach};
  for (uint32_t k = 0; k < count; k++) ethd_sincos(2 * PI * k / count, &out->ray[k].y, &out->ray[k].x);
  for (int i = 0; i < GRID; i++)
    for (int j = 0; j < GRID; j++) {
      ethd_vec centre = {i * step - room, j * step - room};
      if (ethd_vec_norm(centre) <= room) count_centre(out, finger_radius, centre, by_length);
    }
  for (uint32_t l = 0; l <= count; l++) {
    const zone_sums *s = &by_length[l];
    out->offset[l] = out->noise[l] = (double)NAN;
    if (!(s->n > 0)) continue; /* no position lights this number */
    out->offset[l] = s->along / s->n;
    double variance = (s->square / s->n - out->offset[l] * out->offset[l]) / 2;
    out->noise[l] = sqrt(fmax(variance, 0) + switching * switching);
  }
}
