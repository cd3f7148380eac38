/* The velocity nearest to a requested one, under bounds along normals: the projection onto the set
   {u: n_i.u <= s_i}; held bounds are equations. In three dimensions at most three bounds act at once, so all choices of
   up to three are tried, smaller ones first. The solution is the first choice that satisfies the other bounds and has
   no negative multiplier (Karush-Kuhn-Tucker; the projection onto a convex set is unique). For n bounds there are at
   most n + n (n - 1) / 2 + n (n - 1) (n - 2) / 6 choices, 575 for 15. */
#include "space/state.h"

#define SLACK 1e-12 /* m/s, and the least pivot of a choice whose normals differ */

/* Solves u = asked - sum l_i n_i with n_i.u = s_i for the chosen bounds, by elimination without pivots on the Gram
   matrix, whose pivots are positive. Returns false if a normal depends on the others, or if the multiplier of a bound
   that isn't held is negative (l_i < 0). */
static bool meet(ethd_vec3 asked, const struct ethd__bound *const *chosen, int count, ethd_vec3 *out) {
  double g[3][3], l[3];
  for (int i = 0; i < count; i++) {
    l[i] = ethd_vec3_dot(chosen[i]->n, asked) - chosen[i]->speed;
    for (int k = 0; k < count; k++) g[i][k] = ethd_vec3_dot(chosen[i]->n, chosen[k]->n);
  }
  for (int i = 0; i < count; i++) {
    if (!(g[i][i] > SLACK)) return false;
    for (int k = i + 1; k < count; k++) {
      const double share = g[k][i] / g[i][i];
      for (int j = i; j < count; j++) g[k][j] -= share * g[i][j];
      l[k] -= share * l[i];
    }
  }
  *out = asked;
  for (int i = count - 1; i >= 0; i--) {
    for (int k = i + 1; k < count; k++) l[i] -= g[i][k] * l[k];
    l[i] /= g[i][i];
    if (l[i] < 0 && !chosen[i]->held) return false;
    *out = ethd_vec3_sub(*out, ethd_vec3_scale(l[i], chosen[i]->n));
  }
  return true;
}

static bool satisfies(ethd_vec3 u, const struct ethd__bound *b) {
  const double over = ethd_vec3_dot(b->n, u) - b->speed;
  return over <= SLACK && (!b->held || over >= -SLACK);
}

static bool satisfies_all(ethd_vec3 u, const struct ethd__bound *bounds, int count) {
  for (int i = 0; i < count; i++)
    if (!satisfies(u, &bounds[i])) return false;
  return true;
}

/* If no velocity satisfies all bounds, applies the bounds one by one, the first ones last. */
static ethd_vec3 one_by_one(ethd_vec3 u, const struct ethd__bound *bounds, int count) {
  for (int i = count - 1; i >= 0; i--) {
    const double over = ethd_vec3_dot(bounds[i].n, u) - bounds[i].speed;
    if (over > 0 || bounds[i].held) u = ethd_vec3_sub(u, ethd_vec3_scale(over, bounds[i].n));
  }
  return u;
}

ethd_vec3 ethd__space_within(ethd_vec3 asked, const struct ethd__bound *bounds, int count) {
  ethd_vec3 u;
  if (satisfies_all(asked, bounds, count)) return asked;
  for (int size = 1; size <= 3; size++) {
    for (int i = 0; i < count; i++) {
      for (int k = size > 1 ? i + 1 : count - 1; k < count; k++) {
        for (int j = size > 2 ? k + 1 : count - 1; j < count; j++) {
          const struct ethd__bound *chosen[3] = {&bounds[i], &bounds[k], &bounds[j]};
          if (meet(asked, chosen, size, &u) && satisfies_all(u, bounds, count)) return u;
        }
      }
    }
  }
  return one_by_one(asked, bounds, count);
}
