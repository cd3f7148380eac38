#include "identify/predict.h"

#include <math.h>
#include <string.h>

#include "sim/series.h"

#define FAR 1e9        /* m: pad and ring never meet */
#define FAST 1e4       /* rad/s: */
#define STEPS_MOST 300 /* of a tick: a trial of the fit that is faster, or needs more of them, isn't followed further */

void ethd__predictor_prepare(const ethd__evidence *evidence, const ethd_plant *plant, double tolerance,
                             ethd__predictor *out) {
  ethd_sim_def def = {.plant = *plant,
                      .arm = evidence->arm,
                      .ring_radius = 1,
                      .period = evidence->period,
                      .step = evidence->period,
                      .tolerance = tolerance};
  def.plant.finger_mass = 1;
  def.plant.hand_stiffness = def.plant.hand_damping = def.plant.pad_stiffness = 0;
  out->evidence = evidence;
  out->delay = plant->delay;
  ethd__body_prepare(&def, 0, &out->body);
}

int ethd__predictor_states(const ethd__predictor *p) {
  return p->body.compliant ? ETHD__STATE_MOST : ETHD__STATE_RIGID;
}

static void place(const ethd__body *b, const double *x, ethd__sim_state *out) {
  memset(out, 0, sizeof *out);
  out->clearance = FAR;
  for (int j = 0; j < 2; j++) {
    double lead = b->compliant ? x[4 + j] : 0, lead_v = b->compliant ? x[6 + j] : 0;
    int relative = j && b->serial;
    out->q[ETHD__MOTOR + j] = x[j];
    out->v[ETHD__MOTOR + j] = x[2 + j];
    out->q[ETHD__LINK + j] = x[j] + lead + (relative ? out->q[ETHD__LINK] : 0);
    out->v[ETHD__LINK + j] = x[2 + j] + lead_v + (relative ? out->v[ETHD__LINK] : 0);
  }
}

/* The torque commanded at a tick, as far as it is known, limited as the motors do. */
static void drive(ethd__predictor *p, const ethd__shot *w, int64_t tick) {
  int64_t begin = (int64_t)w->begin, end = (int64_t)w->end - 1;
  const double *torque = p->evidence->torque[tick < begin ? begin : tick > end ? end : tick];
  for (int j = 0; j < 2; j++) {
    double most = p->body.torque_max[j];
    p->body.torque[j] = fmin(fmax(torque[j], -most), most);
  }
}

/* Steps go from one change of torque to the next; the tick within is read off them. `at`: t of the tick, INFINITY: none */
static void go_on(ethd__predictor *p, const ethd__piece *still, double until, double at, ethd__leg *leg, double *out) {
  double angles[ETHD__DOF_MAX];
  for (int steps = 0; leg->end < until; steps++) {
    if (steps == STEPS_MOST || !(fabs(leg->to.v[0]) + fabs(leg->to.v[1]) < FAST)) {
      leg->end = until; /* no device does this: what is predicted stays where it was */
      return;
    }
    ethd__body_refer(&p->body, &leg->to);
    ethd__leg_next(&p->body, still, until, p->evidence->period, leg);
    if (!(at > leg->begin && at <= leg->end)) continue;
    ethd__leg_angles(&p->body, leg, at, angles);
    ethd__body_joints(&p->body, angles, out);
  }
}

void ethd__predict(ethd__predictor *p, const ethd__shot *w, const double *x, double *out) {
  const ethd__piece still = {.begin = -(double)INFINITY, .end = (double)INFINITY};
  double T = p->evidence->period, ticks = floor(p->delay / T), late = p->delay - ticks * T;
  int64_t first = (int64_t)w->first - (int64_t)ticks;
  ethd__sim_state state;
  ethd__leg leg;
  place(&p->body, x, &state);
  ethd__leg_begin(&still, 0, &state, &leg);
  out[0] = x[0];
  out[1] = x[1];
  drive(p, w, first - 1);
  go_on(p, &still, late, (double)INFINITY, &leg, NULL);
  for (int k = 1; k < w->count; k++) {
    drive(p, w, first + k - 1);
    go_on(p, &still, k * T + late, k * T, &leg, out + 2 * k);
  }
}
