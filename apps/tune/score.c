#include "tune/score.h"

#include <math.h>
#include <string.h>

#define WINDOW 0.05 /* s before the wall over which tracking is judged */

#define NAMES(name, unit, brief) #name "_low", #name "_high",
const char *const ethd__tune_figure_names[ETHD_TUNE_FIGURE_COUNT] = {ETHD_TUNE_FIGURES(NAMES) "taps", "touched"};
#undef NAMES

const char *const ethd__tune_goal_names[ETHD_TUNE_GOALS] = {"tracking", "brake", "wall", "calm"};

/* ---- margins ---- */

static bool loop_keeps(const ethd__tune_rig *rig, const ethd_setup *setup, ethd__bounds_kind kind, double share) {
  const ethd__bounds_device device = ethd__bounds_device_of(&rig->study->plant, share);
  for (int axis = 0; axis < 2; axis++) {
    ethd__sampled_loop loop;
    if (!ethd__bounds_of(setup, &device, kind, axis, &loop)) continue;
    if (!ethd__bounds_keeps(&loop, &rig->margin)) return false;
    if (rig->passive && kind == ETHD_LOOP_WALL && ethd__sampled_passive_friction(&loop) > device.viscous) return false;
  }
  return true;
}

static bool keeps_with_hands(const ethd__tune_rig *rig, const ethd_setup *setup, ethd__bounds_kind kind) {
  for (size_t i = 0; i < rig->hands.count; i++)
    if (!loop_keeps(rig, setup, kind, rig->hands.shares[i])) return false;
  return true;
}

bool ethd__score_keeps(const ethd__tune_rig *rig, const ethd__tune_point *point) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd_setup setup;
  if (ethd__space_setup(rig->space, point, &setup, unsaid)) return false;
  for (int kind = 0; kind < ETHD_LOOP_KINDS; kind++)
    if (!keeps_with_hands(rig, &setup, (ethd__bounds_kind)kind)) return false;
  return true;
}

#define LOWERED \
  0.1 /* times the configuration's value: the lowest damping that is tried where that value doesn't keep the margin */

void ethd__score_widen(const ethd__tune_rig *rig, ethd__tune_space *space) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd_setup setup;
  const ethd__tune_point own = ethd__space_own(space);
  if (ethd__space_setup(space, &own, &setup, unsaid)) return;
  for (int kind = 0; kind < ETHD_LOOP_KINDS; kind++) {
    ethd__bounds_gains gains;
    if (keeps_with_hands(rig, &setup, (ethd__bounds_kind)kind)) continue;
    if (ethd__bounds_gains_of(&setup, (ethd__bounds_kind)kind, &gains))
      ethd__space_lower(space, gains.damping_key, LOWERED);
  }
}

/* ---- figures of a tap ---- */

/* A running mean, which leaves NaN out. */
typedef struct mean {
  double sum, n;
} mean;

static void take(mean *m, double value) {
  if (isnan(value)) return;
  m->sum += value;
  m->n++;
}

static double mean_of(const mean *m) { return m->n > 0 ? m->sum / m->n : (double)NAN; }

typedef struct tally {
  mean early, lag, eps, delta_s, d_max, v_touch, rough;
} tally;

/* Takes the squares of the lag before the wall, and of the torque's changes there and at the end, when the ring
   rests. */
static void take_squares(const ethd__tap_rows *rows, double wall, tally *t) {
  double last = rows->truth[rows->count - 1].t;
  for (size_t i = 1; i < rows->count; i++) {
    const ethd_truth *truth = &rows->truth[i];
    bool comes = truth->t > wall - WINDOW && truth->t <= wall;
    if (comes) take(&t->lag, pow(truth->finger[0] - truth->ring[0], 2) + pow(truth->finger[1] - truth->ring[1], 2));
    if (!comes && !(truth->t > last - WINDOW)) continue;
    const double *now = rows->trace[i].tau, *before = rows->trace[i - 1].tau;
    take(&t->rough, (pow(now[0] - before[0], 2) + pow(now[1] - before[1], 2)) / 2);
  }
}

/* Taps are chosen by the hand's own speed, which no gain changes. */
static void take_tap(const ethd__tap_rows *rows, const ethd__metrics *m, const ethd__speed *speed, tally *t) {
  if (!(fabs(m->v_hand - speed->centre) <= speed->band)) return;
  take(&t->early, m->reason == ETHD_TAP_EARLY_CONTACT);
  take_squares(rows, m->t_rvo, t);
  if (isnan(m->t_of) || m->reason == ETHD_TAP_EARLY_CONTACT) return;
  take(&t->eps, isnan(m->eps_felt) ? m->eps : m->eps_felt);
  take(&t->delta_s, m->delta_s);
  take(&t->d_max, m->d_max);
  take(&t->v_touch, fabs(m->v_of));
}

static void store(const tally *t, int speed, ethd__tune_score *out) {
  out->early[speed] = mean_of(&t->early);
  out->lag[speed] = sqrt(mean_of(&t->lag));
  out->eps[speed] = fabs(mean_of(&t->eps));
  out->delta_s[speed] = t->delta_s.n > 0 ? mean_of(&t->delta_s) : 0;
  out->d_max[speed] = mean_of(&t->d_max);
  out->v_touch[speed] = mean_of(&t->v_touch);
  out->rough[speed] = sqrt(mean_of(&t->rough));
  out->touched += t->v_touch.n;
}

ethd_status ethd__score_run(const ethd__tune_rig *rig, const ethd__tune_point *point, uint32_t taps,
                            ethd__tune_score *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__study study = *rig->study;
  ethd__tune_gains gains;
  ethd__stage stage;
  ethd__result result;
  *out = (ethd__tune_score){.taps = taps};
  ethd__space_gains(rig->space, point, &gains);
  study.gains = gains.gains;
  study.gain_count = rig->space->count;
  ethd_status status = ethd__stage_open(&study, rig->space->law, &stage, message);
  if (status) return status;
  for (int speed = 0; !status && speed < ETHD_TUNE_SPEEDS; speed++) {
    tally t = {0};
    for (uint32_t tap = 0; !status && tap < taps; tap++) {
      status = ethd__stage_run(&stage, &study.speeds[speed], tap, &result, message);
      if (!status) take_tap(&stage.rows, &result.metrics, &study.speeds[speed], &t);
    }
    store(&t, speed, out);
  }
  ethd__stage_close(&stage);
  return status;
}

/* ---- goals ---- */

/* Returns the mean logarithm over both speeds; `least`: a difference too small to feel. */
static double log_ratio(const double *figure, const double *reference, double least) {
  double sum = 0;
  for (int s = 0; s < ETHD_TUNE_SPEEDS; s++) sum += log((figure[s] + least) / (reference[s] + least));
  return sum / ETHD_TUNE_SPEEDS;
}

void ethd__score_goals(const ethd__tune_score *s, const ethd__tune_score *r, double out[ETHD_TUNE_GOALS]) {
  out[ETHD_TUNE_TRACKING] = (log_ratio(s->early, r->early, 0.01) + log_ratio(s->lag, r->lag, 1e-5)) / 2;
  out[ETHD_TUNE_BRAKE] = (log_ratio(s->eps, r->eps, 2e-5) + log_ratio(s->delta_s, r->delta_s, 0.5)) / 2;
  out[ETHD_TUNE_WALL] = (log_ratio(s->d_max, r->d_max, 2e-5) + log_ratio(s->v_touch, r->v_touch, 5e-3)) / 2;
  out[ETHD_TUNE_CALM] = log_ratio(s->rough, r->rough, 1e-4);
  bool known = s->touched / s->taps >= r->touched / r->taps / 4;
  for (int g = 0; g < ETHD_TUNE_GOALS; g++)
    if (!known || isnan(out[g])) out[g] = (double)INFINITY;
}
