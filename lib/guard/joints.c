/* Bounds of each joint; ethd/guard.h has the derivation. */
#include <math.h>
#include <stdbool.h>

#include "error.h"
#include "ethd/guard.h"
#include "fp_mode.h"

#define INF ((double)INFINITY)
#define SLOWEST 1e-6 /* rad/s^2 */
#define ALONE 1e-6   /* an excess below this share of the largest request doesn't scale the vector */

typedef struct window {
  double lo, hi;
  ethd_joints_bound below, above; /* the limits that set the ends */
} window;

/* Returns the largest speed towards a bound at the distance d. */
static double approach(double d, double a, double T) {
  if (!(d > 0)) return 0;
  if (!(d < INF)) return INF;
  if (!(a < INF)) return d / T;
  const double step = a * T, root = sqrt(1 + 8 * d / (step * T)), k = floor((root - 1) / 2);
  return (d / T + k * (k + 1) * step / 2) / (k + 1);
}

static void narrow(window *w, double lo, double hi, ethd_joints_bound bound) {
  if (hi < w->hi) w->hi = hi, w->above = bound;
  if (lo > w->lo) w->lo = lo, w->below = bound;
}

/* Moves both ends to within [lo, hi], which has priority. */
static void force(window *w, double lo, double hi, ethd_joints_bound bound) {
  if (w->hi > hi) w->hi = hi, w->above = bound;
  if (w->lo < lo) w->lo = lo, w->below = bound;
  if (w->hi < lo) w->hi = lo, w->above = bound;
  if (w->lo > hi) w->lo = hi, w->below = bound;
}

/* Returns the speeds that a joint's position and its largest speed allow. */
static window places(const ethd_joint_limit *j, double a, double T, double q) {
  window w = {-INF, INF, ETHD_JOINTS_FREE, ETHD_JOINTS_FREE};
  narrow(&w, -approach(q - j->least, a, T), approach(j->most - q, a, T), ETHD_JOINTS_POSITION);
  narrow(&w, -j->speed, j->speed, ETHD_JOINTS_FAST);
  return w;
}

/* Returns the allowed speeds of a joint after this period. */
static window speeds(const ethd_joint_limit *j, double a, double T, double q, double v) {
  window w = places(j, a, T, q);
  if (a < INF) force(&w, v - a * T, v + a * T, ETHD_JOINTS_ACCELERATION);
  return w;
}

static window torques(const ethd_joint_limit *j, double T, double q, double v) {
  window w = {-INF, INF, ETHD_JOINTS_FREE, ETHD_JOINTS_FREE};
  if (j->inertia > 0) {
    const double a = fmax(fmin(j->acceleration, j->torque / j->inertia), SLOWEST);
    w = speeds(j, a, T, q + v * T / 2, v);
    w.lo = (w.lo - v) * j->inertia / T;
    w.hi = (w.hi - v) * j->inertia / T;
  }
  force(&w, -j->torque, j->torque, ETHD_JOINTS_STRONG);
  return w;
}

/* Returns the largest share of `asked` within the window. It is 1 if no share is within it, or if the excess is below
   ALONE. */
static double share_of(const window *w, double asked, double most) {
  if (asked <= w->hi && asked >= w->lo) return 1;
  const double end = asked > w->hi ? w->hi : w->lo;
  if (fabs(asked - end) <= ALONE * most) return 1;
  const double share = end / asked;
  return share >= 0 && share <= 1 ? share : 1;
}

static bool are_finite(const ethd_joint_limits *limits, const double *numbers) {
  double sum = 0;
  for (uint32_t i = 0; i < limits->count; i++) sum += numbers[i] - numbers[i]; /* NaN for a number that isn't finite */
  return sum == 0;
}

static bool is_sound(const ethd_joint_limits *limits) {
  bool sound = limits->count >= 1 && limits->count <= ETHD_JOINTS_MAX && limits->period >= 1e-5 && limits->period <= 1;
  for (uint32_t i = 0; sound && i < limits->count; i++) {
    const ethd_joint_limit *j = &limits->joint[i];
    sound = j->least <= j->most && j->speed >= 0 && j->acceleration >= SLOWEST && j->torque >= 0 && j->inertia >= 0;
  }
  return sound;
}

static double clamp(const window *w, double value, ethd_joints_bound *bound) {
  *bound = value > w->hi ? w->above : value < w->lo ? w->below : ETHD_JOINTS_FREE;
  return value > w->hi ? w->hi : value < w->lo ? w->lo : value;
}

/* Notes the joint that bound the command, unless one has already. */
static void note(ethd_joints_ruling *r, uint32_t joint, ethd_joints_bound bound) {
  if (bound == ETHD_JOINTS_FREE || r->joint >= 0) return;
  r->joint = (int32_t)joint;
  if (r->bound != ETHD_JOINTS_FINITE) r->bound = bound;
}

/* Scales the command to the largest share that every window allows. */
static void scale(const ethd_joint_limits *limits, const window *w, double most, double *command,
                  ethd_joints_ruling *r) {
  ethd_joints_bound bound, by = ETHD_JOINTS_FREE;
  uint32_t joint = 0;
  for (uint32_t i = 0; i < limits->count; i++) {
    const double share = share_of(&w[i], command[i], most);
    if (share >= r->share) continue;
    r->share = share;
    joint = i;
    (void)clamp(&w[i], command[i], &by);
  }
  note(r, joint, by);
  for (uint32_t i = 0; i < limits->count; i++) {
    command[i] = clamp(&w[i], r->share * command[i], &bound);
    note(r, i, bound);
  }
}

/* Goes from v towards the command by the largest share that every joint's acceleration allows: the arm's velocity stays
   between the two, and takes no other direction. A joint whose own v isn't allowed, since it must brake for its
   position, is bounded alone and holds up no other. Returns true if the command isn't reached. */
static bool change(const ethd_joint_limits *limits, const double *q, const double *v, double *command,
                   ethd_joints_ruling *r) {
  window w[ETHD_JOINTS_MAX];
  double from[ETHD_JOINTS_MAX], share = 1;
  ethd_joints_bound bound, by = ETHD_JOINTS_FREE;
  uint32_t joint = 0;
  bool cut = false;
  for (uint32_t i = 0; i < limits->count; i++) {
    const ethd_joint_limit *j = &limits->joint[i];
    w[i] = speeds(j, j->acceleration, limits->period, q[i], v[i]);
    from[i] = clamp(&w[i], v[i], &bound);
    const double within = clamp(&w[i], command[i], &bound);
    if (bound == ETHD_JOINTS_FREE) continue;
    const double part = from[i] == v[i] ? (within - from[i]) / (command[i] - from[i]) : 1;
    cut = true;
    if (by != ETHD_JOINTS_FREE && part >= share) continue;
    share = fmin(part, share);
    joint = i;
    by = bound;
  }
  if (!cut) return false;
  note(r, joint, by);
  for (uint32_t i = 0; i < limits->count; i++)
    command[i] = clamp(&w[i], from[i] + share * (command[i] - from[i]), &bound);
  return true;
}

/* Returns the share of `asked` in the command, 0 to 1. */
static double share_along(uint32_t count, const double *command, const double *asked) {
  double along = 0, all = 0;
  for (uint32_t i = 0; i < count; i++) {
    along += command[i] * asked[i];
    all += asked[i] * asked[i];
  }
  return all > 0 ? fmin(fmax(along / all, 0), 1) : 1;
}

ETHD__FP_APART static ethd_joints_ruling bound_all(const ethd_joint_limits *limits, const double *q, const double *v,
                                                   double *command) {
  ethd_joints_ruling r = {.share = 1, .joint = -1};
  window w[ETHD_JOINTS_MAX];
  double most = 0, asked[ETHD_JOINTS_MAX];
  const bool by_torque = limits->kind == ETHD_JOINTS_TORQUE;
  const bool known = is_sound(limits) && are_finite(limits, q) && are_finite(limits, v);
  if (!known || !are_finite(limits, command)) {
    r.bound = ETHD_JOINTS_FINITE;
    for (uint32_t i = 0; i < limits->count && i < ETHD_JOINTS_MAX; i++) command[i] = 0;
    if (!known) return r;
  }
  for (uint32_t i = 0; i < limits->count; i++) {
    const ethd_joint_limit *j = &limits->joint[i];
    w[i] = by_torque ? torques(j, limits->period, q[i], v[i]) : places(j, j->acceleration, limits->period, q[i]);
    most = fmax(most, fabs(command[i]));
    asked[i] = command[i];
  }
  scale(limits, w, most, command, &r);
  if (!by_torque && change(limits, q, v, command, &r)) r.share = share_along(limits->count, command, asked);
  for (uint32_t i = 0; i < limits->count; i++)
    if (fabs(command[i] - r.share * asked[i]) > ALONE * most) r.turned = 1;
  return r;
}

ethd_joints_ruling ethd_guard_joints(const ethd_joint_limits *limits, const double *q, const double *v,
                                     double *command) {
  ETHD__FP_RETURN(ethd_joints_ruling, bound_all(limits, q, v, command));
}

ETHD__FP_APART static ethd_status check_all(const ethd_joint_limits *limits, ethd_error *error) {
  ethd_status status = ethd__check_number(error, "count", limits->count, 1, ETHD_JOINTS_MAX);
  if (!status) status = ethd__check_number(error, "kind", limits->kind, ETHD_JOINTS_SPEED, ETHD_JOINTS_TORQUE);
  if (!status) status = ethd__check_number(error, "period", limits->period, 1e-5, 1);
  for (uint32_t i = 0; !status && i < limits->count; i++) {
    const ethd_joint_limit *j = &limits->joint[i];
    status = ethd__check_number(error, "most", j->most, -INF, INF);
    if (!status) status = ethd__check_number(error, "least", j->least, -INF, j->most);
    if (!status) status = ethd__check_number(error, "speed", j->speed, 0, INF);
    if (!status) status = ethd__check_number(error, "acceleration", j->acceleration, SLOWEST, INF);
    if (!status) status = ethd__check_number(error, "torque", j->torque, 0, INF);
    if (!status) status = ethd__check_number(error, "inertia", j->inertia, 0, INF);
    static const char *const names[ETHD_JOINTS_MAX] = {"joint1", "joint2", "joint3", "joint4",
                                                       "joint5", "joint6", "joint7"};
    if (status) ethd__error_prefix(error, names[i]);
  }
  return status;
}

ethd_status ethd_joint_limits_check(const ethd_joint_limits *limits, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, check_all(limits, error));
}
