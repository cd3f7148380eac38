// flags: -I"$site/mujoco/include" "$site"/mujoco/libmujoco.so.* -Wl,-rpath,"$site/mujoco"
// pip: mujoco==3.3.7
// MuJoCo with steps of fixed length. Its contacts are soft constraints, which the pad's Hunt-Crossley isn't: so
// its own are off and the plant's accelerations come in as forces on unit masses, by its passive callback. It
// locates no events: touch is asked anew at each evaluation.
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/ode.h"
#include "bench/peers.h"

enum { HALF = ETHD__ODE_SIZE / 2 };

#define BODY "<body><joint type='slide' axis='1 0 0'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body>"

static const char model[] = "<mujoco><option gravity='0 0 0'><flag constraint='disable' contact='disable'/></option>"
                            "<worldbody>" BODY BODY BODY BODY "</worldbody></mujoco>";

typedef struct mujoco_solver {
  ethd__ode ode;
  mjModel *model;
  mjData *data;
  double step;
} mujoco_solver;

static const mujoco_solver *working; /* its callback knows no user */

static void passive(const mjModel *m, mjData *d) {
  double y[ETHD__ODE_SIZE], rate[ETHD__ODE_SIZE];
  (void)m;
  memcpy(y, d->qpos, HALF * sizeof *y);
  memcpy(y + HALF, d->qvel, HALF * sizeof *y);
  working->ode.rate(working->ode.self, d->time, y, rate);
  for (int i = 0; i < HALF; i++) d->qfrc_passive[i] += rate[HALF + i];
}

static mjModel *load(const char *text) {
  static mjVFS files;
  char message[256];
  mj_defaultVFS(&files);
  mj_addBufferVFS(&files, "model.xml", text, (int)strlen(text));
  mjModel *loaded = mj_loadXML("model.xml", &files, message, sizeof message);
  mj_deleteVFS(&files);
  if (!loaded) abort();
  return loaded;
}

static void *create(const ethd__ode *ode, double step, mjtIntegrator integrator) {
  mujoco_solver *s = calloc(1, sizeof *s);
  if (!s) return NULL;
  s->ode = *ode;
  s->step = step;
  s->model = load(model);
  s->model->opt.integrator = integrator;
  s->data = mj_makeData(s->model);
  return s;
}

static void *create_euler(const ethd__ode *ode, double step) { return create(ode, step, mjINT_EULER); }
static void *create_rk4(const ethd__ode *ode, double step) { return create(ode, step, mjINT_RK4); }

static void work(void *self, double t, double end, double *y) {
  mujoco_solver *s = self;
  double steps = ceil((end - t) / s->step - 1e-9);
  working = s;
  mjcb_passive = passive;
  s->model->opt.timestep = (end - t) / steps;
  s->data->time = t;
  memcpy(s->data->qpos, y, HALF * sizeof *y);
  memcpy(s->data->qvel, y + HALF, HALF * sizeof *y);
  for (; steps > 0; steps--) mj_step(s->model, s->data);
  memcpy(y, s->data->qpos, HALF * sizeof *y);
  memcpy(y + HALF, s->data->qvel, HALF * sizeof *y);
}

static void destroy(void *self) {
  mujoco_solver *s = self;
  mj_deleteData(s->data);
  mj_deleteModel(s->model);
  free(s);
}

/* ---- an arm in space: what a step does for place and Jacobian, and no more ---- */

enum { JOINTS = ETHD__PEER_JOINTS };

static void *create_linkage(const double (*rows)[4]) {
  char text[4096] = "<mujoco><worldbody>", frame[200] = "";
  size_t n = strlen(text);
  mujoco_solver *s = calloc(1, sizeof *s);
  if (!s) return NULL;
  for (int i = 0; i < JOINTS; i++) {
    n += (size_t)snprintf(text + n, sizeof text - n,
                          "<body %s><joint axis='0 0 1'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>", frame);
    if (rows[i][3] != 0) abort();
    snprintf(frame, sizeof frame, "pos='%.17g 0 %.17g' quat='%.17g %.17g 0 0'", rows[i][0], rows[i][2],
             cos(rows[i][1] / 2), sin(rows[i][1] / 2));
  }
  n += (size_t)snprintf(text + n, sizeof text - n, "<site %s/>", frame);
  for (int i = 0; i < JOINTS; i++) n += (size_t)snprintf(text + n, sizeof text - n, "</body>");
  snprintf(text + n, sizeof text - n, "</worldbody></mujoco>");
  s->model = load(text);
  s->data = mj_makeData(s->model);
  return s;
}

static void look(mujoco_solver *s, const double *q, double *out) {
  double moves[3 * JOINTS], turns[3 * JOINTS];
  memcpy(s->data->qpos, q, JOINTS * sizeof *q);
  mj_kinematics(s->model, s->data);
  mj_comPos(s->model, s->data);
  mj_jacSite(s->model, s->data, moves, turns, 0);
  memcpy(out, s->data->site_xpos, 3 * sizeof *out);
  for (int j = 0; j < JOINTS; j++)
    for (int k = 0; k < 3; k++) {
      out[3 + 6 * j + k] = moves[JOINTS * k + j];
      out[6 + 6 * j + k] = turns[JOINTS * k + j];
    }
}

static void work_linkage(void *self, const double (*in)[JOINTS], double (*out)[ETHD__PEER_LINKAGE], size_t count) {
  for (size_t i = 0; i < count; i++) look(self, in[i], out[i]);
}

extern const ethd__peer_linkage peer_linkage;
const ethd__peer_linkage peer_linkage = {"MuJoCo 3.3.7", create_linkage, work_linkage, destroy};

/* ---- joints that follow: unit masses behind MuJoCo's first-order activation, w act - w v on each ---- */

typedef struct mujoco_follower {
  mujoco_solver *masses, *linkage;
  int steps; /* of a period */
} mujoco_follower;

static void *create_follower(const double (*rows)[4], double frequency, double period, int steps, mjtIntegrator how) {
  char text[4096] =
      "<mujoco><option gravity='0 0 0'><flag constraint='disable' contact='disable'/></option><worldbody>";
  size_t n = strlen(text);
  mujoco_follower *f = calloc(1, sizeof *f);
  if (!f) return NULL;
  f->masses = calloc(1, sizeof *f->masses);
  f->linkage = create_linkage(rows);
  f->steps = steps;
  for (int i = 0; i < JOINTS; i++)
    n += (size_t)snprintf(text + n, sizeof text - n,
                          "<body><joint name='%d' type='slide' axis='1 0 0'/>"
                          "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body>",
                          i);
  n += (size_t)snprintf(text + n, sizeof text - n, "</worldbody><actuator>");
  for (int i = 0; i < JOINTS; i++)
    n += (size_t)snprintf(text + n, sizeof text - n,
                          "<general joint='%d' dyntype='%s' dynprm='%.17g' gainprm='%.17g' biastype='affine' "
                          "biasprm='0 0 %.17g'/>",
                          i, how == mjINT_RK4 ? "filter" : "filterexact", 1 / frequency, frequency, -frequency);
  snprintf(text + n, sizeof text - n, "</actuator></mujoco>");
  f->masses->model = load(text);
  f->masses->model->opt.integrator = how;
  f->masses->model->opt.timestep = period / steps;
  f->masses->data = mj_makeData(f->masses->model);
  return f;
}

static void *create_euler_follower(const double (*rows)[4], double frequency, double period) {
  return create_follower(rows, frequency, period, 4, mjINT_EULER);
}

static void *create_rk4_follower(const double (*rows)[4], double frequency, double period) {
  return create_follower(rows, frequency, period, 1, mjINT_RK4);
}

static void work_follower(void *self, const double (*in)[JOINTS], double (*out)[ETHD__PEER_FOLLOWING], size_t count) {
  mujoco_follower *f = self;
  mjData *d = f->masses->data;
  mj_resetData(f->masses->model, d);
  for (size_t i = 0; i < count; i++) {
    memcpy(d->ctrl, in[i], sizeof in[i]);
    for (int k = 0; k < f->steps; k++) mj_step(f->masses->model, d);
    memcpy(out[i], d->qpos, JOINTS * sizeof **out);
    look(f->linkage, d->qpos, out[i] + JOINTS);
  }
}

static void destroy_follower(void *self) {
  mujoco_follower *f = self;
  destroy(f->masses);
  destroy(f->linkage);
  free(f);
}

extern const ethd__peer_following peer_following[];
const ethd__peer_following peer_following[] = {
    {"MuJoCo 3.3.7 Euler 0.5 ms", create_euler_follower, work_follower, destroy_follower},
    {"MuJoCo 3.3.7 RK4 2 ms", create_rk4_follower, work_follower, destroy_follower},
    {0},
};

_Static_assert(mjVERSION_HEADER == 337, "the version is in the names");

extern const ethd__peer_ode peer_ode[];
const ethd__peer_ode peer_ode[] = {
    {"MuJoCo 3.3.7 Euler", 1e-3, 1e-5, 4, 1, create_euler, work, destroy},
    {"MuJoCo 3.3.7 RK4", 1e-3, 2e-5, 2, 1, create_rk4, work, destroy},
    {0},
};
