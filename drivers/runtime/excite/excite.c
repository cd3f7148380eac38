/* Multisine excitation of the arm, to identify its parameters from the motion; a soft spring holds the ring near a
   point. The driver reports a virtual finger, whose position and velocity make the tracking law command these torques:

     tau = K_t J^-1 (X_f - X_r) + B_t J^-1 (V_f - V_r)    with X_f the point, and V_f = J tau_sines / B_t

   so that law, guard and recording are those of any session. It follows a driver of the motors:
   [device] driver = servo, excite. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/control.h"
#include "ethd/driver.h"
#include "ethd/maths.h"
#include "no_joints.h"
#include "text/error_text.h"

#define TAU 6.28318530717958647692
#define LOOK 20.0 /* s: range of the search for the peak of the sines' sum */
#define LINES 20  /* sines of each joint */
#define PEAK 0.7  /* share of the limit for the sines' peak; the rest is for the spring */

enum { TORQUE, LOW, HIGH, X, Y, HALF, PARAMS };

static const ethd_param params[PARAMS] = {
    [TORQUE] = {"torque", "Nm", 1e-4, 1e4, 0.1, "largest torque of a joint; the sines use seven tenths of it"},
    [LOW] = {"low", "Hz", 0.1, 100, 0.5, "lowest frequency"},
    [HIGH] = {"high", "Hz", 1, 400, 40, "highest frequency"},
    [X] = {"x", "m", -100, 100, 0.25, "x of the middle of the box"},
    [Y] = {"y", "m", -100, 100, 0.25, "y of the middle of the box"},
    [HALF] = {"half", "m", 1e-3, 10, 0.05, "half the side of the box that the ring must not leave"},
};

typedef struct excite {
  double p[PARAMS];
  ethd_arm arm;
  double damping;                      /* B_t, Nms/rad */
  double w[2][LINES], phase[2][LINES]; /* rad/s, rad */
  double size[2];                      /* Nm, amplitude of each sine of a joint */
  int64_t begin;                       /* ns; INT64_MIN: it hasn't begun */
} excite;

/* ---- sines ---- */

static double sines(const excite *e, int joint, double t) {
  double sum = 0;
  for (int i = 0; i < LINES; i++) sum += ethd_sin(fmod(e->w[joint][i] * t, TAU) + e->phase[joint][i]);
  return sum;
}

/* Chooses the sines. Their frequencies are a geometric series, with those of joint 2 between those of joint 1, so that
   the torques don't repeat and each minute gives new information. Phases follow the golden ratio, so that the sines
   don't add up at any instant. */
static void lay(excite *e, int joint) {
  const double golden = 0.61803398874989485;
  double low = ethd_log(e->p[LOW]), high = ethd_log(e->p[HIGH]), peak = 0;
  for (int i = 0; i < LINES; i++) {
    e->w[joint][i] = TAU * ethd_exp(low + (high - low) * (2 * i + joint) / (2 * LINES - 1));
    e->phase[joint][i] = TAU * fmod((i * (i + 1) / 2 + 7 * joint) * golden, 1);
  }
  for (double t = 0; t < LOOK; t += 1e-3) peak = fmax(peak, fabs(sines(e, joint, t)));
  e->size[joint] = PEAK * e->p[TORQUE] / peak;
}

/* ---- driver ---- */

static ethd_status open_excite(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  excite *e = *device = calloc(1, sizeof *e);
  if (!e) return ETHD_E_MEMORY;
  ethd_params_default(params, PARAMS, e->p);
  ethd_status status = ethd_settings_read(&ethd_driver_excite, def, e->p, NULL, message);
  if (status) return status;
  const char *file = def->file ? def->file : "the defaults";
  e->arm = def->setup->arm;
  e->damping = ethd_setup_get(def->setup, "tracking.b_t");
  e->begin = INT64_MIN;
  if (!(e->damping > 0))
    return ethd__say(message, ETHD_E_RANGE, "%s: excite acts by tracking.b_t, which must be more than 0", file);
  if (!(e->p[LOW] < e->p[HIGH] && e->p[HIGH] < 0.5 / def->setup->period))
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: device.excite.high: more than low, less than half the ticks' rate is allowed", file);
  for (int j = 0; j < 2; j++) lay(e, j);
  return ETHD_OK;
}

static ethd_status start(void *device) {
  ((excite *)device)->begin = INT64_MIN;
  return ETHD_OK;
}

/* Adds the finger to the sense, which has the joints' angles from the driver before. */
static ethd_status read_finger(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  excite *e = device;
  ethd_pose pose;
  if (e->begin == INT64_MIN) e->begin = now_ns;
  double t = 1e-9 * (double)(now_ns - e->begin);
  ethd_vec v = {e->size[0] * sines(e, 0, t) / e->damping, e->size[1] * sines(e, 1, t) / e->damping};
  ethd_arm_pose(&e->arm, out->q, &pose);
  v = ethd_pose_velocity(&pose, (const double[]){v.x, v.y});
  out->have = (out->have & ~(int64_t)ETHD_HAVE_START) | ETHD_HAVE_FINGER;
  out->finger[0] = e->p[X];
  out->finger[1] = e->p[Y];
  out->finger_v[0] = v.x;
  out->finger_v[1] = v.y;
  return ETHD_OK;
}

static ethd_limits limits(const void *device) {
  const excite *e = device;
  ethd_limits l = ethd_limits_torque(e->p[TORQUE]);
  const double box[4] = {e->p[X] - e->p[HALF], e->p[X] + e->p[HALF], e->p[Y] - e->p[HALF], e->p[Y] + e->p[HALF]};
  memcpy(l.workspace, box, sizeof box);
  return l;
}

const ethd_driver ethd_driver_excite = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "excite",
    .brief = "multisine excitation of an arm, for its identification; beside a driver that moves the arm",
    .params = params,
    .param_count = PARAMS,
    .open = open_excite,
    .start = start,
    .read = read_finger,
    .close = free,
    .limits = limits,
    .joints = ethd__no_joints,
    .prepare = open_excite /* it touches no device */};
