#include "control/candidates.h"

/* Feet on edges of one object that face the same way within this are one contact: a curve drawn with short
   edges has several local minima around each of its corners, and would push as many times. */
#define SAME_WAY 0.96592582628906829 /* cos 15 deg */

/* Everything that can count lies within: d_re < d_beta, or d_fe <= d_beta however far the finger is ahead. */
static double reach(const ethd__plan *plan, const ethd_trace *t) ETHD_RT {
  ethd_vec ahead = {t->xf[0] - t->x[0], t->xf[1] - t->x[1]};
  return plan->setup.ring_radius + plan->d_beta + ethd_vec_norm(ahead);
}

/* ---- what is near ---- */

static void append(ethd__candidates *c, const ethd_touch *touch, const ethd__frame *frame, int place,
                   int slot) ETHD_RT {
  ethd__candidate *k = &c->at[c->count++];
  k->touch = *touch;
  k->local = touch->point;
  k->place = place;
  k->slot = slot;
  k->v = (ethd_vec){0, 0};
  if (place == 0) return;
  k->touch.n = ethd__frame_turn(frame, touch->n);
  k->touch.point = ethd__frame_out(frame, touch->point);
  k->v = ethd__frame_velocity(frame, k->touch.point);
}

/* The deeper one of two that face the same way stays. */
static int is_same_face(const ethd_touch *touches, int i) ETHD_RT {
  for (int k = 0; k < i; k++)
    if (touches[k].object == touches[i].object && ethd_vec_dot(touches[k].n, touches[i].n) > SAME_WAY) return 1;
  return 0;
}

static unsigned slots_in_use(const ethd__state *state) ETHD_RT {
  unsigned bits = 0;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) bits |= (unsigned)(state->slots[i].used != 0) << i;
  return bits;
}

static int is_live(const ethd__state *state, unsigned in_use, int place) ETHD_RT {
  for (; in_use; in_use &= in_use - 1)
    if (state->slots[__builtin_ctz(in_use)].place == place) return 1;
  return 0;
}

static void look_around(const ethd_scene *scene, ethd__state *state, int place, const ethd__frame *frame, ethd_vec x,
                        double range, ethd__candidates *c) ETHD_RT {
  ethd_touch touches[ETHD__TOUCHES];
  ethd__place *p = &state->places[place];
  if (ethd__place_is_far(p, x, range) && !is_live(state, c->live, place)) return;
  c->queried = 1;
  size_t found = ethd_scene_touches(scene, x, range, touches, ETHD__TOUCHES);
  int kept = (int)(found < ETHD__TOUCHES ? found : ETHD__TOUCHES);
  c->overflow += (int)(found - (size_t)kept);
  for (int i = 0; i < kept; i++)
    if (!is_same_face(touches, i)) append(c, &touches[i], frame, place, -1);
  if (found == 0)
    ethd__place_clear(p, scene, x);
  else
    ethd__place_forget(p);
}

/* ---- which touch continues which contact ---- */

/* The closest touch and contact of the same object among those that are open, at most `limit` m apart;
   the touch's index, -1: none. */
static int closest(const ethd__state *state, unsigned open, double limit, const ethd__candidates *c,
                   int *slot) ETHD_RT {
  int best = -1;
  for (; open; open &= open - 1) {
    int i = __builtin_ctz(open);
    const ethd__slot *s = &state->slots[i];
    for (int k = 0; k < c->count; k++) {
      const ethd__candidate *t = &c->at[k];
      if (t->slot >= 0 || t->touch.object != s->object || t->place != s->place) continue;
      double d = ethd_vec_norm(ethd_vec_sub(t->local, s->point));
      if (best < 0 ? !(d <= limit) : !(d < limit)) continue;
      best = k;
      limit = d;
      *slot = i;
    }
  }
  return best;
}

static int index_of(const ethd__candidates *c, const ethd_touch *touch, int place) ETHD_RT {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].touch.object == touch->object && c->at[k].touch.feature == touch->feature && c->at[k].place == place)
      return k;
  return -1;
}

/* A contact that jumped or is out of reach: the scene says which local minimum it is. It lives on until
   its state is transparent. */
static void follow(const ethd_scene *scene, const ethd__slot *slot, int i, const ethd__frame *frame, ethd_vec x,
                   ethd__candidates *c) ETHD_RT {
  ethd_touch touch;
  ethd_scene_follow(scene, slot->object, x, slot->point, &touch);
  int k = index_of(c, &touch, slot->place);
  if (k >= 0) {
    if (c->at[k].slot < 0) c->at[k].slot = i;
  } else if (slot->state != ETHD_TRANSPARENT) {
    append(c, &touch, frame, slot->place, i);
  }
}

/* The closest pairs first, so that a contact that ends doesn't leave its state to another one. The rest
   stays open. */
static unsigned match(const ethd__plan *plan, const ethd__state *state, ethd__candidates *c) ETHD_RT {
  unsigned open = c->live;
  for (int i = 0, k; (k = closest(state, open, plan->setup.ring_radius, c, &i)) >= 0;) {
    c->at[k].slot = i;
    open &= ~(1u << i);
  }
  return open;
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

void ethd__candidates_collect(const ethd__plan *plan, ethd__state *state, const ethd_trace *t, ethd__candidates *out) {
  ethd__frame frames[ETHD__PLACES];
  ethd_vec x[ETHD__PLACES];
  double range = reach(plan, t);
  out->count = out->overflow = out->queried = 0;
  out->live = slots_in_use(state);
  for (int place = 0; place < plan->places; place++) {
    const ethd_scene *scene = ethd__place_scene(&plan->setup, place);
    if (!scene || !state->places[place].there) continue;
    frames[place] = ethd__frame_of(&state->places[place]);
    x[place] = ethd__frame_in(&frames[place], (ethd_vec){t->x[0], t->x[1]});
    look_around(scene, state, place, &frames[place], x[place], range, out);
  }
  for (unsigned open = match(plan, state, out); open; open &= open - 1) {
    int i = __builtin_ctz(open);
    const ethd__slot *slot = &state->slots[i];
    follow(ethd__place_scene(&plan->setup, slot->place), slot, i, &frames[slot->place], x[slot->place], out);
  }
  for (int k = 0; k < out->count; k++)
    if (out->at[k].slot >= 0) keep_side(&out->at[k].touch, &state->slots[out->at[k].slot]);
  sort(out);
}
