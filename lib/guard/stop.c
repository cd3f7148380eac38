/* The stop: ethd/guard.h has its law, bounds and sources. */
#include "fp_mode.h"
#include "guard/parts.h"

#define STILL 0.020  /* m/s */
#define UNSEEN 0.1   /* of the speed at the start: change that may be commanded before a fall is measured */
#define PER_FALL 1.2 /* change that may be commanded for each m/s of fall */
#define NOTHING 0.01 /* of the speed at the start: a smaller change within a reaction isn't braking */
#define SPARE 1.25   /* times the time that a stop needs */
#define E 2.718281828459045

/* The triple root's gains, for a mass of 1 kg and a force that is 1 s late: with s = sqrt(2) - 2,
   K = s^2 (s + 1) e^s and B = -s (s + 2) e^s. */
#define WALL_STIFFNESS 0.07911
#define WALL_DAMPING 0.46120

/* ---- the device ---- */

static double known_or(double value, double assumed) { return value >= 0 ? value : assumed; }

ETHD__FP_APART static ethd_guard_device device_of(const ethd_arm *arm, const ethd_dynamics *dynamics, double gap,
                                                  double period, double lag) {
  ethd_guard_device d = {.link = {arm->link1, arm->link2},
                         .serial = arm->mechanism == ETHD_ARM_SERIAL,
                         .period = period,
                         .delay = known_or(dynamics->delay, gap < (double)INFINITY ? gap : ETHD_DELAY_ASSUMED),
                         .lag = lag};
  double mass[2];
  for (int i = 0; i < 2; i++) {
    mass[i] = known_or(dynamics->mass[i], ETHD_MASS_ASSUMED);
    d.inertia[i] = mass[i] * d.link[i] * d.link[i];
  }
  const double late = 2 * (d.delay + period + lag);
  d.mass = fmin(mass[0], mass[1]);
  d.stiffness = WALL_STIFFNESS * d.mass / (late * late);
  d.damping = WALL_DAMPING * d.mass / late;
  return d;
}

ethd_guard_device ethd_guard_device_of(const ethd_arm *arm, const ethd_dynamics *dynamics, double gap, double period,
                                       double lag) {
  ETHD__FP_RETURN(ethd_guard_device, device_of(arm, dynamics, gap, period, lag));
}

static double reaction(const ethd_guard_device *d, bool estimated) {
  return d->delay + d->period + (estimated ? d->lag : 0);
}

ETHD__FP_APART static double damping(const ethd_guard_device *d, double mass, bool estimated) {
  return mass / (E * reaction(d, estimated));
}

double ethd_guard_damping(const ethd_guard_device *d, double mass, bool estimated) {
  ETHD__FP_RETURN(double, damping(d, mass, estimated));
}

/* Returns a link's deceleration under full torque, m/s^2 at the ring. */
static double deceleration(const ethd_guard_device *d, const ethd_limits *limits, int i) {
  return limits->torque * d->link[i] / d->inertia[i];
}

static bool is_braked(const ethd_limits *limits) {
  return limits->speed > STILL && limits->speed < (double)INFINITY && limits->torque > 0;
}

ETHD__FP_APART static double brake_time(const ethd_guard_device *d, const ethd_limits *limits) {
  if (!is_braked(limits)) return 0;
  return limits->speed / fmin(deceleration(d, limits, 0), deceleration(d, limits, 1));
}

double ethd_guard_brake_time(const ethd_guard_device *d, const ethd_limits *limits) {
  ETHD__FP_RETURN(double, brake_time(d, limits));
}

/* Full torque brakes a link down to the speed at which the damping needs less torque; then the speed decays. */
ETHD__FP_APART static double stop_time(const ethd_guard_device *d, const ethd_limits *limits) {
  const double late = reaction(d, true), speed = limits->speed;
  double longest = 0;
  if (!is_braked(limits)) return 0;
  for (int i = 0; i < 2; i++) {
    double braking = deceleration(d, limits, i), slow = fmin(speed, braking * E * late);
    double decay = slow > STILL ? E * late * ethd_log(slow / STILL) : 0;
    longest = fmax(longest, (speed > slow ? (speed - slow) / braking : 0) + decay);
  }
  return SPARE * (2 * late + longest);
}

double ethd_guard_stop_time(const ethd_guard_device *d, const ethd_limits *limits) {
  ETHD__FP_RETURN(double, stop_time(d, limits));
}

/* ---- a tick of a stop ---- */

/* Returns the acceleration by the torques of the last tick, m/s^2 at the ring. */
static double acceleration(const ethd_guard_device *d, const double torque[2]) {
  double a = (torque[0] - d->serial * torque[1]) * d->link[0] / d->inertia[0];
  double b = torque[1] * d->link[1] / d->inertia[1];
  return sqrt(a * a + b * b);
}

double ethd__stop_allowed(ethd_guard_stop *s, const ethd__stop_motion *m) {
  if (!s->begun) {
    memset(s, 0, sizeof *s);
    s->begun = 1;
    s->start = s->highest = m->speed;
  } else {
    s->time += m->dt;
    s->given += m->given * m->dt;
  }
  if (s->time <= m->reaction - m->period) s->highest = fmax(s->highest, m->speed);
  const double left = UNSEEN * s->start + PER_FALL * (s->highest - m->speed) - s->given;
  const double nothing = NOTHING * s->start;
  s->helpless += m->dt;
  if (left > nothing || s->given > s->mark + nothing) {
    s->mark = s->given;
    s->helpless = 0;
  }
  return left;
}

bool ethd__stop_is_over(const ethd_guard_stop *s, const ethd__stop_motion *m, double most) {
  return !(m->speed >= STILL) || s->time + m->period > most * (1 + 1e-9) || s->helpless > m->reaction + m->period;
}

double ethd__stop_decay(const ethd__stop_motion *m, double left) {
  const double decay = 1 / (E * m->reaction), hold = fmax(m->dt, m->period); /* a bus may hold for several periods */
  return decay * m->speed * hold > left ? left / (m->speed * hold) : decay;
}

void ethd__guard_stop(const ethd_limits *limits, const ethd_guard_device *d, ethd_guard_state *s,
                      const ethd_guard_motion *m, double torque[2]) {
  const double rate[2] = {m->qd[0], m->qd[1] + d->serial * m->qd[0]}; /* of the links' absolute angles */
  const double a = rate[0] * d->link[0], b = rate[1] * d->link[1], speed = sqrt(a * a + b * b);
  const double most = limits->stop_time < (double)INFINITY ? limits->stop_time : ETHD_STOP_TIME;
  const ethd__stop_motion motion = {speed, s->stop.begun ? acceleration(d, s->last) : 0, reaction(d, m->estimated),
                                    d->period, m->dt};
  torque[0] = torque[1] = 0;
  const double left = ethd__stop_allowed(&s->stop, &motion);
  if (s->stopping && ethd__stop_is_over(&s->stop, &motion, most)) s->stopped = 1;
  if (s->stopped || !(left > 0)) return;
  const double decay = ethd__stop_decay(&motion, left); /* 1/s */
  torque[1] = -decay * d->inertia[1] * rate[1];
  torque[0] = -decay * d->inertia[0] * rate[0] + d->serial * torque[1];
}
