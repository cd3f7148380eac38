#include <stdbool.h>

#include "law/brake_learner.h"
#include "law/offset.h"
#include "law/ring_ability.h"
#include "law/ring_observer.h"

/* Brakes before the wall, so that the ring stands still in it when the finger arrives.

                   v >= f(d)                     stood, and the finger is at the rim
                  (the curve is met)             or turns back; or t_max
     transparent -------------------> braking --------------------------------------> vo
          |                                                                            |
          |   what can't be seen in time, or is met inside:  offset's machine  <-------'  (until d_re > d_beta)
          '----------------------------------------------------------------->

   A law that reacts at the wall stops v^2/(2a) behind it. This law brakes over the same distance before the wall.
   Meanwhile the finger, which is ahead of the ring by `lag`, must not reach the rim: lag <= gap - v^2/(2a), gap = R_r -
   R_f. So it works up to the speed v* = sqrt(2 a (gap - lag)).

   The facts give the deceleration  a = effort (F + f_c) / m.
   Approach: friction is compensated, and the tracking reference moves ahead to X_f + lead n, far enough that v* exceeds
   the finger's speed. It begins at v t_d + v^2/(2a) before the wall, plus the distance that the ring needs to shift by
   the lead.
   Braking begins when the ring meets the curve of brake_curve.h. The ring's acceleration is the curve's, plus
   rate (f(d) - v), minus the disturbance w, with friction compensated. It is planned again at each tick from the
   remaining distance and the estimates of ring_observer.h. The same loop then holds the ring, so beta is 0.

   Learning: the real deceleration is k times that of the facts (brake_learner.h). */

enum { EFFORT = ETHD__OFFSET_COUNT, RATE, AIM, MARGIN, RANGE, MEMORY, LEARN, COUNT };

static const ethd_param params[COUNT] = {
    ETHD__OFFSET_PARAMS,
    {"effort", "1", 0.1, 1, 0.86, "share of the deceleration that a plan uses; the rest corrects it"},
    {"rate", "1/s", 10, 2000, 500, "rate at which the ring settles at the end, at most half a period's inverse"},
    {"aim", "m", 0, 0.005, 0.00008, "depth in the wall at which the ring is to stand"},
    {"margin", "m", 0, 0.1, 0.003, "clearance kept between finger and ring at the stop"},
    {"range", "m", 0, 0.5, 0.03, "farthest distance before the wall at which the approach begins"},
    {"memory", "1", 0, 0.99, 0.9, "share of the observer's residual that stays from tick to tick (b)"},
    {"learn", "1", 0, 1, 0, "weight of one braking in the learnt deceleration; 0: nothing is learnt"},
};

#define RIM 0.3e-3     /* m: a finger nearer than this counts as at the rim; its estimate has this error */
#define LEARN_END 5e-4 /* m: learning from a braking ends when the finger is nearer to the rim than this */
#define STRAYED 2e-3   /* m: with a larger prediction error the surface has changed, or ticks are missing */
#define SLOW 0.05      /* m/s: the approach fades in between a finger at rest and one of this speed */

typedef struct predictive_state {
  ethd__offset offset;
  ethd__ring_observer ring;
  ethd__brake_learner learner;
  bool observed, ahead, stood; /* the observer runs; the ring brakes or is held; it has stood still since then */
  double time, eps;            /* s since braking began; least depth in which it stood, m */
} predictive_state;

_Static_assert(sizeof(predictive_state) <= ETHD_STATE_MAX, "state");

static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }
static double within(double x, double low, double high) { return least(most(x, low), high); }

static ethd__ring_ability ability_of(const double *p, const ethd_contact *c) {
  double k = p[LEARN] > 0 ? ethd__brake_learnt(c->facts->memory) : 1;
  ethd__ring_ability out = ethd__ring_ability_of(c->facts, k);
  out.curve = ethd__brake_curve_of(p[EFFORT] * (out.force + out.friction) / out.mass, p[RATE], c->period);
  return out;
}

/* ---- position ---- */

static void observe(const double *p, predictive_state *s, const ethd_contact *c, const ethd__ring_ability *m) {
  double force = c->facts->applied - ethd__ring_friction(m, s->ring.v), model = force / m->mass;
  if (p[LEARN] > 0 && s->ahead)
    ethd__brake_learner_add(&s->learner, force / c->facts->mass, c->d_re, c->period, ethd__known(c->facts->delay));
  double e = ethd__ring_predict(&s->ring, model, c->d_re, c->period);
  if (s->observed && fabs(e) <= STRAYED)
    ethd__ring_correct(&s->ring, e, p[MEMORY], c->period);
  else
    s->ring = (ethd__ring_observer){c->d_re, c->v, 0};
  s->observed = true;
}

/* Returns the distance between finger and rim along n now, m. */
static double clearance(const ethd_contact *c) {
  double lag = c->d_re - c->d_fr + c->v_f * c->facts->finger_age;
  return c->facts->ring_radius - c->facts->finger_radius - lag;
}

/* Returns the distance to the depth aimed at when this tick's force begins to act, m. */
static double distance(const double *p, const predictive_state *s, const ethd_facts *f) {
  return s->ring.d + p[AIM] - s->ring.v * ethd__known(f->delay);
}

/* ---- approach, braking, its end ---- */

static bool meets_curve(const double *p, const predictive_state *s, const ethd_contact *c,
                        const ethd__ring_ability *m) {
  double v = s->ring.v, d = distance(p, s, c->facts) - v * c->period / 2;
  return v > 0 && c->v_f > 0 && v >= ethd__brake_curve_speed(&m->curve, d);
}

/* Moves the tracking reference ahead of the finger, so that the lag leaves the ring room to stop. It begins early
   enough for the ring to shift by the lead. The device could shift the ring by l within 2 sqrt(l / a); tracking, which
   does it, is assumed to need twice as long. */
static void approach(const double *p, const predictive_state *s, const ethd_contact *c, const ethd__ring_ability *m,
                     ethd_ruling *out) {
  const ethd_facts *f = c->facts;
  const double v = c->v_f, a = m->curve.a;
  out->argument = c->d_fr;
  if (!(v > 0)) return;
  double late = v * f->finger_age, gap = f->ring_radius - f->finger_radius;
  double stop = v * v / (2 * a) + v * (ethd__known(f->delay) + c->period) + p[MARGIN];
  double lag = most(least(late, gap - stop), -gap / 2), share = within(v * (1 / SLOW), 0, 1);
  if (s->ring.d > stop + v * 4 * sqrt((late - lag) / a)) return;
  out->feed = share * most(ethd__ring_friction(m, s->ring.v), 0);
  out->lead = share * (late - lag);
}

static void begin(predictive_state *s) {
  s->ahead = true;
  s->stood = false;
  s->time = 0;
  ethd__brake_learner_begin(&s->learner, s->ring.d, s->ring.v);
}

static void brake(const double *p, const predictive_state *s, const ethd_contact *c, const ethd__ring_ability *m,
                  ethd_ruling *out) {
  const ethd__brake_curve *curve = &m->curve;
  double d = distance(p, s, c->facts), v = s->ring.v, a = ethd__brake_curve_slope(curve, d, v);
  a += curve->rate * (ethd__brake_curve_speed(curve, d) - v) - s->ring.w;
  out->state = ETHD_BRAKING;
  out->beta = 0;
  out->argument = c->d_fr;
  out->feed = within(m->mass * a + ethd__ring_friction(m, v), -m->force, m->force);
}

/* Returns true when the wall takes over, at the position where the ring stood. The finger's push doesn't count. */
static bool is_over(const double *p, predictive_state *s, const ethd_contact *c, const ethd__ring_ability *m) {
  double left = clearance(c), depth = most(0, -c->d_re), gap = c->facts->ring_radius - c->facts->finger_radius;
  s->time += c->period;
  if (fabs(s->ring.v) < p[ETHD__V_TH]) {
    s->eps = s->stood ? least(s->eps, depth) : depth;
    s->stood = true;
  }
  bool behind = c->d_re - c->d_fr < RIM - gap;
  bool over = (left < RIM && s->stood) || c->v_f < -p[ETHD__V_TH] || behind || !(s->time < p[ETHD__T_MAX]);
  if (p[LEARN] > 0 && (s->stood || over || left < LEARN_END)) {
    double deeper = ethd__brake_curve_way(&m->curve, s->ring.v) - s->ring.d - p[AIM];
    ethd__brake_learner_end(&s->learner, deeper, p[LEARN], c->facts->memory);
  }
  if (!over) return false;
  ethd__offset_enter(&s->offset, ETHD_VO, s->stood ? s->eps : depth);
  s->ahead = false;
  return true;
}

/* ---- the law ---- */

/* Uses the offset law if the facts for a plan are unknown. */
static void step_blindly(const double *p, predictive_state *s, const ethd_contact *c, ethd_ruling *out) {
  if (s->ahead) ethd__offset_enter(&s->offset, c->d_re < 0 ? ETHD_BRAKING : ETHD_TRANSPARENT, 0);
  s->ahead = s->observed = false;
  ethd__offset_step(p, &s->offset, c, out);
}

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  predictive_state *s = block;
  if (!ethd__ring_is_known(c->facts)) {
    step_blindly(p, s, c, out);
    return ETHD_OK;
  }
  ethd__ring_ability m = ability_of(p, c);
  observe(p, s, c, &m);
  bool reacts = s->offset.phase != ETHD_TRANSPARENT || (s->ahead ? is_over(p, s, c, &m) : c->d_re < 0);
  if (!reacts && !s->ahead && meets_curve(p, s, c, &m)) begin(s);
  if (reacts)
    ethd__offset_step(p, &s->offset, c, out);
  else if (s->ahead)
    brake(p, s, c, &m, out);
  else
    approach(p, s, c, &m, out);
  return ETHD_OK;
}

static double range(const double *p, double speed) ETHD_RT {
  (void)speed;
  return p[RANGE];
}

static void adopt(const double *p, void *block, const ethd_past *past) ETHD_RT {
  ethd__offset_adopt(p, &((predictive_state *)block)->offset, past);
}

const ethd_transition_law ethd_transition_predictive = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(predictive_state), "predictive",
            "brakes before the wall: the ring stands when the finger comes", params, COUNT, NULL, NULL},
    .step = step,
    .range = range,
    .adopt = adopt,
    .gains = &(const ethd_gains){NULL, "b_d"},
};
