#include <stdbool.h>

#include "ethd/law.h"

/* Slows the effector down before the wall, so that it stands there when the finger arrives.

                      d <= reach, and the finger is near            the finger has left
     transparent or  ------------------------------------> vo  ----------------------->
     braking: v <= f(d)                                    v = +-f(|d|)    transparent again

   f(d) is the highest speed from which the device stops within the distance d (d_re): a command acts after the delay
   t_d (0 if d is that of the commanded position), then the device brakes with a = effort * acceleration:

     d = v t_d + v^2 / (2 a)    so    f(d) = a (sqrt(t_d^2 + 2 d / a) - t_d) = 2 d / (t_d + sqrt(t_d^2 + 2 d / a))

   The second form has no cancellation. Towards the wall its slope is at most 1/t_d; since a command is held for the
   period T, the delay is t_d + T. The finger is ahead of the effector by s = n.(X_f - X) = d_re - d_fr; it touches at s
   = R_r - R_f, the gap. Ahead of the finger the effector needs the lag of tracking and v t_d + v^2 / (2 a). A plate has
   more time if it is at the wall before the finger comes, and nothing of it can meet the finger elsewhere. So it waits
   there while d_fr < w. The way back to the finger lies between w and 2 w, without a jump:

     desired d_re = d_fr - lead:    0 for d_fr < w,    2 (d_fr - w) up to 2 w,    d_fr beyond

   A ring or cap keeps the finger in its centre, so that its back or rim doesn't meet the finger.

   At the wall the effector is held, because a noisy tracker would move it: in state vo its speed along n is f(d), and
   -f(-d) behind the wall. This brings it to the wall without overshoot, since the commanded position isn't late, and
   f(d) T <= d. A plate is released at d_fr = w, a ring or cap once the finger has returned by `release` of the gap.
   Along the wall it continues to follow. */

enum { EFFORT, ACCELERATION, REACH, RELEASE, RANGE, WAIT, COUNT };

static const ethd_param params[COUNT] = {
    {"effort", "1", 0.1, 1, 0.8, "share of the device's acceleration that the approach uses"},
    {"acceleration", "m/s2", 0.01, 1e4, 5, "of a device that doesn't say what it can do"},
    {"reach", "m", 1e-6, 0.01, 0.001, "distance from the wall within which the effector is held"},
    {"release", "1", -1, 1, 0.5, "share of the gap that the finger comes back before a ring or cap is released"},
    {"range", "m", 0, 10, 0.4, "distance before the wall at which the approach begins"},
    {"wait", "m", 0, 10, 0.1, "distance d_fr of a finger from the wall within which a plate waits at the wall"},
};

typedef struct approach_state {
  double held; /* 1: at the wall */
} approach_state;

_Static_assert(sizeof(approach_state) <= ETHD_STATE_MAX, "state");

/* Returns f(d), m/s. */
static double stopping_speed(double d, double a, double late) { return 2 * d / (late + sqrt(late * late + 2 * d / a)); }

static double known_or(double value, double other) { return value >= 0 ? value : other; }

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  approach_state *s = block;
  const ethd_facts *f = c->facts;
  const double able = f->acceleration >= 0 ? f->acceleration : f->force / f->mass;
  const double a = p[EFFORT] * (able < 1e6 ? known_or(able, p[ACCELERATION]) : p[ACCELERATION]);
  const double late = known_or(f->delay, 0) + c->period;
  const bool plate = f->room >= (double)INFINITY;
  const double near = plate ? p[WAIT] : -p[RELEASE] * (f->ring_radius - f->finger_radius);
  s->held = c->d_fr - c->d_re < near && (s->held != 0 || c->d_re <= p[REACH]);
  out->argument = c->d_fr;
  out->share = 1;
  if (s->held != 0) {
    out->speed = copysign(stopping_speed(fabs(c->d_re), a, late), c->d_re);
    out->state = ETHD_VO;
    return ETHD_OK;
  }
  out->speed = stopping_speed(c->d_re > 0 ? c->d_re : 0, a, late);
  out->lead = plate ? fmax(0, fmin(c->d_fr, 2 * p[WAIT] - c->d_fr)) : 0;
  out->state = c->v_f > out->speed ? ETHD_BRAKING : ETHD_TRANSPARENT;
  return ETHD_OK;
}

static double range(const double *p, double speed) ETHD_RT {
  (void)speed;
  return p[RANGE];
}

const ethd_transition_law ethd_transition_approach = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(approach_state), "approach",
            "slows down before the wall, for velocity commands: the effector stands when the finger comes", params,
            COUNT, NULL, NULL},
    .step = step,
    .range = range,
    .gains = &(const ethd_gains){NULL, NULL},
};
