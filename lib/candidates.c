#include "candidates.h"

/* Everything that can count lies within: d_re < d_beta, or d_fe <= d_beta however far the finger is ahead. */
static double reach(const ethd__plan *plan, const ethd_trace *t) ETHD_RT {
  ethd_vec ahead = {t->xf[0] - t->x[0], t->xf[1] - t->x[1]};
  return plan->setup.ring_radius + plan->d_beta + ethd_vec_norm(ahead);
}

/* ---- which touch continues which contact ---- */

/* The closest touch and contact of the same object among those that are open, at most `limit` m apart;
   the touch's index, -1: none. */
static int closest(const ethd__state *state, unsigned open, double limit, const ethd__candidates *c,
                   int *slot) ETHD_RT {
  int best = -1;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    const ethd__slot *s = &state->slots[i];
    if (!(open & (1u << i))) continue;
    for (int k = 0; k < c->count; k++) {
      if (c->at[k].slot >= 0 || c->at[k].touch.object != s->object) continue;
      double d = ethd_vec_norm(ethd_vec_sub(c->at[k].touch.point, s->point));
      if (best < 0 ? !(d <= limit) : !(d < limit)) continue;
      best = k;
      limit = d;
      *slot = i;
    }
  }
  return best;
}

static int index_of(const ethd__candidates *c, const ethd_touch *touch) ETHD_RT {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].touch.object == touch->object && c->at[k].touch.feature == touch->feature) return k;
  return -1;
}

/* A contact that jumped or is out of reach: the scene says which local minimum it is. It lives on until
   its state is transparent. */
static void follow(const ethd__plan *plan, const ethd__slot *slot, int i, ethd_vec x,
                   ethd__candidates *c) ETHD_RT {
  ethd_touch touch;
  ethd_scene_follow(plan->setup.scene, slot->object, x, slot->point, &touch);
  int k = index_of(c, &touch);
  if (k >= 0) {
    if (c->at[k].slot < 0) c->at[k].slot = i;
  } else if (slot->state != ETHD_TRANSPARENT) {
    c->at[c->count++] = (ethd__candidate){touch, i};
  }
}

/* The closest pairs first, so that a contact that ends doesn't leave its state to another one. */
static void match(const ethd__plan *plan, const ethd__state *state, ethd_vec x,
                  ethd__candidates *c) ETHD_RT {
  unsigned open = 0;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++)
    if (state->slots[i].used) open |= 1u << i;
  for (int i = 0, k; (k = closest(state, open, plan->setup.ring_radius, c, &i)) >= 0;) {
    c->at[k].slot = i;
    open &= ~(1u << i);
  }
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++)
    if (open & (1u << i)) follow(plan, &state->slots[i], i, x, c);
}

/* A thin wall's side is the one on which the contact began, until the ring has gone round an end. */
static void keep_side(ethd_touch *touch, const ethd__slot *slot) ETHD_RT {
  if (slot->side == 0 || touch->side != -slot->side) return;
  touch->n = ethd_vec_scale(-1, touch->n);
  touch->distance = -touch->distance;
  touch->side = slot->side;
}

static void sort(ethd__candidates *c) ETHD_RT {
  for (int i = 1; i < c->count; i++) {
    ethd__candidate k = c->at[i];
    int j = i;
    for (; j > 0 && c->at[j - 1].touch.distance > k.touch.distance; j--) c->at[j] = c->at[j - 1];
    c->at[j] = k;
  }
}

void ethd__candidates_collect(const ethd__plan *plan, const ethd__state *state, const ethd_trace *t,
                              ethd__candidates *out) {
  ethd_touch touches[ETHD__TOUCHES];
  ethd_vec x = {t->x[0], t->x[1]};
  size_t found = ethd_scene_touches(plan->setup.scene, x, reach(plan, t), touches, ETHD__TOUCHES);
  out->count = (int)(found < ETHD__TOUCHES ? found : ETHD__TOUCHES);
  out->overflow = (int)(found - (size_t)out->count);
  for (int k = 0; k < out->count; k++) out->at[k] = (ethd__candidate){touches[k], -1};
  match(plan, state, x, out);
  for (int k = 0; k < out->count; k++)
    if (out->at[k].slot >= 0) keep_side(&out->at[k].touch, &state->slots[out->at[k].slot]);
  sort(out);
}
