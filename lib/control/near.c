/* The scenes give the points near the ring, and points for the contacts that no near point continues. The core computes
   the contacts from them.

   The plane is z = 0 of the core's space, and its normals have z = -0: adding a product of such a z doesn't change the
   bits of a sum, not even of -0. */
#include "control/near.h"

#include "control/facts.h"
#include "core/contacts.h"

#define TOUCHES (ETHD_CONTACTS_MAX + 8) /* the most touches of one place that are used, the deepest */

_Static_assert(ETHD__PLACES *TOUCHES + ETHD_CONTACTS_MAX <= ETHD__CANDIDATES, "room");

static ethd_vec3 flat(ethd_vec a) { return (ethd_vec3){a.x, a.y, 0}; }
static ethd_vec3 flat_normal(ethd_vec n) { return (ethd_vec3){n.x, n.y, -0.0}; }

/* A place at this tick, with the ring's centre x in the place's frame. */
typedef struct view {
  const ethd_scene *scene;
  int place;
  ethd__frame frame; /* of a body */
  ethd_vec x;
} view;

static void append(const ethd__tick *t, ethd__candidates *c, const view *from, const ethd_touch *touch, int slot) {
  ethd__candidate *k = &c->at[c->count++];
  k->distance = touch->distance;
  k->point = k->local = flat(touch->point);
  k->n = flat_normal(touch->n);
  k->v = (ethd_vec3){0, 0, 0};
  k->contact_p = ethd__contact_p(t->plan, from->place, touch->material);
  k->place = from->place;
  k->object = touch->object;
  k->feature = touch->feature;
  k->side = touch->side;
  k->slot = slot;
  if (from->place == 0) return;
  const ethd_vec point = ethd__frame_out(&from->frame, touch->point);
  k->n = flat_normal(ethd__frame_turn(&from->frame, touch->n));
  k->point = flat(point);
  k->v = flat(ethd__frame_velocity(&from->frame, point));
}

/* Returns true if an earlier touch, which is deeper, is on the same object and has the same normal within 15 deg. */
static bool is_same_face(const ethd_touch *touches, int i) {
  for (int k = 0; k < i; k++)
    if (touches[k].object == touches[i].object && ethd_vec_dot(touches[k].n, touches[i].n) > ETHD__SAME_WAY)
      return true;
  return false;
}

static bool is_live(const ethd__core *core, unsigned in_use, int place) {
  for (; in_use; in_use &= in_use - 1)
    if (core->slots[__builtin_ctz(in_use)].place == place) return true;
  return false;
}

/* Queries a scene for its touches, unless the ring can't have come near any object since the last query. */
static void ask(ethd__tick *t, const view *from, double range, ethd__candidates *c) {
  ethd_touch touches[TOUCHES];
  ethd__place *p = &t->state->places[from->place];
  if (ethd__place_is_far(p, from->x, range) && !is_live(&t->state->core, c->live, from->place)) return;
  t->trace->queried = true;
  size_t found = ethd_scene_touches(from->scene, from->x, range, touches, TOUCHES);
  int kept = (int)(found < TOUCHES ? found : TOUCHES);
  c->overflow += (int)(found - (size_t)kept);
  for (int i = 0; i < kept; i++)
    if (!is_same_face(touches, i)) append(t, c, from, &touches[i], -1);
  if (found == 0)
    ethd__place_clear(p, from->scene, from->x);
  else
    ethd__place_forget(p);
}

static int index_of(const ethd__candidates *c, const ethd_touch *touch, int place) {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].object == touch->object && c->at[k].feature == touch->feature && c->at[k].place == place) return k;
  return -1;
}

/* Continues a contact that no near touch matches, because it jumped or is out of range: the scene finds the local
   minimum nearest to it. If that isn't a candidate yet, the contact continues there until its state is transparent. */
static void follow(const ethd__tick *t, const view *from, int i, ethd__candidates *c) {
  const ethd__slot *slot = &t->state->core.slots[i];
  ethd_touch touch;
  ethd_scene_follow(from->scene, slot->object, from->x, (ethd_vec){slot->point.x, slot->point.y}, &touch);
  int k = index_of(c, &touch, slot->place);
  if (k >= 0) {
    if (c->at[k].slot < 0) c->at[k].slot = i;
  } else if (slot->state != ETHD_TRANSPARENT) {
    append(t, c, from, &touch, i);
  }
}

/* Transforms the ring into a place's frame. The scene that stands still needs no frame, since it is in R_0. */
static void look_from(const ethd__tick *t, int place, view *out) {
  out->scene = ethd__place_scene(&t->plan->setup, place);
  out->place = place;
  out->x = t->ring.x;
  if (place == 0) return;
  out->frame = ethd__frame_of(&t->state->places[place]);
  out->x = ethd__frame_in(&out->frame, t->ring.x);
}

static void collect(ethd__tick *t, ethd__candidates *c) {
  view views[ETHD__PLACES];
  const double range = ethd__candidates_range(&t->core);
  ethd__core *core = &t->state->core;
  ethd__candidates_begin(c, core);
  for (int place = 0; place < t->plan->places; place++) {
    if (!ethd__place_scene(&t->plan->setup, place) || !t->state->places[place].there) continue;
    look_from(t, place, &views[place]);
    ask(t, &views[place], range, c);
  }
  for (unsigned open = ethd__candidates_match(&t->plan->core, core, c); open; open &= open - 1) {
    int i = __builtin_ctz(open);
    follow(t, &views[core->slots[i].place], i, c);
  }
}

static void show(const ethd__touched *touched, ethd_trace *out) {
  out->contacts = touched->contacts;
  out->overflow = touched->overflow;
  out->object = touched->object;
  out->body = touched->body;
  out->state = touched->state;
  out->eps = touched->eps;
  out->d_re = touched->d_re;
  out->d_fe = touched->d_fe;
  out->v_n = touched->v_n;
  out->beta = touched->beta;
  out->fe[0] = touched->fe.x;
  out->fe[1] = touched->fe.y;
  out->fd[0] = touched->fd.x;
  out->fd[1] = touched->fd.y;
}

static void facts(const void *front, const ethd_contact *contact, ethd_facts *out) ETHD_RT {
  ethd__facts(front, contact, out);
}

static bool work_out(ethd__tick *t) {
  ethd__candidates c;
  if (!t->plan->places) return true;
  collect(t, &c);
  t->state->core.counters.queried += (uint64_t)t->trace->queried;
  return ethd__contacts(&t->core, &c);
}

bool ethd__touch(ethd__tick *t) {
  ethd__core_tick *core = &t->core;
  core->plan = &t->plan->core;
  core->state = &t->state->core;
  core->soft = t->soft;
  core->keeps = t->state == t->scratch;
  core->dt = t->dt;
  core->x = flat(t->ring.x);
  core->v = flat(t->ring.v);
  core->finger = flat(t->finger.x);
  core->finger_v = flat(t->finger.v);
  core->facts = facts;
  core->front = t;
  t->trace->queried = false;
  const bool held = ethd__contacts_begin(core) && work_out(t);
  show(&core->touched, t->trace);
  return held;
}
