/* Your own driver, for an arm whose dynamics MuJoCo works out: any model with motors at two to seven joints, a posture as its
   first key and a site `plate`, whose z points from the hand into the plate, such as ur5e.xml. It takes forces, or velocities,
   which a servo of the joints follows by computed torques (Luh, Walker and Paul 1980). Configuration: driver =
   file:mujoco_arm.so, camera; mujoco_arm.model = ur5e.xml. First build it:
     cc -shared -fPIC mujoco_arm.c $(pkg-config --cflags ethd-drivers) -lmujoco -o mujoco_arm.so */
#include <ethd/driver.h>
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 6, JOINTS = ETHD_JOINTS_MAX, PAST = 256 };
#define SPEED 3.14      /* rad/s, of each joint at most */
#define ACCELERATION 40 /* rad/s^2 */
#define LEVER 0.2       /* m: by which a turn, rad, counts beside a way, m */
#define DAMPED 0.02     /* m: damping of the inverse (Nakamura and Hanafusa 1986) */
#define SERVO 80        /* rad/s: frequency of the servo's error, critically damped */
#define TURN 5          /* 1/s, of the plate to the normal that it is told, at most 1 rad/s */
#define SPIN 30         /* 1/s: forces: how quickly the plate takes that turn */

typedef struct mujoco_arm {
  mjModel *model;
  mjData *real, *told;     /* the plant; the joints as they are commanded */
  double delay, period;    /* s: the first from a command to its torques */
  int32_t n, plate, force; /* joints; the site; 1: forces are commanded */
  _Atomic int32_t safe;
  int64_t tick;
  double past[PAST][JOINTS];                     /* what the joints were told: rad/s, or Nm of forces */
  double servo_q[JOINTS], servo_v[JOINTS], v[3]; /* where the servo wants the joints now; how the plate is told to go */
  ethd_space_command held;
  ethd_joint_limits limits;
} mujoco_arm;

/* Fills the plate's way and, at LEVER, turn with each joint; the command and, at LEVER, the turn to its normal. */
static void look(const mujoco_arm *a, const mjData *d, double (*j)[JOINTS], double task[ROWS]) {
  const double *r = d->site_xmat + 9 * a->plate, facing[3] = {r[2], r[5], r[8]};
  double rows[ROWS * JOINTS];
  mj_jacSite(a->model, d, rows, rows + 3 * a->n, a->plate);
  for (int i = 0; i < ROWS * a->n; i++) j[i / a->n][i % a->n] = (i < 3 * a->n ? 1 : LEVER) * rows[i];
  mju_copy3(task, a->held.value);
  mju_cross(task + 3, facing, a->held.normal);
  mju_scl3(task + 3, task + 3, LEVER * fmin(TURN, 1 / fmax(1e-9, mju_norm3(task + 3))));
  if (a->held.safe) mju_zero(task, ROWS);
}

/* Fills J^T (J J^T + DAMPED^2 I)^-1 task. */
static void inverse(const mujoco_arm *a, double (*j)[JOINTS], const double task[ROWS], double *out) {
  double square[ROWS * ROWS], y[ROWS];
  for (int i = 0; i < ROWS * ROWS; i++)
    square[i] = mju_dot(j[i / ROWS], j[i % ROWS], a->n) + (i % (ROWS + 1) ? 0 : DAMPED * DAMPED);
  mju_cholFactor(square, ROWS, 0);
  mju_cholSolve(y, square, task, ROWS);
  mju_zero(out, a->n);
  for (int i = 0; i < ROWS; i++) mju_addToScl(out, j[i], y[i], a->n);
}

/* Works out joint speeds, and where the plate goes with them. */
static void move_joints(mujoco_arm *a, const double *before, double *dq) {
  const double *x = a->told->site_xpos + 3 * a->plate, was[3] = {x[0], x[1], x[2]};
  double task[ROWS], j[ROWS][JOINTS];
  look(a, a->told, j, task), inverse(a, j, task, dq);
  (void)ethd_guard_joints(&a->limits, a->told->qpos, before, dq);
  mju_addToScl(a->told->qpos, dq, a->period, a->n);
  mj_kinematics(a->model, a->told), mj_comPos(a->model, a->told);
  mju_sub3(a->v, x, was), mju_scl3(a->v, a->v, 1 / a->period);
}

/* Works out joint torques without gravity's: the point goes as a force moves a free arm, while the plate turns. */
static void push_joints(const mujoco_arm *a, double *torque) {
  double task[ROWS], j[ROWS][JOINTS], rise[JOINTS];
  look(a, a->real, j, task);
  mju_zero(torque, a->n);
  for (int i = 0; i < 3; i++) mju_addToScl(torque, j[i], task[i], a->n);
  mj_solveM(a->model, a->real, rise, torque, 1);
  for (int i = a->held.safe ? 0 : 3; i < ROWS; i++) task[i] = SPIN * (task[i] - mju_dot(j[i], a->real->qvel, a->n));
  for (int i = 0; i < 3 && !a->held.safe; i++) task[i] = mju_dot(j[i], rise, a->n);
  inverse(a, j, task, rise);
  mj_mulM(a->model, a->real, torque, rise);
}

/* Moves the plant by a period: by torques, or so that the joints' speeds rise to those that they were told. */
static void pass(mujoco_arm *a, const double *told) {
  const double step = a->model->opt.timestep;
  mjData *d = a->real;
  double rise[JOINTS], wanted[JOINTS], torque[JOINTS];
  for (int k = 0; k < a->n; k++) rise[k] = (told[k] - a->servo_v[k]) / a->period;
  for (double t = 0; t < a->period - step / 2; t += step) {
    mj_step1(a->model, d);
    for (int k = 0; k < a->n; k++) {
      wanted[k] = rise[k] + SERVO * (2 * (a->servo_v[k] - d->qvel[k]) + SERVO * (a->servo_q[k] - d->qpos[k]));
      a->servo_q[k] += step * (a->servo_v[k] + step / 2 * rise[k]), a->servo_v[k] += step * rise[k];
    }
    mj_mulM(a->model, d, torque, wanted);
    mju_add(d->ctrl, d->qfrc_bias, a->force ? told : torque, a->n);
    mj_step2(a->model, d);
  }
}

static ethd_status start(void *device) {
  mujoco_arm *a = device;
  mj_resetDataKeyframe(a->model, a->real, 0), mj_forward(a->model, a->real), mj_copyData(a->told, a->model, a->real);
  mju_zero(a->past[0], PAST * JOINTS), mju_zero(a->servo_v, JOINTS), mju_zero3(a->v);
  mju_copy(a->servo_q, a->real->qpos, a->n), a->tick = 0;
  a->safe = 0;
  return ETHD_OK;
}

static ethd_status read_arm(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  const mujoco_arm *a = device;
  const mjData *d = a->force ? a->real : a->told;
  double spin[6];
  mj_objectVelocity(a->model, a->real, mjOBJ_SITE, a->plate, spin, 0);
  out->time_ns = now_ns;
  mju_copy3(out->x, d->site_xpos + 3 * a->plate), mju_copy3(out->v, a->force ? spin + 3 : a->v);
  for (int i = 0; i < 3; i++) out->normal[i] = d->site_xmat[9 * a->plate + 3 * i + 2], out->commanded[i] = a->v[i];
  out->have |= ETHD_SPACE_HAVE_NORMAL | (a->force ? 0 : ETHD_SPACE_HAVE_COMMANDED);
  return ETHD_OK;
}

static ethd_status write_arm(void *device, int64_t now_ns, const ethd_space_command *asked) ETHD_RT {
  mujoco_arm *a = device;
  double *before = a->past[a->tick % PAST], *next = a->past[++a->tick % PAST];
  a->held = *asked, a->held.safe |= a->safe;
  a->force ? push_joints(a, next) : move_joints(a, before, next);
  pass(a, a->past[(a->tick + PAST - (int64_t)fmin(PAST - 1, rint(a->delay / a->period))) % PAST]);
  return (void)now_ns, ETHD_OK;
}

/* Each joint's bounds bound the plate, which dq moves by 1 along n; forces move the mass 1 / (n J M^-1 J^T n). */
static ethd_ability able(const void *device, const double n[3]) ETHD_RT {
  const mujoco_arm *a = device;
  double j[ROWS][JOINTS], task[ROWS], dq[JOINTS], torque[JOINTS] = {0}, rise[JOINTS], fast = (double)INFINITY;
  ethd_ability can = ethd_ability_unknown();
  look(a, a->force ? a->real : a->told, j, task), mju_zero(task, ROWS), mju_copy3(task, n);
  inverse(a, j, task, dq);
  for (int k = 0; k < a->n; k++) fast = fmin(fast, 1 / fabs(dq[k]));
  for (int i = 0; i < 3; i++) mju_addToScl(torque, j[i], n[i], a->n);
  mj_solveM(a->model, a->real, rise, torque, 1);
  can.speed = fast * SPEED, can.acceleration = fast * ACCELERATION, can.delay = a->delay + a->period / 2;
  return can.mass = 1 / mju_dot(torque, rise, a->n), can;
}

static void safe(void *device) ETHD_RT { ((mujoco_arm *)device)->safe = 1; }

static uint32_t figures(const void *device, ethd_figure *out, uint32_t max) { /* what is true */
  static const char *const names[] = {"plate x", "plate y", "plate z", "plate v_x", "plate v_y", "plate v_z"};
  const mujoco_arm *a = device;
  double spin[6], *x = a->real->site_xpos + 3 * a->plate;
  uint32_t i = 0;
  mj_objectVelocity(a->model, a->real, mjOBJ_SITE, a->plate, spin, 0);
  for (; i < 6 && i < max; i++) out[i] = (ethd_figure){names[i], i < 3 ? "m" : "m/s", i < 3 ? x[i] : spin[i]};
  return i;
}

static ethd_status open_arm(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  mujoco_arm *a = *device = calloc(1, sizeof *a);
  const ethd_setting *file = NULL;
  char path[400] = "", why[400] = "model: the file of one is missing";
  if (!a) return ETHD_E_MEMORY;
  a->delay = ethd_driver_plugin.params[0].def;
  const ethd_status status = ethd_settings_read(&ethd_driver_plugin, def, &a->delay, &file, message);
  if (status) return status;
  if (file) snprintf(path, sizeof path, "%s/%s", *file->value == '/' ? "" : def->folder, file->value);
  const mjModel *m = a->model = file ? mj_loadXML(path, NULL, why, sizeof why) : NULL;
  a->plate = m ? mj_name2id(m, mjOBJ_SITE, "plate") : -1, a->n = m ? m->nv : 0;
  if (m && (a->plate < 0 || a->n < 2 || a->n > JOINTS || a->n != m->nu || !m->nkey || memchr(m->jnt_limited, 0, a->n)))
    snprintf(why, sizeof why, "model: a site `plate`, a key, and 2 to 7 joints with a motor and a range are needed");
  if (*why) return snprintf(message, ETHD_MESSAGE_MAX, "%.400s", why), ETHD_E_FILE;
  a->period = def->space->period, a->force = def->space->kind == ETHD_SPACE_FORCE;
  a->limits = (ethd_joint_limits){.count = (uint32_t)a->n, .kind = ETHD_JOINTS_SPEED, .period = a->period};
  for (int k = 0; k < a->n; k++)
    a->limits.joint[k] = (ethd_joint_limit){m->jnt_range[2 * k], m->jnt_range[2 * k + 1], SPEED, ACCELERATION, 1, 0};
  a->real = mj_makeData(m), a->told = mj_makeData(m);
  return a->real && a->told ? start(a) : ETHD_E_MEMORY;
}

static void close_arm(void *device) {
  mujoco_arm *a = device;
  mj_deleteData(a->real), mj_deleteData(a->told), mj_deleteModel(a->model), free(a);
}

const ethd_driver ethd_driver_plugin = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "mujoco_arm",
    .brief = "an arm that MuJoCo simulates",
    .params = &(const ethd_param){"delay", "s", 0, 0.1, 0.008, "time from a command to its torques"},
    .param_count = 1,
    .keys = (const char *const[]){"model", NULL},
    .open = open_arm,
    .start = start,
    .safe = safe,
    .close = close_arm,
    .figures = figures,
    .read_space = read_arm,
    .write_space = write_arm,
    .able = able,
    .safe_is = ETHD_SAFE_NO_SPEED};
