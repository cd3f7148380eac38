#include "unit/rig.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ethd_scene *rig_scene(const char *text) {
  ethd_scene *scene;
  ethd_error error;
  if (ethd_scene_parse(text, strlen(text), &scene, &error) != ETHD_OK)
    ck_abort_msg("scene line %d: %s", error.line, error.name);
  return scene;
}

void rig_open(rig *r, const char *scene) {
  memset(r, 0, sizeof *r);
  r->setup = ethd_setup_default();
  if (scene) r->setup.scene = r->scene = rig_scene(scene);
}

ethd_control *rig_control(const ethd_setup *setup) {
  ethd_control *control;
  ethd_error error;
  ethd_status status = ethd_control_create(setup, &control, &error);
  if (status != ETHD_OK) ck_abort_msg("create: %s: %s", error.name, ethd_status_sentence(status));
  return control;
}

void rig_start(rig *r) { r->control = rig_control(&r->setup); }

void rig_set(ethd_setup *setup, const char *name, double value) {
  ethd_error error;
  ck_assert_msg(ethd_setup_set(setup, name, value, &error) == ETHD_OK, "%s: %s (found %g, from %g to %g)", error.name,
                ethd_status_sentence(error.status), error.found, error.min, error.max);
}

void rig_begin(rig *r, const char *scene, const ethd_transition_law *law) {
  rig_open(r, scene);
  if (law) ethd_setup_transition(&r->setup, law);
  rig_start(r);
}

void rig_close(rig *r) {
  ethd_control_destroy(r->control);
  ethd_scene_destroy(r->scene);
}

/* Law of cosines in the triangle base, elbow, ring. */
static void angles(const ethd_arm *arm, ethd_vec x, double *link1, double *link2) {
  double l1 = arm->link1, l2 = arm->link2, r2 = x.x * x.x + x.y * x.y;
  double turn = -acos((r2 - l1 * l1 - l2 * l2) / (2 * l1 * l2));
  *link1 = atan2(x.y, x.x) - atan2(l2 * sin(turn), l1 + l2 * cos(turn));
  *link2 = *link1 + turn;
}

ethd_sense rig_sense(const ethd_arm *arm, const motion *m) {
  ethd_sense s;
  double a, b;
  memset(&s, 0, sizeof s);
  angles(arm, m->x, &a, &b);
  /* the speeds a', b' of the absolute angles: V = a' L1 (-sin a, cos a) + b' L2 (-sin b, cos b) */
  double sine = sin(b - a);
  double da = (cos(b) * m->v.x + sin(b) * m->v.y) / (arm->link1 * sine);
  double db = -(cos(a) * m->v.x + sin(a) * m->v.y) / (arm->link2 * sine);
  int serial = arm->mechanism == ETHD_ARM_SERIAL;
  s.have = ETHD_HAVE_DQ | ETHD_HAVE_FINGER;
  s.q[0] = a;
  s.q[1] = serial ? b - a : b;
  s.dq[0] = da;
  s.dq[1] = serial ? db - da : db;
  memcpy(s.finger, &m->xf, sizeof s.finger);
  memcpy(s.finger_v, &m->vf, sizeof s.finger_v);
  return s;
}

ethd_status rig_try(rig *r, const ethd_sense *sense) {
  r->sense = *sense;
  r->status = ethd_control_step(r->control, &r->sense, &r->command, &r->trace);
  return r->status;
}

const ethd_trace *rig_step(rig *r, const motion *m) {
  int64_t now = r->sense.time_ns + 1000000;
  ethd_sense sense = rig_sense(&r->setup.arm, m);
  sense.time_ns = now;
  if (rig_try(r, &sense) != ETHD_OK)
    ck_abort_msg("tick %lld: %s", (long long)r->trace.tick, ethd_status_sentence(r->status));
  return &r->trace;
}

void rig_post(rig *r) {
  ethd_error error;
  ethd_status status = ethd_control_post(r->control, &r->setup, &error);
  if (status != ETHD_OK) ck_abort_msg("post: %s: %s", error.name, ethd_status_sentence(status));
}

uint64_t rig_counted(const rig *r, int row) {
  ethd_counters c;
  ethd_control_counters(r->control, &c);
  return c.faults[row];
}

ethd_event rig_poll(rig *r) {
  ethd_event event;
  memset(&event, 0, sizeof event);
  if (ethd_control_poll(r->control, &event) == ETHD_STATUS_EMPTY) event.kind = (ethd_event_kind)0;
  return event;
}

motion rig_at(double d, double v, double ahead) {
  return (motion){{0.25 + d, 0.25}, {-v, 0}, {0.25 + d - ahead, 0.25}, {-v, 0}};
}
