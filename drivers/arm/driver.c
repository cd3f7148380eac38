#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "arm/simulated.h"
#include "ethd/driver.h"
#include "text/error_text.h"
#include "text/text.h"

#define CATCH_UP_MAX 1000 /* periods: after a longer gap simulated time stays behind */

enum { HAND, RATE, LATENCY, NOISE, BIAS, SEED, X, Y, Z, NX, NY, NZ, BEFORE, BEYOND, SPEED, BEGIN, PARAMS };

static const ethd_param params[PARAMS] = {
    [HAND] = {"hand", "none|reach", 0, 1, 0, "none: another driver sees the hand; reach: one reach, of minimum jerk"},
    [RATE] = {"hand_rate", "Hz", 1, 1000, 72, "rate of the headset's readings of it"},
    [LATENCY] = {"hand_latency", "s", 0, 1, 0.03, "time from a reading's instant to its arrival"},
    [NOISE] = {"hand_noise", "m", 0, 0.05, 1e-3, "sd of a reading, each axis"},
    [BIAS] = {"hand_bias", "m", -0.1, 0.1, 0, "error of the readings along the direction of the reach"},
    [SEED] = {"hand_seed", ETHD_WHOLE, 0, 0x1p53, 1, "key of the noise"},
    [X] = {"hand_x", "m", -100, 100, 0, "position of the finger's centre at the wall"},
    [Y] = {"hand_y", "m", -100, 100, 0, "y of that position"},
    [Z] = {"hand_z", "m", -100, 100, 0, "z of that position"},
    [NX] = {"hand_nx", "1", -1, 1, 1, "direction of the reach, of any length above 0.001"},
    [NY] = {"hand_ny", "1", -1, 1, 0, "y of that direction"},
    [NZ] = {"hand_nz", "1", -1, 1, 0, "z of that direction"},
    [BEFORE] = {"hand_before", "m", 0, 2, 0.2, "length of the reach before that position"},
    [BEYOND] = {"hand_beyond", "m", 0, 2, 0.08, "length of the reach behind it"},
    [SPEED] = {"hand_speed", "m/s", 1e-3, 10, 0.5, "greatest speed of the reach"},
    [BEGIN] = {"hand_begin", "s", 0, 1e3, 2.5, "time from the start to the beginning of the reach"},
};

static const char *const keys[] = {"table", NULL};

typedef struct arm_device {
  ethd__arm_sim sim;    /* first: tests read the arm's true state */
  _Atomic int32_t safe; /* any thread sets it */
  bool written;         /* `held` and `due_ns` are known */
  int64_t due_ns;       /* the tick at which the next read is expected */
  ethd_space_command held;
  int64_t limited; /* periods in which a joint's limit bound the command */
} arm_device;

static ethd_status load(const ethd_device_def *def, const ethd_setting *setting, arm_device *d, char *message) {
  if (!setting)
    return ethd__say(message, ETHD_E_UNKNOWN, "%s: device arm.table is missing: the file of an arm, such as ur5e.arm",
                     def->file ? def->file : "configuration");
  char *path = ethd__path_join(def->folder, setting->value);
  ethd_status status = path ? ethd__arm_table_load(path, path, &d->sim.table, message) : ETHD_E_MEMORY;
  free(path);
  return status;
}

/* Refuses a controller that doesn't fit the arm. */
static ethd_status check(const ethd_device_def *def, const arm_device *d, char *message) {
  const char *file = def->file ? def->file : "setup";
  const double rate = d->sim.table.servo.rate;
  if (def->space->kind != ETHD_SPACE_VELOCITY)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: found a controller of forces, driver arm takes velocities", file);
  if (fabs(def->space->period * rate - 1) <= 1e-9) return ETHD_OK;
  return ethd__say(message, ETHD_E_RANGE, "%s: found a period of %.10g s, the arm's table allows %.10g s (%.10g Hz)",
                   file, def->space->period, 1 / rate, rate);
}

static ethd_status put_hand(const ethd_device_def *def, const double p[PARAMS], arm_device *d, char *message) {
  const ethd_vec3 n = {p[NX], p[NY], p[NZ]};
  if (!(ethd_vec3_norm(n) > 1e-3))
    return ethd__say(message, ETHD_E_RANGE, "%s: device arm.hand_nx, _ny, _nz: found 0, a direction is allowed",
                     def->file ? def->file : "configuration");
  d->sim.finger = ethd__arm_finger_at((ethd_vec3){p[X], p[Y], p[Z]}, n);
  d->sim.finger.path =
      (ethd_path){.from = {p[BEFORE], 0}, .to_x = -p[BEYOND], .speed = p[SPEED], .profile = ETHD_PROFILE_MINIMUM_JERK};
  d->sim.finger.begin = p[BEGIN];
  d->sim.finger.rate = p[HAND] > 0 ? p[RATE] : 0;
  d->sim.finger.latency = p[LATENCY];
  d->sim.finger.noise = p[NOISE];
  d->sim.finger.bias = p[BIAS];
  d->sim.finger.seed = (uint64_t)p[SEED];
  return ETHD_OK;
}

static ethd_status open_arm(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  double p[PARAMS];
  const ethd_setting *texts[1] = {NULL};
  *out = NULL;
  ethd_params_default(params, PARAMS, p);
  ethd_status status = ethd_settings_read(&ethd_driver_arm, def, p, texts, message);
  if (status) return status;
  arm_device *d = *out = calloc(1, sizeof *d);
  if (!d) return ETHD_E_MEMORY;
  status = load(def, texts[0], d, message);
  if (!status) status = check(def, d, message);
  if (!status) status = put_hand(def, p, d, message);
  if (!status) ethd__arm_sim_start(&d->sim);
  return status;
}

static ethd_status start(void *device_) {
  arm_device *d = device_;
  d->safe = 0;
  d->written = false;
  d->limited = 0;
  ethd__arm_sim_start(&d->sim);
  return ETHD_OK;
}

static int64_t period_ns(const arm_device *d) { return (int64_t)rint(1e9 * d->sim.table.limits.period); }

static void pass(arm_device *d) {
  if (d->safe) d->held.safe = 1;
  ethd__arm_sim_write(&d->sim, &d->held);
  d->limited += d->sim.ruling.share < 1 || d->sim.ruling.turned;
}

static ethd_status read_arm(void *device_, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  arm_device *d = device_;
  for (int i = 0; d->written && i < CATCH_UP_MAX && now_ns - d->due_ns >= period_ns(d); i++) {
    pass(d); /* the periods that the loop missed, under its last command */
    d->due_ns += period_ns(d);
  }
  const int64_t before = out->have;
  ethd__arm_sim_read(&d->sim, out);
  if (out->have & ~before & ETHD_SPACE_HAVE_READING) out->sample_ns += now_ns - out->time_ns;
  out->time_ns = now_ns;
  if (!d->written) return ETHD_OK;
  ethd_vec3_put(d->sim.motion.v, out->commanded);
  out->have |= ETHD_SPACE_HAVE_COMMANDED;
  return ETHD_OK;
}

static ethd_status write_arm(void *device_, int64_t now_ns, const ethd_space_command *command) ETHD_RT {
  arm_device *d = device_;
  d->held = *command;
  d->written = true;
  d->due_ns = now_ns + period_ns(d);
  pass(d);
  return ETHD_OK;
}

static void safe(void *device_) ETHD_RT { ((arm_device *)device_)->safe = 1; }

static ethd_ability able(const void *device_, const double n[3]) ETHD_RT {
  return ethd__arm_motion_able(&((const arm_device *)device_)->sim.motion, ethd_vec3_of(n));
}

static uint32_t figures(const void *device_, ethd_figure *out, uint32_t max) {
  const arm_device *d = device_;
  const ethd__arm_sim *s = &d->sim;
  double margin = INFINITY;
  for (uint32_t i = 0; i < s->table.limits.count; i++) {
    const ethd_joint_limit *j = &s->table.limits.joint[i];
    margin = fmin(margin, fmin(s->motion.q[i] - j->least, j->most - s->motion.q[i]));
  }
  const ethd_figure all[] = {
      {"periods limited by a joint", "1", (double)d->limited},
      {"nearest end of a joint's travel", "rad", margin},
      {"delay from command to motion", "s", ethd__arm_motion_able(&s->motion, (ethd_vec3){1, 0, 0}).delay}};
  uint32_t count = 0;
  for (; count < 3 && count < max; count++) out[count] = all[count];
  return count;
}

static const char *remark(const void *device_, uint32_t i) {
  const char *safe_is = ((const arm_device *)device_)->sim.table.safe == ETHD__ARM_BRAKES
                            ? "its safe state is closed brakes: it stops at once and doesn't move until the next start"
                            : "its safe state is zero speed: it stops within its joints' accelerations and holds";
  const char *const all[] = {"simulated: joints follow with a second-order lag, and the plate doesn't stop a hand",
                             safe_is};
  return i < 2 ? all[i] : NULL;
}

const ethd_driver ethd_driver_arm = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "arm",
    .brief = "simulated arm of 2 to 7 joints in space, described by a table",
    .params = params,
    .param_count = PARAMS,
    .keys = keys,
    .open = open_arm,
    .start = start,
    .safe = safe,
    .close = free,
    .figures = figures,
    .remark = remark,
    .prepare = open_arm, /* it touches no device */
    .read_space = read_arm,
    .write_space = write_arm,
    .able = able,
    .safe_is = ETHD_SAFE_NO_SPEED,
};
