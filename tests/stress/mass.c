#include "stress/mass.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- figures ---- */

static void judge(double measured, double expected, double off, double most, const char *what, va_list words) {
  char text[160];
  vsnprintf(text, sizeof text, what, words);
  ck_assert_msg(off <= most, "%s: %.12g beside %.12g, %.3g of %.3g", text, measured, expected, off, most);
}

void near(double measured, double analytic, double share, const char *what, ...) {
  va_list words;
  va_start(words, what);
  judge(measured, analytic, fabs(measured - analytic), share * fabs(analytic), what, words);
  va_end(words);
}

void within(double measured, double analytic, double distance, const char *what, ...) {
  va_list words;
  va_start(words, what);
  judge(measured, analytic, fabs(measured - analytic), distance, what, words);
  va_end(words);
}

void bound(double measured, double most, const char *what, ...) {
  va_list words;
  va_start(words, what);
  judge(measured, most, measured, most, what, words);
  va_end(words);
}

int64_t pick(int64_t some, int64_t many) { return getenv("ETHD_STRESS") ? many : some; }

/* ---- the rig ---- */

void mass_velocity(mass_rig *r, ethd_velocity_method method, double value) {
  char name[64];
  ethd_setup_velocity(&r->on.setup, method);
  if (!ethd_velocity_methods[method].param_count) return;
  snprintf(name, sizeof name, "velocity.%s", ethd_velocity_methods[method].params[0].name);
  rig_set(&r->on.setup, name, value);
}

void mass_brakes(mass_rig *r, double damping, double v_th) {
  rig_set(&r->on.setup, "transition.b_d", damping);
  rig_set(&r->on.setup, "transition.v_th", v_th);
  rig_set(&r->on.setup, "transition.eps_max", (double)INFINITY);
  rig_set(&r->on.setup, "transition.t_max", (double)INFINITY);
}

void mass_open(mass_rig *r, double mass, double gap) {
  memset(r, 0, sizeof *r);
  rig_open(&r->on, NULL);
  rig_set(&r->on.setup, "tracking.k_t", 0);
  rig_set(&r->on.setup, "tracking.b_t", 0);
  r->mass = mass;
  r->force_limit = (double)INFINITY;
  r->gap = gap;
}

/* J^T push at the present pose. */
static ethd_vec pushed(const mass_rig *r) {
  ethd_pose pose;
  if (r->push.x == 0 && r->push.y == 0) return (ethd_vec){0, 0};
  ethd_arm_pose(&r->on.setup.arm, r->q, &pose);
  return ethd_mat_mul_transposed(pose.j, r->push);
}

void mass_push(mass_rig *r, ethd_vec push) {
  r->push = push;
  ethd_vec out = pushed(r);
  for (int i = 0; i < r->delay; i++) {
    r->way[i][0] = -out.x;
    r->way[i][1] = -out.y;
  }
}

/* The simulator's arm, without a finger, at rest or as fast as the rig on both sides. */
static void place(mass_rig *r) {
  ethd_sim_def def = {.arm = r->on.setup.arm,
                      .ring_radius = 1,
                      .period = r->on.setup.period,
                      .step = r->on.setup.period,
                      .tolerance = ETHD_SIM_GOLDEN};
  def.plant.mass[0] = def.plant.mass[1] = r->mass;
  def.plant.motor_mass = r->motor_mass;
  def.plant.stiffness = r->spring;
  def.plant.damping = r->damper;
  def.plant.friction = r->friction;
  def.plant.finger_mass = 1;
  def.plant.force_limit = 1e9;
  ethd__body_prepare(&def, 0, &r->body);
  memset(&r->state, 0, sizeof r->state);
  r->state.clearance = 1e9;
  ethd__body_place(&r->body, r->q, &r->state);
  for (int j = 0; j < 2; j++) r->state.v[ETHD__LINK + j] = r->state.v[ETHD__MOTOR + j] = r->w[j];
  ethd__body_refer(&r->body, &r->state);
}

static void move_softly(mass_rig *r, const double tau[2], ethd_vec out) {
  const ethd__piece still = {.begin = -(double)INFINITY, .end = (double)INFINITY};
  r->body.torque[0] = tau[0] + out.x;
  r->body.torque[1] = tau[1] + out.y;
  ethd__body_advance(&r->body, &still, 0, r->on.setup.period, &r->state);
  ethd__body_joints(&r->body, r->state.q, r->q);
  ethd__body_joints(&r->body, r->state.v, r->w);
}

void mass_start(mass_rig *r, double speed) {
  char wall[64];
  snprintf(wall, sizeof wall, "halfplane -1 0 %.17g\n", r->gap + r->on.setup.ring_radius - r->on.setup.arm.link2);
  r->on.setup.scene = r->on.scene = rig_scene(wall);
  rig_start(&r->on);
  r->q[0] = M_PI / 2;
  r->q[1] = 0;
  r->w[0] = speed / r->on.setup.arm.link1;
  r->w[1] = 0;
  mass_push(r, r->push);
  if (r->motor_mass > 0) place(r);
}

void mass_close(mass_rig *r) { rig_close(&r->on); }

ethd_sense mass_sense(const mass_rig *r) {
  ethd_sense s;
  memset(&s, 0, sizeof s);
  s.time_ns = (int64_t)rint((double)r->tick * (1e9 * r->on.setup.period));
  s.have = (r->measured ? ETHD_HAVE_DQ : 0) | (r->has_finger ? ETHD_HAVE_FINGER : 0);
  s.missed = r->missed > 0 ? r->missed : 0;
  memcpy(s.q, r->q, sizeof s.q);
  memcpy(s.dq, r->w, sizeof s.dq);
  s.finger[0] = r->finger.x, s.finger[1] = r->finger.y;
  s.finger_v[0] = r->finger_v.x, s.finger_v[1] = r->finger_v.y;
  return s;
}

const ethd_trace *mass_step(mass_rig *r) {
  ethd_sense sense = mass_sense(r);
  (void)rig_try(&r->on, &sense);
  r->missed = -1; /* the move that follows belongs to this step */
  return &r->on.trace;
}

/* The motors' present torque: the command of `delay` ticks ago, limited. */
static void torque(mass_rig *r, double out[2]) {
  const ethd_arm *arm = &r->on.setup.arm;
  double *slot = r->way[r->delay ? r->tick % r->delay : 0];
  for (int j = 0; j < 2; j++) {
    double most = r->force_limit * (j ? arm->link2 : arm->link1), now = r->on.command.torque[j];
    out[j] = fmin(fmax(r->delay ? slot[j] : now, -most), most);
    slot[j] = now;
  }
}

void mass_move(mass_rig *r) {
  const ethd_arm *arm = &r->on.setup.arm;
  double tau[2], T = r->on.setup.period;
  ethd_vec out = pushed(r);
  torque(r, tau);
  if (r->motor_mass > 0) move_softly(r, tau, out);
  for (int j = 0; j < 2 && !(r->motor_mass > 0); j++) {
    double link = j ? arm->link2 : arm->link1;
    double a = (tau[j] + (j ? out.y : out.x)) / (r->mass * link * link);
    r->q[j] += T * r->w[j] + T * T / 2 * a;
    r->w[j] += T * a;
  }
  r->tick++;
  r->missed++;
}

const ethd_trace *mass_tick(mass_rig *r) {
  mass_step(r);
  mass_move(r);
  return &r->on.trace;
}

double mass_depth(const mass_rig *r) { return (r->q[0] - M_PI / 2) * r->on.setup.arm.link1; }

double mass_speed(const mass_rig *r) { return r->w[0] * r->on.setup.arm.link1; }

/* ---- growth ---- */

static void shift(double *past, int count, double newest) {
  memmove(past + 1, past, (size_t)(count - 1) * sizeof *past);
  past[0] = newest;
}

static double difference(const double *x, int order) {
  return order == 1 ? x[0] - x[1] : (x[0] - x[1]) - (x[1] - x[2]);
}

/* c = |z|^2k of a swing; where one real mode is all that is left, c drowns in rounding and y counts. */
typedef struct amplitude {
  double c, y;
} amplitude;

static amplitude measure(const double y[3]) {
  return (amplitude){fabs(y[1] * y[1] - y[0] * y[2]), fmax(fabs(y[0]), fmax(fabs(y[1]), fabs(y[2])))};
}

static bool is_swing(amplitude a) { return a.c > 1e-5 * a.y * a.y; }

double mass_growth(mass_rig *r, const swing_span *s) {
  double x[3] = {0}, y[3] = {0};
  amplitude first = {0, 0}, last = {0, 0};
  double peak = 0;
  for (int k = 0; k <= s->settle + s->span; k++) {
    mass_tick(r);
    shift(x, 3, mass_depth(r));
    if (k < s->order) continue;
    shift(y, 3, difference(x, s->order));
    if (k < s->order + 2) continue;
    if (!(fabs(y[0]) <= s->ceiling)) return (double)INFINITY;
    last = measure(y);
    peak = fmax(peak, last.y);
    if (last.y < s->floor) return log(s->floor / peak) / k;
    if (k == s->settle) first = last;
  }
  if (is_swing(first) && is_swing(last)) return log(last.c / first.c) / (2 * s->span);
  return log(last.y / first.y) / s->span;
}
