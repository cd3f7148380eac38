#include "stress/rig.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "stress/stress.h"

ethd_scene *ethd__stress_rig_wall(double c) {
  double numbers[3] = {-1, 0, c};
  ethd_object_def wall = {ETHD_SHAPE_HALFPLANE, -1, numbers, 3, 0};
  ethd_scene_def def = {&wall, 1, NULL, 0};
  ethd_scene *scene;
  ethd_error error;
  if (ethd_scene_create(&def, &scene, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "scene: %s", ethd_status_sentence(error.status));
  return scene;
}

static void refused(const ethd_error *error) {
  ethd__fail(ETHD_EXIT_FAILED, "%s: %s (found %g, from %g to %g)", error->name, ethd_status_sentence(error->status),
             error->found, error->min, error->max);
}

void ethd__stress_set(ethd_setup *setup, const char *name, double value) {
  ethd_error error;
  if (ethd_setup_set(setup, name, value, &error) < 0) refused(&error);
}

void ethd__stress_rig_velocity(ethd__stress_rig *rig, ethd_velocity_method method, double value) {
  char name[64];
  ethd_setup_velocity(&rig->setup, method);
  if (!ethd_velocity_methods[method].param_count) return;
  snprintf(name, sizeof name, "velocity.%s", ethd_velocity_methods[method].params[0].name);
  ethd__stress_set(&rig->setup, name, value);
}

void ethd__stress_rig_brakes(ethd__stress_rig *rig, double damping, double v_th) {
  ethd__stress_set(&rig->setup, "transition.b_d", damping);
  ethd__stress_set(&rig->setup, "transition.v_th", v_th);
  ethd__stress_set(&rig->setup, "transition.eps_max", (double)INFINITY);
  ethd__stress_set(&rig->setup, "transition.t_max", (double)INFINITY);
}

void ethd__stress_rig_open(ethd__stress_rig *rig, double mass, double gap) {
  memset(rig, 0, sizeof *rig);
  rig->setup = ethd_setup_default();
  ethd__stress_set(&rig->setup, "tracking.k_t", 0);
  ethd__stress_set(&rig->setup, "tracking.b_t", 0);
  rig->mass = mass;
  rig->force_limit = (double)INFINITY;
  rig->gap = gap;
}

/* J^T push at the present pose. */
static ethd_vec pushed(const ethd__stress_rig *rig) {
  ethd_pose pose;
  if (rig->push.x == 0 && rig->push.y == 0) return (ethd_vec){0, 0};
  ethd_arm_pose(&rig->setup.arm, rig->q, &pose);
  return ethd_mat_mul_transposed(pose.j, rig->push);
}

void ethd__stress_rig_push(ethd__stress_rig *rig, ethd_vec push) {
  rig->push = push;
  ethd_vec out = pushed(rig);
  for (int i = 0; i < rig->delay; i++) {
    rig->way[i][0] = -out.x;
    rig->way[i][1] = -out.y;
  }
}

/* The simulator's arm, without a finger, at rest or as fast as the rig on both sides. */
static void place(ethd__stress_rig *rig) {
  ethd_sim_def def = {.arm = rig->setup.arm,
                      .ring_radius = 1,
                      .period = rig->setup.period,
                      .step = rig->setup.period,
                      .tolerance = ETHD_SIM_GOLDEN};
  def.plant.mass[0] = def.plant.mass[1] = rig->mass;
  def.plant.motor_mass = rig->motor_mass;
  def.plant.stiffness = rig->spring;
  def.plant.damping = rig->damper;
  def.plant.friction = rig->friction;
  def.plant.finger_mass = 1;
  def.plant.force_limit = 1e9;
  ethd__body_prepare(&def, 0, &rig->body);
  memset(&rig->state, 0, sizeof rig->state);
  rig->state.clearance = 1e9;
  ethd__body_place(&rig->body, rig->q, &rig->state);
  for (int j = 0; j < 2; j++) rig->state.v[ETHD__LINK + j] = rig->state.v[ETHD__MOTOR + j] = rig->w[j];
  ethd__body_refer(&rig->body, &rig->state);
}

static void move_softly(ethd__stress_rig *rig, const double tau[2], ethd_vec out) {
  const ethd__piece still = {.begin = -(double)INFINITY, .end = (double)INFINITY};
  rig->body.torque[0] = tau[0] + out.x;
  rig->body.torque[1] = tau[1] + out.y;
  ethd__body_advance(&rig->body, &still, 0, rig->setup.period, &rig->state);
  ethd__body_joints(&rig->body, rig->state.q, rig->q);
  ethd__body_joints(&rig->body, rig->state.v, rig->w);
}

void ethd__stress_rig_start(ethd__stress_rig *rig, double speed) {
  ethd_error error;
  rig->scene = ethd__stress_rig_wall(rig->gap + rig->setup.ring_radius - rig->setup.arm.link2);
  rig->setup.scene = rig->scene;
  if (ethd_control_create(&rig->setup, &rig->control, &error) < 0) refused(&error);
  rig->q[0] = M_PI / 2;
  rig->q[1] = 0;
  rig->w[0] = speed / rig->setup.arm.link1;
  rig->w[1] = 0;
  ethd__stress_rig_push(rig, rig->push);
  if (rig->motor_mass > 0) place(rig);
}

void ethd__stress_rig_close(ethd__stress_rig *rig) {
  ethd_control_destroy(rig->control);
  ethd_scene_destroy(rig->scene);
}

ethd_sense ethd__stress_rig_sense(const ethd__stress_rig *rig) {
  ethd_sense s;
  memset(&s, 0, sizeof s);
  s.time_ns = (int64_t)rint((double)rig->tick * (1e9 * rig->setup.period));
  s.have = (rig->measured ? ETHD_HAVE_DQ : 0) | (rig->has_finger ? ETHD_HAVE_FINGER : 0);
  s.missed = rig->missed > 0 ? rig->missed : 0;
  memcpy(s.q, rig->q, sizeof s.q);
  memcpy(s.dq, rig->w, sizeof s.dq);
  s.finger[0] = rig->finger.x, s.finger[1] = rig->finger.y;
  s.finger_v[0] = rig->finger_v.x, s.finger_v[1] = rig->finger_v.y;
  return s;
}

const ethd_trace *ethd__stress_rig_step(ethd__stress_rig *rig) {
  ethd_sense sense = ethd__stress_rig_sense(rig);
  rig->status = ethd_control_step(rig->control, &sense, &rig->command, &rig->trace);
  rig->missed = -1; /* the move that follows belongs to this step */
  return &rig->trace;
}

/* The motors' present torque: the command of `delay` ticks ago, limited. */
static void torque(ethd__stress_rig *rig, double out[2]) {
  const ethd_arm *arm = &rig->setup.arm;
  double *slot = rig->way[rig->delay ? rig->tick % rig->delay : 0];
  for (int j = 0; j < 2; j++) {
    double most = rig->force_limit * (j ? arm->link2 : arm->link1), now = rig->command.torque[j];
    out[j] = fmin(fmax(rig->delay ? slot[j] : now, -most), most);
    slot[j] = now;
  }
}

void ethd__stress_rig_move(ethd__stress_rig *rig) {
  const ethd_arm *arm = &rig->setup.arm;
  double tau[2], T = rig->setup.period;
  ethd_vec out = pushed(rig);
  torque(rig, tau);
  if (rig->motor_mass > 0) move_softly(rig, tau, out);
  for (int j = 0; j < 2 && !(rig->motor_mass > 0); j++) {
    double link = j ? arm->link2 : arm->link1;
    double a = (tau[j] + (j ? out.y : out.x)) / (rig->mass * link * link);
    rig->q[j] += T * rig->w[j] + T * T / 2 * a;
    rig->w[j] += T * a;
  }
  rig->tick++;
  rig->missed++;
}

const ethd_trace *ethd__stress_rig_tick(ethd__stress_rig *rig) {
  ethd__stress_rig_step(rig);
  ethd__stress_rig_move(rig);
  return &rig->trace;
}

double ethd__stress_rig_depth(const ethd__stress_rig *rig) { return (rig->q[0] - M_PI / 2) * rig->setup.arm.link1; }

double ethd__stress_rig_speed(const ethd__stress_rig *rig) { return rig->w[0] * rig->setup.arm.link1; }

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

double ethd__stress_rig_growth(ethd__stress_rig *rig, const ethd__swing *s) {
  double x[3] = {0}, y[3] = {0};
  amplitude first = {0, 0}, last = {0, 0};
  double peak = 0;
  for (int k = 0; k <= s->settle + s->span; k++) {
    ethd__stress_rig_tick(rig);
    shift(x, 3, ethd__stress_rig_depth(rig));
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
