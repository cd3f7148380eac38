/* A point's margins, tried in time on the whole device. */
#include <math.h>
#include <string.h>

#include "tune/score.h"

#define TAPS 3 /* taps at each speed under each disturbance */
#define PRESS \
  300 /* ticks for which the finger goes on pressing after the tap: a bounce dies out in them, a limit cycle doesn't */
#define REST 40 /* ticks at the end during which the ring must be at rest */
#define SWING \
  0.01 /* m/s, rms about a line; a limit cycle between torque limits is faster: 5 N on 0.15 kg at 100 Hz make 0.038 */

/* Sums over one number a tick, from which the rms about the least-squares line follows. */
typedef struct line_fit {
  double n, t, tt, v, tv, vv;
} line_fit;

static void add(line_fit *l, double t, double v) {
  l->n++, l->t += t, l->tt += t * t, l->v += v, l->tv += t * v, l->vv += v * v;
}

static double left_over(const line_fit *l) {
  double t = l->t / l->n, v = l->v / l->n, tt = l->tt / l->n - t * t, slope = (l->tv / l->n - t * v) / tt;
  return sqrt(fmax(0, l->vv / l->n - v * v - slope * slope * tt));
}

/* Continues the last tap. With an elastic transmission the motor's side oscillates first, and most. INFINITY: the
   controller stopped. */
static double swing_of(ethd__stage *stage) {
  line_fit line = {0};
  ethd_sense sense;
  ethd_command command;
  ethd_trace trace;
  ethd_truth truth;
  for (int k = 0; k < PRESS; k++) {
    sense = (ethd_sense){0};
    ethd_sim_read(stage->sim, &sense);
    if (ethd_control_step(stage->control, &sense, &command, &trace) < 0 || trace.fault) return (double)INFINITY;
    ethd_sim_truth(stage->sim, &truth);
    if (k >= PRESS - REST) add(&line, k, truth.motor_v[0]);
    ethd_sim_write(stage->sim, &command);
  }
  return left_over(&line);
}

/* Residual speed of the ring long after each tap. */
typedef struct unrest {
  double swing[ETHD_TUNE_SPEEDS][TAPS];
} unrest;

static ethd_status measure(const ethd__tune_rig *rig, const ethd__tune_point *point, const ethd_plant *plant,
                           unrest *out, char *message) {
  ethd__study study = *rig->study;
  ethd__tune_gains gains;
  ethd__stage stage;
  ethd__result result;
  ethd__space_gains(rig->space, point, &gains);
  study.plant = *plant;
  study.gains = gains.gains;
  study.gain_count = rig->space->count;
  ethd_status status = ethd__stage_open(&study, rig->space->law, &stage, message);
  if (status) return status;
  for (int speed = 0; !status && speed < ETHD_TUNE_SPEEDS; speed++)
    for (uint32_t tap = 0; !status && tap < TAPS; tap++) {
      status = ethd__stage_run(&stage, &study.speeds[speed], tap, &result, message);
      if (status) break;
      bool fault = result.metrics.reason == ETHD_TAP_FAULT;
      out->swing[speed][tap] = fault ? (double)INFINITY : swing_of(&stage);
    }
  ethd__stage_close(&stage);
  return status;
}

/* The device itself may move: twice its speed under the configuration's own gains is allowed, if those keep the
   margins. */
static bool rests(const unrest *u, const unrest *own, double *worst) {
  bool good = true;
  *worst = 0;
  for (int speed = 0; speed < ETHD_TUNE_SPEEDS; speed++)
    for (int tap = 0; tap < TAPS; tap++) {
      *worst = fmax(*worst, u->swing[speed][tap]);
      good &= u->swing[speed][tap] <= fmax(SWING, 2 * own->swing[speed][tap]);
    }
  return good;
}

static bool is_gain(const ethd__tune_key *key) {
  return !strncmp(key->name, "tracking.", 9) || !strncmp(key->name, "contact.", 8) ||
         !strncmp(key->name, "transition.", 11);
}

/* Returns the point with all gains of one section `times` as large. */
static ethd__tune_point raised(const ethd__tune_space *space, const ethd__tune_point *point, const char *section,
                               double times) {
  ethd__tune_point p = *point;
  for (size_t k = 0; k < space->count; k++)
    if (is_gain(&space->keys[k]) && !strncmp(space->keys[k].name, section, strlen(section))) p.value[k] *= times;
  return p;
}

static ethd_plant with_hand(const ethd_plant *plant, double share) {
  ethd_plant p = *plant;
  p.finger_mass *= share;
  p.hand_stiffness *= share;
  p.hand_damping *= share;
  return p;
}

/* A disturbance under which a point must be stable with every hand: higher gains of a section, or later torques. */
typedef struct unsettling {
  const char *what;
  const char *section; /* NULL: the gains stay as they are */
  bool late;
} unsettling;

static const unsettling unsettlings[] = {{"the tracking gains", "tracking.", false},
                                         {"the wall's gains", "contact.", false},
                                         {"the brake's gains", "transition.", false},
                                         {"the delay", NULL, true}};

static ethd_status try_one(const ethd__tune_rig *rig, const ethd__tune_point *point, const ethd_plant *hand,
                           const unsettling *how, unrest *out, char *message) {
  ethd_plant plant = *hand;
  if (how->late) plant.delay += rig->margin.delay;
  const ethd__tune_point p = how->section ? raised(rig->space, point, how->section, rig->margin.gain) : *point;
  return measure(rig, &p, &plant, out, message);
}

static ethd_status try_hand(const ethd__tune_rig *rig, const ethd__tune_point *point, double share,
                            ethd__tune_verdict *out, char *message) {
  const ethd__tune_point nominal = ethd__space_own(rig->space);
  const ethd_plant hand = with_hand(&rig->study->plant, share);
  unrest own = {{{0}}}, u;
  ethd_status status = ethd__score_keeps(rig, &nominal) ? measure(rig, &nominal, &hand, &own, message) : ETHD_OK;
  for (size_t i = 0; !status && out->settles && i < sizeof unsettlings / sizeof *unsettlings; i++) {
    status = try_one(rig, point, &hand, &unsettlings[i], &u, message);
    if (!status) *out = (ethd__tune_verdict){.settles = true, .what = unsettlings[i].what, .hand = share};
    if (!status) out->settles = rests(&u, &own, &out->swing);
  }
  return status;
}

ethd_status ethd__score_confirm(const ethd__tune_rig *rig, const ethd__tune_point *point, ethd__tune_verdict *out,
                                char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  *out = (ethd__tune_verdict){.settles = true};
  for (size_t h = 0; !status && out->settles && h < rig->hands.count; h++)
    if (rig->hands.shares[h] > 0) status = try_hand(rig, point, rig->hands.shares[h], out, message);
  return status;
}
