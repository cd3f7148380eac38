/* The surfaces near a point. Bounds are tested first: those of all solids together, then each solid's. */
#include "solids/solids.h"

#define FAR 1e100 /* m, m/s, rad/s: no square or product of these overflows */

/* Refuses NaN, without a trap. */
static bool is_within_far(ethd_vec3 v) {
  return islessequal(fabs(v.x), FAR) && islessequal(fabs(v.y), FAR) && islessequal(fabs(v.z), FAR);
}

/* ---- the body's frame ---- */

typedef struct body_frame {
  const ethd_body_pose3 *pose; /* NULL: the frame is R_0 */
  ethd_vec3 axes[3];           /* in R_0 */
} body_frame;

static double squared_length(const double q[4]) { return q[0] * q[0] + q[1] * q[1] + (q[2] * q[2] + q[3] * q[3]); }

bool ethd_body_pose3_is_valid(const ethd_body_pose3 *p) {
  for (int k = 0; k < 4; k++)
    if (!islessequal(fabs(p->orientation[k]), 2)) return false;
  return fabs(sqrt(squared_length(p->orientation)) - 1) <= 1e-6 && is_within_far(p->x) && is_within_far(p->v) &&
         is_within_far(p->rate);
}

static body_frame frame_of(const ethd_body_pose3 *pose) {
  body_frame f = {pose, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (!pose) return f;
  const double w = pose->orientation[0], x = pose->orientation[1], y = pose->orientation[2], z = pose->orientation[3],
               s = 2 / squared_length(pose->orientation);
  f.axes[0] = (ethd_vec3){1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
  f.axes[1] = (ethd_vec3){s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)};
  f.axes[2] = (ethd_vec3){s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)};
  return f;
}

static ethd_vec3 into(const body_frame *f, ethd_vec3 x) {
  if (!f->pose) return x;
  ethd_vec3 r = ethd_vec3_sub(x, f->pose->x);
  return (ethd_vec3){ethd_vec3_dot(f->axes[0], r), ethd_vec3_dot(f->axes[1], r), ethd_vec3_dot(f->axes[2], r)};
}

static ethd_vec3 turned(const body_frame *f, ethd_vec3 v) {
  return ethd_vec3_add(ethd_vec3_scale(v.x, f->axes[0]),
                       ethd_vec3_add(ethd_vec3_scale(v.y, f->axes[1]), ethd_vec3_scale(v.z, f->axes[2])));
}

/* Writes a surface of the body, in R_0. */
static void put(const body_frame *f, const ethd__solid *solid, const ethd__foot *foot, ethd_surface *out) {
  *out = (ethd_surface){foot->point, foot->n, {0, 0, 0}, solid->id, solid->material};
  if (!f->pose) return;
  ethd_vec3 arm = turned(f, foot->point);
  out->point = ethd_vec3_add(f->pose->x, arm);
  out->n = turned(f, foot->n);
  out->v = ethd_vec3_add(f->pose->v, ethd_vec3_cross(f->pose->rate, arm));
}

/* ---- all surfaces ---- */

typedef struct surface_list {
  const ethd_solids *solids;
  body_frame frame;
  ethd_vec3 x, inner; /* in R_0 and in the frame */
  double range;
  ethd_surface *out;
  size_t room, count;
} surface_list;

static bool goes_first(const surface_list *l, const ethd_surface *a, const ethd_surface *b) {
  double of_a = ethd_vec3_dot(a->n, ethd_vec3_sub(a->point, l->x)),
         of_b = ethd_vec3_dot(b->n, ethd_vec3_sub(b->point, l->x));
  return of_a != of_b ? of_a < of_b : a->id < b->id;
}

static void add(surface_list *l, const ethd__solid *solid) {
  ethd__foot foot;
  ethd_surface s;
  ethd__solid_shapes[solid->shape].nearest(l->solids->numbers + solid->first, l->inner, &foot);
  if (!(foot.distance <= l->range)) return;
  put(&l->frame, solid, &foot, &s);
  size_t kept = l->count < l->room ? l->count : l->room, i = kept;
  l->count++;
  while (i > 0 && goes_first(l, &s, &l->out[i - 1])) i--;
  if (i == l->room) return;
  for (size_t k = kept < l->room ? kept : kept - 1; k > i; k--) l->out[k] = l->out[k - 1];
  l->out[i] = s;
}

static double past(double v, double half) {
  double d = fabs(v) - half;
  return d > 0 ? d : 0;
}

/* Returns true if x is farther from the bounds than `reach`, whose square is given. */
static inline bool is_beyond(const ethd__bounds *b, ethd_vec3 x, double reach_squared) {
  double dx = past(x.x - b->centre.x, b->half.x), dy = past(x.y - b->centre.y, b->half.y),
         dz = past(x.z - b->centre.z, b->half.z);
  return dx * dx + dy * dy + dz * dz > reach_squared;
}

size_t ethd_solids_surfaces(const ethd_solids *solids, const ethd_body_pose3 *pose, ethd_vec3 x, double range,
                            ethd_surface *out, size_t room) {
  if (isnan(range) || !is_within_far(x) || (pose && !ethd_body_pose3_is_valid(pose))) return 0;
  surface_list l = {solids, frame_of(pose), x, x, range, out, room, 0};
  l.inner = into(&l.frame, x);
  for (size_t i = solids->bounded; i < solids->count; i++) add(&l, &solids->solids[i]);
  double reach = fmin(fmax(range, 0), 10 * FAR) * (1 + 1e-14);
  if (!solids->bounded || is_beyond(&solids->all, l.inner, reach * reach)) return l.count;
  for (size_t i = 0; i < solids->bounded; i++)
    if (!is_beyond(&solids->bounds[i], l.inner, reach * reach)) add(&l, &solids->solids[i]);
  return l.count;
}
