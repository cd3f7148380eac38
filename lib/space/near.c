/* The surfaces within range become candidates, the deepest first, and the core computes the contacts from them. */
#include <float.h>

#include "core/contacts.h"
#include "space/state.h"

/* Inserts surface i, whose distance along n is d, by depth; if there is no room, the shallowest is dropped. */
static int insert(int near[ETHD_NEAR_MAX], double depth[ETHD_NEAR_MAX], int count, int i, double d) {
  int at = count < ETHD_NEAR_MAX ? count : ETHD_NEAR_MAX - 1;
  for (; at > 0 && depth[at - 1] > d; at--) {
    near[at] = near[at - 1];
    depth[at] = depth[at - 1];
  }
  near[at] = i;
  depth[at] = d;
  return count < ETHD_NEAR_MAX ? count + 1 : count;
}

/* Finds the surfaces within `range`, the deepest first, and returns how many. */
static int find_near(ethd__space_tick *t, double range, int near[ETHD_NEAR_MAX], double depth[ETHD_NEAR_MAX]) {
  int count = 0, found = 0;
  for (uint32_t i = 0; i < t->count; i++) {
    const ethd_surface *s = &t->surfaces[i];
    const double d = ethd_vec3_dot(s->n, ethd_vec3_sub(s->point, t->core.x));
    if (!(d <= range)) continue;
    found++;
    if (count < ETHD_NEAR_MAX || d < depth[ETHD_NEAR_MAX - 1]) count = insert(near, depth, count, (int)i, d);
  }
  t->trace->overflow += found - count;
  return count;
}

static void show(ethd_space_trace *out, int k, const ethd_surface *s) {
  const ptrdiff_t at = 3 * (ptrdiff_t)k;
  ethd_vec3_put(s->point, out->near_point + at);
  ethd_vec3_put(s->n, out->near_n + at);
  ethd_vec3_put(s->v, out->near_v + at);
  out->near_id[k] = s->id;
  out->near_material[k] = s->material;
}

static bool is_same_face(const ethd__candidates *c, const ethd_surface *s) {
  for (int k = 0; k < c->count; k++)
    if (c->at[k].object == s->id && ethd_vec3_dot(c->at[k].n, s->n) > ETHD__SAME_WAY) return true;
  return false;
}

static void append(const ethd__space_tick *t, ethd__candidates *c, const ethd_surface *s, double d) {
  const ethd__space_plan *plan = t->plan;
  c->at[c->count++] =
      (ethd__candidate){.distance = d,
                        .point = s->point,
                        .n = s->n,
                        .v = s->v,
                        .local = s->point,
                        .contact_p = s->material < 0 ? plan->core.contact_p : plan->setup.material_p[s->material],
                        .object = s->id,
                        .slot = -1};
}

/* Contacts that no surface of their id continues go on at the nearest surface with the same normal within 15 deg,
   within R_r: a mesh with an id for each triangle is one surface for the hand. */
static void continue_by_place(const ethd__space_tick *t, unsigned open, ethd__candidates *c) {
  for (; open; open &= open - 1) {
    const int i = __builtin_ctz(open);
    const ethd__slot *slot = &t->state->core.slots[i];
    ethd__candidate *best = NULL;
    double least = t->plan->core.radius;
    for (int k = 0; k < c->count; k++) {
      const double d = ethd_vec3_norm(ethd_vec3_sub(c->at[k].local, slot->point));
      if (c->at[k].slot >= 0 || !(d <= least) || ethd_vec3_dot(c->at[k].n, slot->past.n) <= ETHD__SAME_WAY) continue;
      best = &c->at[k];
      least = d;
    }
    if (best) best->slot = i;
  }
}

/* ---- the plate's normal ---- */

/* Rotates a unit vector towards another one by at most `most` rad. */
static ethd_vec3 turned(ethd_vec3 from, ethd_vec3 to, double most) {
  if (from.x == to.x && from.y == to.y && from.z == to.z) return to; /* nearly always */
  ethd_vec3 side = ethd_vec3_sub(to, ethd_vec3_scale(ethd_vec3_dot(from, to), from));
  const double across = ethd_vec3_norm(side);
  if (ethd_atan2(across, ethd_vec3_dot(from, to)) <= most) return to;
  if (across < 1e-9) { /* opposite: all directions of rotation are equally short */
    side = fabs(from.x) < 0.6 ? (ethd_vec3){1, 0, 0} : (ethd_vec3){0, 1, 0};
    side = ethd_vec3_sub(side, ethd_vec3_scale(ethd_vec3_dot(from, side), from));
  }
  double sine, cosine;
  ethd_sincos(most, &sine, &cosine);
  const ethd_vec3 r = ethd_vec3_add(ethd_vec3_scale(cosine, from), ethd_vec3_scale(sine / ethd_vec3_norm(side), side));
  return ethd_vec3_scale(1 / ethd_vec3_norm(r), r);
}

static void face(ethd__space_tick *t, const ethd_surface *nearest) {
  ethd_vec3 *facing = &t->state->facing;
  const bool none = facing->x == 0 && facing->y == 0 && facing->z == 0;
  if (nearest) *facing = none ? nearest->n : turned(*facing, nearest->n, t->plan->setup.turn_rate * t->core.dt);
  ethd_vec3_put(*facing, t->trace->facing);
}

/* Gives the ability along the normal as facts for a law that looks ahead. */
static void facts(const void *front, const ethd_contact *contact, ethd_facts *out) ETHD_RT {
  const ethd__space_tick *t = front;
  const ethd_ability *a = &t->ability;
  const ethd__space_state *state = t->state;
  const bool given = t->sense->have & ETHD_SPACE_HAVE_FINGER, by_velocity = t->plan->core.by_velocity;
  out->mass = a->mass;
  out->force = fmin(a->force, t->plan->setup.force);
  out->applied = by_velocity ? (double)NAN : ethd_vec3_dot(contact->n, state->last);
  out->friction = a->friction;
  out->viscous = (double)NAN;
  out->delay = by_velocity ? 0 : a->delay; /* the commanded position is never late */
  out->lag = 0;
  out->ring_radius = t->plan->setup.radius;
  out->finger_radius = t->plan->setup.finger_radius;
  out->finger_age = given || state->filter.started ? 0 : (double)NAN;
  out->finger_a = (double)NAN;
  out->memory = t->state->core.memory;
  out->room = t->plan->setup.effector == ETHD_EFFECTOR_PLATE ? (double)INFINITY : out->ring_radius - out->finger_radius;
  out->acceleration = by_velocity ? fmin(a->acceleration, t->plan->setup.acceleration) : a->acceleration;
}

bool ethd__space_touch(ethd__space_tick *t) {
  ethd__candidates c;
  int near[ETHD_NEAR_MAX];
  double depth[ETHD_NEAR_MAX];
  ethd__core_tick *core = &t->core;
  core->facts = facts;
  core->front = t;
  if (!ethd__contacts_begin(core)) return false;
  t->trace->overflow = 0;
  t->range = fmax(t->range, ethd__candidates_range(core));
  const int count = find_near(t, t->range, near, depth);
  t->trace->near = count;
  face(t, count ? &t->surfaces[near[0]] : NULL);
  if (!count && !core->state->live) return true;
  core->state->counters.queried++;
  ethd__candidates_begin(&c, core->state);
  for (int k = 0; k < count; k++) {
    const ethd_surface *s = &t->surfaces[near[k]];
    show(t->trace, k, s);
    if (!is_same_face(&c, s)) append(t, &c, s, depth[k]);
  }
  continue_by_place(t, ethd__candidates_match(core->plan, core->state, &c), &c);
  return ethd__contacts(core, &c);
}
