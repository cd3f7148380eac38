#include "run/front.h"

#include <math.h>
#include <stdio.h>

#define FINGER (ETHD_HAVE_FINGER | ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS)
#define SPACE_FINGER (ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_READING)

static const char *state_of(int64_t state) {
  static const char *const words[] = {"transparent", "braking", "vo"};
  return state >= 0 && state < 3 ? words[state] : "?";
}

/* ---- the plane ---- */

static void merge_plane(const ethd_device *device, ethd__setup_copy *out) {
  ethd_setup *setup = &out->plane;
  const ethd_limits limits = ethd_device_limits(device);
  const ethd_dynamics dynamics = ethd_device_dynamics(device);
  setup->limits = ethd_limits_narrower(&limits, &setup->limits);
  setup->dynamics = ethd_dynamics_known(&dynamics, &setup->dynamics);
}

static void enter_plane(const ethd_config *config, const ethd__setup_copy *setup, void *control, ethd_loop_def *loop) {
  (void)config;
  loop->control = control;
  loop->period = setup->plane.period;
  loop->gap = setup->plane.limits.gap;
}

static ethd_status take_plane(ethd_loop *loop, ethd__row *out) { return ethd_loop_take(loop, &out->plane); }

static ethd__row_head head_plane(const ethd__row *row) {
  const ethd_loop_row *r = &row->plane;
  return (ethd__row_head){.trace = &r->trace,
                          .time_ns = r->trace.sense.time_ns,
                          .fault = r->trace.fault,
                          .share = r->share,
                          .lost = r->lost,
                          .swaps = r->swaps,
                          .marks = r->marks,
                          .armed = r->armed,
                          .sees_finger = r->trace.sense.have & FINGER};
}

static void laws_plane(const ethd__setup_copy *setup, const ethd_law *out[ETHD_TRANSITION + 1]) {
  out[ETHD_TRACKING] = &setup->plane.tracking->law;
  out[ETHD_CONTACT] = &setup->plane.contact->law;
  out[ETHD_TRANSITION] = &setup->plane.transition->law;
}

static void say_plane(const ethd__setup_copy *setup, const ethd__row *row, char *text, size_t size) {
  (void)setup;
  const ethd_trace *t = &row->plane.trace;
  const double share = row->plane.share;
  snprintf(text, size, "%s, beta %.3f, ring %.4f %.4f m, torque %.4f %.4f Nm", state_of(t->state), t->beta, t->x[0],
           t->x[1], share * t->tau[0], share * t->tau[1]);
}

static const ethd__session_front plane = {
    .config = &ethd__front_plane,
    .limits = "limits",
    .merged = {"limits", "arm"},
    .unseen = "no sensor measures the finger, so the ring stands still; add a driver, as in driver = servo, ring, or "
              "reading_x, reading_y and reading_count in the map (step 6)",
    .merge = merge_plane,
    .enter = enter_plane,
    .take = take_plane,
    .head = head_plane,
    .laws = laws_plane,
    .say = say_plane};

/* ---- space ---- */

static void merge_space(const ethd_device *device, ethd__setup_copy *out) {
  const ethd_limits limits = ethd_device_limits(device);
  ethd_space_narrow(&out->space, &limits);
}

/* The controller itself skips surfaces that are too far away. */
static uint32_t near_solids(void *solids, const ethd_space_sense *sense, ethd_surface *out) ETHD_RT {
  const size_t count =
      ethd_solids_surfaces(solids, NULL, ethd_vec3_of(sense->x), (double)INFINITY, out, ETHD_SURFACES_MAX);
  return (uint32_t)(count < ETHD_SURFACES_MAX ? count : ETHD_SURFACES_MAX);
}

static void enter_space(const ethd_config *config, const ethd__setup_copy *setup, void *control, ethd_loop_def *loop) {
  loop->space = control;
  loop->period = setup->space.period;
  loop->gap = setup->space.gap;
  if (!config->solids) return;
  loop->surfaces = near_solids;
  loop->surfaces_of = config->solids;
}

static ethd_status take_space(ethd_loop *loop, ethd__row *out) { return ethd_loop_take_space(loop, &out->space); }

static ethd__row_head head_space(const ethd__row *row) {
  const ethd_space_row *r = &row->space;
  return (ethd__row_head){.trace = &r->trace,
                          .time_ns = r->trace.sense.time_ns,
                          .fault = r->trace.fault,
                          .share = r->share,
                          .lost = r->lost,
                          .swaps = r->swaps,
                          .marks = r->marks,
                          .armed = r->armed,
                          .sees_finger = r->trace.sense.have & SPACE_FINGER};
}

static void laws_space(const ethd__setup_copy *setup, const ethd_law *out[ETHD_TRANSITION + 1]) {
  out[ETHD_TRACKING] = &setup->space.tracking->law;
  out[ETHD_CONTACT] = &setup->space.contact->law;
  out[ETHD_TRANSITION] = &setup->space.transition->law;
}

static void say_space(const ethd__setup_copy *setup, const ethd__row *row, char *text, size_t size) {
  const ethd_space_trace *t = &row->space.trace;
  const double *x = t->sense.x, *u = t->command, share = row->space.share;
  const bool by_velocity = setup->space.kind == ETHD_SPACE_VELOCITY;
  snprintf(text, size, "%s, beta %.3f, effector %.4f %.4f %.4f m, %s %.4f %.4f %.4f %s", state_of(t->state), t->beta,
           x[0], x[1], x[2], by_velocity ? "velocity" : "force", share * u[0], share * u[1], share * u[2],
           by_velocity ? "m/s" : "N");
}

static const ethd__session_front space = {
    .config = &ethd__front_space,
    .limits = "space",
    .merged = {"space", NULL},
    .unseen = "no sensor measures the finger, so the effector stands still; add a driver, as in driver = arm, camera",
    .merge = merge_space,
    .enter = enter_space,
    .take = take_space,
    .head = head_space,
    .laws = laws_space,
    .say = say_space};

const ethd__session_front *ethd__session_front_of(const ethd_config *config) {
  return config->is_space ? &space : &plane;
}
