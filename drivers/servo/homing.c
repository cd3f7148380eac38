#include "servo/homing.h"

#include <math.h>

#define SMOOTHING 0.010 /* s: time constant of the measured speed */
#define RESET 0.100     /* s: integration time of the speed's controller */
#define AWAY 0.050      /* rad that the joint first goes away from its stop */
#define STANDS 0.1      /* of the homing speed: slower counts as standing */
#define PRESSED 0.9     /* of the homing torque: more counts as pressing */
#define AWAY_FROM 10.0  /* times the homing speed: faster counts as running away */
#define STILL 0.3       /* s that it must stand and press */
#define PATIENCE 60.0   /* s for the whole search */

static void measure(const ethd__homing_def *def, ethd__homing *h, double q, double dt) {
  if (!h->begun)
    *h = (ethd__homing){.begin = q, .last = q, .begun = true, .towards = def->method == ETHD__HOMING_INDEX};
  if (dt > 0) h->v += ((q - h->last) / dt - h->v) * dt / (SMOOTHING + dt);
  h->last = q;
  h->time += dt;
  h->travel = fabs(q - h->begin);
}

/* Returns the torque that brings the joint to this speed, at most def->torque. */
static double torque_towards(const ethd__homing_def *def, ethd__homing *h, double speed, double dt) {
  double gain = def->torque / def->speed, error = speed - h->v;
  h->sum = fmin(fmax(h->sum + gain * error * dt / RESET, -def->torque), def->torque);
  return fmin(fmax(gain * error + h->sum, -def->torque), def->torque);
}

static bool stands(const ethd__homing_def *def, ethd__homing *h, double torque, double dt) {
  bool still = fabs(h->v) < STANDS * def->speed && fabs(torque) >= PRESSED * def->torque;
  h->still = still ? h->still + dt : 0;
  return h->still >= STILL;
}

static void turn_round(ethd__homing *h) {
  h->begin = h->last;
  h->sum = h->still = 0;
  h->towards = true;
}

static ethd_status fail(ethd__homing *h, const char *why) {
  h->failure = why;
  return ETHD_E_DEVICE;
}

ethd_status ethd__homing_turn(const ethd__homing_def *def, ethd__homing *h, double q, double dt, bool mark,
                              double *torque) {
  *torque = 0;
  measure(def, h, q, dt);
  if (def->method == ETHD__HOMING_INDEX && mark) return ETHD_OK;
  if (fabs(h->v) > AWAY_FROM * def->speed)
    return fail(h, "it runs away: the sign of its encoder or of its torque is wrong");
  if (h->time > PATIENCE) return fail(h, "neither stop nor mark within a minute");
  double asked = torque_towards(def, h, (h->towards ? 1 : -1) * def->direction * def->speed, dt);
  bool stood = stands(def, h, asked, dt);
  if (!h->towards && (stood || h->travel >= AWAY))
    turn_round(h);
  else if (stood && def->method == ETHD__HOMING_INDEX)
    return fail(h, "it stopped before its index mark");
  else if (stood)
    return h->travel >= AWAY / 2
               ? ETHD_OK
               : fail(h, "it doesn't move: the encoder or motor is broken, or the torque is under its friction");
  *torque = asked;
  return ETHD_STATUS_BUSY;
}
