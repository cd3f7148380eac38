#include "core/candidates.h"

double ethd__candidates_range(const ethd__core_tick *t) {
  double behind = t->plan->d_beta + ethd_vec3_norm(ethd_vec3_sub(t->finger, t->x));
  return t->plan->radius + (behind > t->near ? behind : t->near);
}

/* ---- points that continue contacts ---- */

/* Finds the closest pair of a point and an open contact on the same object, at most `limit` m apart. Returns the
   point's index, -1 if there is no such pair; *slot is the contact's. */
static int closest(const ethd__core *core, unsigned open, double limit, const ethd__candidates *c, int *slot) {
  int best = -1;
  for (; open; open &= open - 1) {
    int i = __builtin_ctz(open);
    const ethd__slot *s = &core->slots[i];
    for (int k = 0; k < c->count; k++) {
      const ethd__candidate *t = &c->at[k];
      if (t->slot >= 0 || t->object != s->object || t->place != s->place) continue;
      double d = ethd_vec3_norm(ethd_vec3_sub(t->local, s->point));
      if (best < 0 ? !(d <= limit) : !(d < limit)) continue;
      best = k;
      limit = d;
      *slot = i;
    }
  }
  return best;
}

/* Surfaces of the old and the new scene are the same if this tick's points on them differ by no more than this. */
#define SAME_PLACE 1e-6 /* m, and rad of the normals */

static bool continues(const ethd__slot *slot, const ethd__candidate *k) {
  /* a thin wall keeps the normal of the side on which the contact began */
  double side = slot->side != 0 && k->side == -slot->side ? -1 : 1;
  return k->slot < 0 && k->place == slot->place && ethd_vec3_norm(ethd_vec3_sub(k->local, slot->point)) <= SAME_PLACE &&
         ethd_vec3_norm(ethd_vec3_sub(ethd_vec3_scale(side, k->n), slot->past.n)) <= SAME_PLACE;
}

/* Contacts whose scene was replaced continue if the new scene has the same surface, under any number, and end if not.
   Returns the other contacts' slots. */
static unsigned settle_orphans(ethd__core *core, ethd__candidates *c) {
  for (unsigned left = core->orphans & c->live; left; left &= left - 1) {
    int i = __builtin_ctz(left), k = 0;
    while (k < c->count && !continues(&core->slots[i], &c->at[k])) k++;
    if (k < c->count)
      c->at[k].slot = i;
    else
      ethd__slot_free(core, &core->slots[i]);
  }
  unsigned others = c->live & ~core->orphans;
  c->live = core->live;
  core->orphans = 0;
  return others;
}

unsigned ethd__candidates_match(const ethd__core_plan *plan, ethd__core *core, ethd__candidates *c) {
  unsigned open = core->orphans ? settle_orphans(core, c) : c->live;
  for (int i = 0, k; (k = closest(core, open, plan->radius, c, &i)) >= 0;) {
    c->at[k].slot = i;
    open &= ~(1u << i);
  }
  return open;
}

/* ---- in order ---- */

/* Keeps the side of a thin wall on which the contact began, until the effector has moved round an end. */
static void keep_side(ethd__candidate *k, const ethd__slot *slot) {
  if (slot->side == 0 || k->side != -slot->side) return;
  k->n = ethd_vec3_scale(-1, k->n);
  k->distance = -k->distance;
  k->side = slot->side;
}

void ethd__candidates_sort(const ethd__core *core, ethd__candidates *c) {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].slot >= 0) keep_side(&c->at[k], &core->slots[c->at[k].slot]);
  for (int i = 1; i < c->count; i++) {
    if (c->at[i - 1].distance <= c->at[i].distance) continue;
    ethd__candidate k = c->at[i];
    int j = i;
    for (; j > 0 && c->at[j - 1].distance > k.distance; j--) c->at[j] = c->at[j - 1];
    c->at[j] = k;
  }
}
