#include "control/candidates.h"

/* Touches of one object whose normals differ by less than this angle are one contact, the deepest. A curve drawn with
   short edges has several local minima around each of its corners and would push as many times. */
#define SAME_WAY 0.96592582628906829 /* cos 15 deg */

/* Returns the distance from the ring's centre within which all that can count lies: d_re < near, or d_fr <= d_beta
   however far ahead the finger is. */
static double range_of(const ethd__tick *t) {
  double behind = t->plan->d_beta + ethd_vec_norm(ethd_vec_sub(t->finger.x, t->ring.x));
  return t->plan->setup.ring_radius + (behind > t->near ? behind : t->near);
}

/* A place as this tick sees it: the ring's centre x is in the place's frame. */
typedef struct view {
  const ethd_scene *scene;
  int place;
  ethd__frame frame; /* of a body */
  ethd_vec x;
} view;

/* ---- what is near ---- */

static void append(ethd__candidates *c, const view *from, const ethd_touch *touch, int slot) {
  ethd__candidate *k = &c->at[c->count++];
  k->touch = *touch;
  k->local = touch->point;
  k->place = from->place;
  k->slot = slot;
  k->v = (ethd_vec){0, 0};
  if (from->place == 0) return;
  k->touch.n = ethd__frame_turn(&from->frame, touch->n);
  k->touch.point = ethd__frame_out(&from->frame, touch->point);
  k->v = ethd__frame_velocity(&from->frame, k->touch.point);
}

/* Returns true if an earlier touch, which is deeper, is on the same object and faces the same way. */
static bool is_same_face(const ethd_touch *touches, int i) {
  for (int k = 0; k < i; k++)
    if (touches[k].object == touches[i].object && ethd_vec_dot(touches[k].n, touches[i].n) > SAME_WAY) return true;
  return false;
}

static bool is_live(const ethd__state *state, unsigned in_use, int place) {
  for (; in_use; in_use &= in_use - 1)
    if (state->slots[__builtin_ctz(in_use)].place == place) return true;
  return false;
}

/* Asks a scene for its touches, unless the ring can't have come near anything since it was last asked. */
static void ask(const view *from, ethd__state *state, double range, ethd__candidates *c) {
  ethd_touch touches[ETHD__TOUCHES];
  ethd__place *p = &state->places[from->place];
  if (ethd__place_is_far(p, from->x, range) && !is_live(state, c->live, from->place)) return;
  c->queried = true;
  size_t found = ethd_scene_touches(from->scene, from->x, range, touches, ETHD__TOUCHES);
  int kept = (int)(found < ETHD__TOUCHES ? found : ETHD__TOUCHES);
  c->overflow += (int)(found - (size_t)kept);
  for (int i = 0; i < kept; i++)
    if (!is_same_face(touches, i)) append(c, from, &touches[i], -1);
  if (found == 0)
    ethd__place_clear(p, from->scene, from->x);
  else
    ethd__place_forget(p);
}

/* ---- which touch continues which contact ---- */

/* Finds the closest pair of a touch and an open contact on the same object, at most `limit` m apart. Returns the
   touch's index, -1 if there is no such pair; *slot is the contact's. */
static int closest(const ethd__state *state, unsigned open, double limit, const ethd__candidates *c, int *slot) {
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

static int index_of(const ethd__candidates *c, const ethd_touch *touch, int place) {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].touch.object == touch->object && c->at[k].touch.feature == touch->feature && c->at[k].place == place)
      return k;
  return -1;
}

/* Continues a contact that no near touch matches, because it jumped or is out of range: the scene finds the local
   minimum nearest to it. If that one isn't a candidate, the contact goes on until its state is transparent. */
static void follow(const view *from, const ethd__slot *slot, int i, ethd__candidates *c) {
  ethd_touch touch;
  ethd_scene_follow(from->scene, slot->object, from->x, slot->point, &touch);
  int k = index_of(c, &touch, slot->place);
  if (k >= 0) {
    if (c->at[k].slot < 0) c->at[k].slot = i;
  } else if (slot->state != ETHD_TRANSPARENT) {
    append(c, from, &touch, i);
  }
}

/* A surface of a new scene counts as the old scene's if this tick's touches of both differ by no more than this. */
#define SAME_PLACE 1e-6 /* m, and rad of the normals */

static bool continues(const ethd__slot *slot, const ethd__candidate *k) {
  /* a thin wall keeps the normal of the side on which the contact began */
  double side = slot->side != 0 && k->touch.side == -slot->side ? -1 : 1;
  return k->slot < 0 && k->place == slot->place && ethd_vec_norm(ethd_vec_sub(k->local, slot->point)) <= SAME_PLACE &&
         ethd_vec_norm(ethd_vec_sub(ethd_vec_scale(side, k->touch.n), slot->past.n)) <= SAME_PLACE;
}

/* Contacts whose scene was replaced go on if the new scene has the same surface, whatever its number there, and end if
   not. Returns the other contacts' slots. */
static unsigned settle_orphans(ethd__state *state, ethd__candidates *c) {
  for (unsigned left = state->orphans & c->live; left; left &= left - 1) {
    int i = __builtin_ctz(left), k = 0;
    while (k < c->count && !continues(&state->slots[i], &c->at[k])) k++;
    if (k < c->count)
      c->at[k].slot = i;
    else
      ethd__slot_free(state, &state->slots[i]);
  }
  unsigned others = c->live & ~state->orphans;
  c->live = state->live;
  state->orphans = 0;
  return others;
}

/* Pairs touches with contacts, the closest first, so that a contact that ends doesn't pass its state on to another.
   Returns the slots that stay open. */
static unsigned match(const ethd__plan *plan, ethd__state *state, ethd__candidates *c) {
  unsigned open = state->orphans ? settle_orphans(state, c) : c->live;
  for (int i = 0, k; (k = closest(state, open, plan->setup.ring_radius, c, &i)) >= 0;) {
    c->at[k].slot = i;
    open &= ~(1u << i);
  }
  return open;
}

/* Keeps the side of a thin wall on which the contact began, until the ring has gone round an end. */
static void keep_side(ethd_touch *touch, const ethd__slot *slot) {
  if (slot->side == 0 || touch->side != -slot->side) return;
  touch->n = ethd_vec_scale(-1, touch->n);
  touch->distance = -touch->distance;
  touch->side = slot->side;
}

static void sort(ethd__candidates *c) {
  for (int i = 1; i < c->count; i++) {
    ethd__candidate k = c->at[i];
    int j = i;
    for (; j > 0 && c->at[j - 1].touch.distance > k.touch.distance; j--) c->at[j] = c->at[j - 1];
    c->at[j] = k;
  }
}

/* Gives the ring as seen from a place. The scene that stands still needs no frame, since it is in R_0. */
static void look_from(const ethd__tick *t, int place, view *out) {
  out->scene = ethd__place_scene(&t->plan->setup, place);
  out->place = place;
  out->x = t->ring.x;
  if (place == 0) return;
  out->frame = ethd__frame_of(&t->state->places[place]);
  out->x = ethd__frame_in(&out->frame, t->ring.x);
}

void ethd__candidates_collect(const ethd__tick *t, ethd__candidates *out) {
  view views[ETHD__PLACES];
  ethd__state *state = t->state;
  double range = range_of(t);
  out->count = out->overflow = 0;
  out->queried = false;
  out->live = state->live;
  for (int place = 0; place < t->plan->places; place++) {
    if (!ethd__place_scene(&t->plan->setup, place) || !state->places[place].there) continue;
    look_from(t, place, &views[place]);
    ask(&views[place], state, range, out);
  }
  for (unsigned open = match(t->plan, state, out); open; open &= open - 1) {
    int i = __builtin_ctz(open);
    follow(&views[state->slots[i].place], &state->slots[i], i, out);
  }
  for (int k = 0; k < out->count; k++)
    if (out->at[k].slot >= 0) keep_side(&out->at[k].touch, &state->slots[out->at[k].slot]);
  sort(out);
}
