/* Makes the command from the laws' request.

     velocity   request -> fades -> bounds of contacts and workspace -> speed -> acceleration, along n first
     force      request -> force -> fades -> rate, and force again

   The contacts' bounds come after the fades, so a fade can't drive the effector into a wall. The workspace's bounds
   come after the contacts', so a wall that moves can't push the effector out. A velocity command stops with the
   acceleration; a force command stops by the guard's law (ethd/guard.h), with the mass of the ability. */
#include "core/fade.h"
#include "core/rows.h"
#include "guard/parts.h"
#include "space/state.h"

#define FAST 1.05    /* a commanded effector is stopped at this multiple of the speed limit */
#define OUTSIDE 1e-9 /* m: bound on an effector's distance outside of its workspace by rounding */
#define ROUNDED 1e-9 /* bound on the share by which a command exceeds the speed by rounding */
#define BOUNDS (ETHD_CONTACTS_MAX + ETHD__FACES)

/* Returns the time since the last command, s; a tick without measurement commands zero. */
static double since_last(const ethd__space_tick *t) { return (double)t->periods * t->plan->setup.period; }

/* ---- the workspace ---- */

/* Returns the highest speed from which the command can stop within d, m: as in law/transition_approach.c, with the
   period as the only delay. A command held for a period then goes no farther than d. Half of the acceleration is used,
   so that the effector can brake for four faces at once, in a corner of the box at the ball: 4 (a / 2)^2 = a^2. */
static double highest(const ethd__space_tick *t, double d) {
  const double late = t->core.dt, a = t->plan->setup.acceleration / 2;
  return d > 0 ? 2 * d / (late + sqrt(late * late + 2 * d / a)) : 0;
}

/* Returns the same for the ball, for a command that isn't longer than requested: a tangential motion of l takes the
   effector l^2 / (2 reach) farther from the ball's centre. */
static double highest_in_ball(const ethd__space_tick *t, double d, ethd_vec3 asked) {
  const ethd_space_setup *s = &t->plan->setup;
  const double next = ethd_vec3_norm(t->state->last) + s->acceleration * since_last(t);
  const double way =
      t->core.dt * fmin(fmax(ethd_vec3_norm(asked), ethd_vec3_norm(t->state->last)), fmin(s->speed, next));
  const double left = d - way * way / (2 * s->reach);
  return left > 0 ? highest(t, left) : left / t->core.dt;
}

/* Gives the distances to the workspace's faces, and their outward normals; returns the number of faces. */
static int faces(const ethd__space_tick *t, ethd_vec3 x, double d[ETHD__FACES], ethd_vec3 n[ETHD__FACES]) {
  const ethd_space_setup *s = &t->plan->setup;
  int count = 0;
  if (t->plan->has_box) {
    const double low[3] = {s->x_min, s->y_min, s->z_min}, high[3] = {s->x_max, s->y_max, s->z_max};
    const double at[3] = {x.x, x.y, x.z};
    for (int i = 0; i < 3; i++) {
      const ethd_vec3 axis = {i == 0, i == 1, i == 2};
      if (low[i] > -(double)INFINITY) {
        d[count] = at[i] - low[i];
        n[count++] = ethd_vec3_scale(-1, axis);
      }
      if (high[i] < (double)INFINITY) {
        d[count] = high[i] - at[i];
        n[count++] = axis;
      }
    }
  }
  if (t->plan->has_ball) {
    const ethd_vec3 r = ethd_vec3_sub(x, (ethd_vec3){s->reach_x, s->reach_y, s->reach_z});
    const double length = ethd_vec3_norm(r);
    d[count] = s->reach - length;
    n[count++] = length > 0 ? ethd_vec3_scale(1 / length, r) : (ethd_vec3){1, 0, 0};
  }
  return count;
}

/* ---- reasons to stop the effector ---- */

static int32_t breach(const ethd__space_tick *t, const double *d, int count) {
  const double most = t->plan->setup.speed * (t->plan->core.by_velocity ? FAST : 1);
  int32_t bits = 0;
  if (!(ethd_vec3_norm(ethd_vec3_of(t->sense->v)) <= most)) bits |= ETHD_GUARD_SPEED;
  for (int i = 0; i < count; i++)
    if (!(d[i] >= -OUTSIDE)) bits |= ETHD_GUARD_WORKSPACE;
  return bits;
}

/* ---- velocity ---- */

/* Cuts u to a length by reducing its part perpendicular to the first `count` directions of `own`, which are orthogonal:
   the change along them was needed. That part was within the length before and is only cut back to it, so u changes no
   more than before. */
static ethd_vec3 cut_across(ethd_vec3 u, double most, const ethd_vec3 *own, int count) {
  ethd_vec3 along = {0, 0, 0};
  if (ethd_vec3_norm(u) <= most) return u;
  for (int i = 0; i < count; i++) along = ethd_vec3_add(along, ethd_vec3_scale(ethd_vec3_dot(u, own[i]), own[i]));
  const double part = ethd_vec3_norm(along);
  if (part >= most) return ethd_vec3_scale(most > 0 ? most / part : 0, along);
  const ethd_vec3 across = ethd_vec3_sub(u, along);
  const double left = sqrt((most - part) * (most + part)) * (1 - 1e-15);
  return ethd_vec3_add(along, ethd_vec3_scale(left / ethd_vec3_norm(across), across));
}

/* The bounds of a command: the workspace's faces come first. */
typedef struct limits {
  struct ethd__bound at[BOUNDS];
  int count, faces;
} limits;

/* Changes the last command towards `to` within the acceleration, first along the normals of those bounds that are `due`
   (bits), in their order. A last command over the speed limit, as after a post of a lower limit, doesn't rise
   further. */
static ethd_vec3 go(const ethd__space_tick *t, ethd_vec3 to, const limits *l, unsigned due) {
  ethd_vec3 from = t->state->last, left = ethd_vec3_sub(to, from), own[3];
  double most = t->plan->setup.acceleration * since_last(t);
  int found = 0;
  for (; due && found < 3; due &= due - 1) {
    ethd_vec3 e = l->at[__builtin_ctz(due)].n;
    for (int k = 0; k < found; k++) e = ethd_vec3_sub(e, ethd_vec3_scale(ethd_vec3_dot(e, own[k]), own[k]));
    const double length = ethd_vec3_norm(e);
    if (length < 1e-6) continue;
    own[found] = ethd_vec3_scale(1 / length, e);
    const double wanted = ethd_vec3_dot(left, own[found]);
    const double part = fabs(wanted) <= most ? wanted : copysign(most, wanted);
    from = ethd_vec3_add(from, ethd_vec3_scale(part, own[found]));
    left = ethd_vec3_sub(left, ethd_vec3_scale(wanted, own[found]));
    most = sqrt(fmax(most * most - part * part, 0));
    found++;
  }
  const double rest = ethd_vec3_norm(left), had = ethd_vec3_norm(t->state->last), speed = t->plan->setup.speed;
  return cut_across(ethd_vec3_add(from, rest > most ? ethd_vec3_scale(most / rest, left) : left),
                    had > speed * (1 + ROUNDED) ? had : speed, own, found);
}

static bool satisfies(ethd_vec3 u, const struct ethd__bound *b) { return ethd_vec3_dot(b->n, u) <= b->speed; }

/* Changes the command towards `to` as far as the acceleration allows, first along the normals of the bounds that the
   last command violates. All velocities between two that satisfy a bound satisfy it too. But the change along other
   normals leaves this line, so a bound that it would violate also comes first. */
static ethd_vec3 towards(const ethd__space_tick *t, ethd_vec3 to, const limits *l) {
  unsigned due = 0, crossed;
  ethd_vec3 u;
  for (int i = 0; i < l->count; i++) due |= (unsigned)(l->at[i].held || !satisfies(t->state->last, &l->at[i])) << i;
  do {
    u = go(t, to, l, due);
    crossed = 0;
    for (int i = 0; i < l->faces; i++) crossed |= (unsigned)(!satisfies(u, &l->at[i])) << i;
    crossed &= ~due;
    due |= crossed;
  } while (crossed);
  return u;
}

/* Cuts a velocity to the speed limit, and keeps the inward part that it needs along the ball. */
static ethd_vec3 slower(const ethd__space_tick *t, ethd_vec3 u, const limits *l) {
  const double most = t->plan->setup.speed;
  const ethd_vec3 cut = ethd_vec3_scale(most / ethd_vec3_norm(u), u);
  if (!t->plan->has_ball || satisfies(cut, &l->at[l->faces - 1])) return cut;
  return cut_across(u, most, &l->at[l->faces - 1].n, 1);
}

static ethd_vec3 limit_velocity(ethd__space_tick *t, ethd_vec3 asked, const double *d, const ethd_vec3 *n, int faces_) {
  const ethd_space_setup *s = &t->plan->setup;
  const ethd__touched *touched = &t->core.touched;
  limits l;
  l.count = l.faces = faces_;
  for (int i = 0; i < faces_; i++) l.at[i] = (struct ethd__bound){n[i], highest(t, d[i]), false};
  if (t->plan->has_ball) l.at[faces_ - 1].speed = highest_in_ball(t, d[faces_ - 1], asked);
  for (int i = 0; i < touched->bounds; i++) l.at[l.count++] = touched->bound[i];
  ethd_vec3 u = ethd__space_within(asked, l.at, l.count);
  if (faces_) u = ethd__space_within(u, l.at, faces_);
  if (ethd_vec3_norm(u) > s->speed) {
    u = slower(t, u, &l);
    t->trace->guard |= ETHD_GUARD_TORQUE;
  }
  if (ethd_vec3_norm(ethd_vec3_sub(u, t->state->last)) <= s->acceleration * since_last(t)) return u;
  t->trace->guard |= ETHD_GUARD_RATE;
  return towards(t, u, &l);
}

static ethd_vec3 stop_velocity(ethd__space_tick *t) {
  const ethd_vec3 zero = {0, 0, 0};
  const double most = t->plan->setup.acceleration * since_last(t);
  const bool there = ethd_vec3_norm(t->state->last) <= most;
  if (there && t->state->stopping) t->state->stopped = 1;
  return t->state->stopped || there ? zero : go(t, zero, NULL, 0);
}

/* ---- force ---- */

/* Returns the vector, cut to a length; sets *cut if it was longer. */
static ethd_vec3 at_most(ethd_vec3 f, double most, bool *cut) {
  const double length = ethd_vec3_norm(f);
  if (length <= most) return f;
  *cut = true;
  return ethd_vec3_scale(most / length, f);
}

static ethd_vec3 limit_force(ethd__space_tick *t, ethd_vec3 f) {
  const ethd_space_setup *s = &t->plan->setup;
  const ethd_vec3 last = t->state->last;
  bool cut = false, steep = false;
  f = at_most(f, s->force, &cut);
  f = ethd_vec3_add(last, at_most(ethd_vec3_sub(f, last), s->force_rate * since_last(t), &steep));
  if (steep) f = at_most(f, s->force, &cut);
  t->trace->guard |= (cut ? ETHD_GUARD_TORQUE : 0) | (steep ? ETHD_GUARD_RATE : 0);
  return f;
}

static ethd_vec3 stop_force(ethd__space_tick *t) {
  ethd__space_state *state = t->state;
  const ethd_space_setup *s = &t->plan->setup;
  const double mass = t->ability.mass >= 0 ? t->ability.mass : ETHD_MASS_ASSUMED;
  const double delay = t->ability.delay >= 0 ? t->ability.delay : ETHD_DELAY_ASSUMED;
  const ethd_vec3 v = ethd_vec3_of(t->sense->v), none = {0, 0, 0};
  const ethd__stop_motion motion = {ethd_vec3_norm(v), state->stop.begun ? ethd_vec3_norm(state->last) / mass : 0,
                                    delay + s->period, s->period, t->core.dt};
  const double left = ethd__stop_allowed(&state->stop, &motion);
  if (state->stopping && ethd__stop_is_over(&state->stop, &motion, s->stop_time)) state->stopped = 1;
  if (state->stopped || !(left > 0)) return none;
  bool cut = false;
  return at_most(ethd_vec3_scale(-mass * ethd__stop_decay(&motion, left), v), s->force, &cut);
}

/* ---- both ---- */

static ethd_vec3 faded(ethd__space_tick *t, ethd_vec3 asked) {
  ethd__fade *fade = &t->state->core.fade;
  const ethd__fade_start start = {t->core.soft, t->old, t->plan->setup.swap_time};
  double u[3];
  if (!ethd__fade_advance(fade, t->core.dt, t->core.soft, t->old)) return asked;
  ethd_vec3_put(asked, u);
  ethd__fade_apply(fade, &start, 3, u);
  return ethd_vec3_of(u);
}

void ethd__space_limit(ethd__space_tick *t) {
  ethd__space_state *state = t->state;
  ethd_vec3 asked = ethd_vec3_of(t->trace->asked), n[ETHD__FACES];
  double d[ETHD__FACES];
  const int count = t->plan->has_box || t->plan->has_ball ? faces(t, ethd_vec3_of(t->sense->x), d, n) : 0;
  const bool by_velocity = t->plan->core.by_velocity;
  int32_t bits = breach(t, d, count);
  if (t->plan->core.latches) state->stopping |= bits;
  bits |= state->stopping & ETHD_GUARD_FAULT;
  t->trace->guard = bits;
  if (t->core.soft && !by_velocity) state->last = (ethd_vec3){0, 0, 0}; /* a moving effector must slow down first */
  if (bits || state->stopping) {
    ethd__fade_end(&state->core.fade);
    state->last = by_velocity ? stop_velocity(t) : stop_force(t);
  } else {
    state->stop.begun = 0;
    asked = faded(t, asked);
    state->last = by_velocity ? limit_velocity(t, asked, d, n, count) : limit_force(t, asked);
  }
  const double sum = state->last.x + state->last.y + state->last.z;
  if (!(sum - sum == 0)) { /* unreachable: laws and sense give finite, small numbers; a sum may still overflow */
    state->last = (ethd_vec3){0, 0, 0};
    t->trace->guard |= ETHD_GUARD_FINITE;
  }
  state->cut = t->trace->guard & ETHD_GUARD_TORQUE ? state->cut + t->core.dt : 0;
  ethd_vec3_put(state->last, t->trace->command);
}
