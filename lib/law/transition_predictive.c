#include "law/offset.h"

#include <stdbool.h>

/* Brake before the wall: the ring stands in it, still, when the finger comes.

                   v >= f(d)                     stood, and the finger is at the rim
                  (the curve is met)             or turns back; or t_max
     transparent -------------------> braking --------------------------------------> vo
          |                                                                            |
          |   what can't be seen in time, or is met inside:  offset's machine  <-------'  (until d_re > d_beta)
          '----------------------------------------------------------------->

   A law that reacts at the wall needs v^2/(2a) behind it. This one needs as much before it, and that the finger,
   which is ahead of the ring by `lag`, doesn't get to the rim meanwhile:  lag <= gap - v^2/(2a), gap = R_r - R_f,
   so up to v* = sqrt(2 a (gap - lag)).

   What the ring can do:  a = effort k (F + f_c) / m, from the facts; k is 1, or learnt.

   The curve, at distance d of the place aimed at (Workman 1987, proximate time-optimal servo): speed from which it can
   still stop there, linear near the end so that the loop stays stable, C1 between them at d_l = a / rate^2:

     f(d) = rate d  (d <= d_l)      sqrt(2 a (d - d_l/2))  (d > d_l)

   Braking: acceleration f f' = -a (or -rate v), plus rate (f(d) - v), less the disturbance w, friction given back. It is
   planned anew at each tick from what is left of the way. The same loop then holds the ring, so beta is 0.

   Where the ring is (Morrison 1969, fading-memory filter of second degree): predicted by the force that was applied,
   corrected by the encoders, b = memory; so speed doesn't lag when the ring brakes, and w is what the facts don't say:

     d -= (v + w..) T,  e = d_re - d:   d += (1 - b^3) e    v -= 3/2 (1 - b^2)(1 - b) e/T    w -= (1 - b)^3 e/T^2

   Approach: friction is given back and the ring led, by X_f + shift, so far that v* is over the finger's speed.

   Learning: over each braking, ring's way = k (way of the model's force) + w_0 t^2/2; k by least squares over the last
   brakings, of weight 1 - learn each; a prior of one braking of 0.3 mm says 1. */

enum { EFFORT = ETHD__OFFSET_COUNT, RATE, AIM, MARGIN, RANGE, MEMORY, LEARN, COUNT };

static const ethd_param params[COUNT] = {
    ETHD__OFFSET_PARAMS,
    {"effort", "1", 0.1, 1, 0.86, "share of the deceleration that a plan uses; the rest corrects it"},
    {"rate", "1/s", 10, 2000, 500, "rate at which the ring settles at the end, at most half a period's inverse"},
    {"aim", "m", 0, 0.005, 0.00008, "depth in the wall at which the ring is to stand"},
    {"margin", "m", 0, 0.1, 0.003, "way that is kept between finger and rim at the stop, by leading"},
    {"range", "m", 0, 0.5, 0.015, "how far before the wall the approach begins"},
    {"memory", "1", 0, 0.99, 0.9, "of the observer: share of a residual that stays from tick to tick (b)"},
    {"learn", "1", 0, 1, 0, "weight of a braking in the learnt deceleration; 0: the facts are right"},
};

#define RIM 0.3e-3     /* m: so near is the finger at the rim: what its estimate is worth */
#define LEARN_END 5e-4 /* m: a braking is learnt from until the finger is so near */
#define PRIOR 0.3e-3   /* m: way of the braking that stands for the facts */
#define STRAYED 2e-3   /* m: the ring isn't where it was predicted: another surface, or ticks are missing */
#define APPROACH 0.035 /* s before the wall at which it begins, within `range` */
#define SLOW 0.05      /* m/s of the finger over which the approach comes in */
#define STICTION 5e-3  /* m/s over which friction changes its sign */

typedef struct predictive_state {
  ethd__offset offset;
  double started, d, v, w;                         /* the observer's: m to x_e, m/s, m/s^2 */
  double ahead, time;                              /* 1: brakes and holds; s since then */
  double stood, eps;                               /* 1: the ring has stood; in what depth, m, at least */
  double from, v_from, w_from, way, speed, learnt; /* of this braking, for k */
} predictive_state;

_Static_assert(sizeof(predictive_state) <= ETHD_STATE_MAX, "state");

static double least(double a, double b) ETHD_RT { return a < b ? a : b; }
static double most(double a, double b) ETHD_RT { return a > b ? a : b; }
static double within(double x, double low, double high) ETHD_RT { return least(most(x, low), high); }

/* ---- what the ring can do ---- */

typedef struct ability {
  double mass, force, friction, viscous;
  double a, rate, linear; /* of the plan, m/s^2, 1/s; d_l, m */
} ability;

static double gain(const double *p, const ethd_facts *f) ETHD_RT {
  return p[LEARN] > 0 ? (f->memory[0] + PRIOR * PRIOR) / (f->memory[1] + PRIOR * PRIOR) : 1;
}

static double known(double x) ETHD_RT { return x >= 0 ? x : 0; }

static ability ability_of(const double *p, const ethd_contact *c) ETHD_RT {
  const ethd_facts *f = c->facts;
  ability out = {.mass = f->mass, .force = f->force, .friction = known(f->friction), .viscous = known(f->viscous)};
  if (p[LEARN] > 0) out.mass /= gain(p, f);
  out.a = p[EFFORT] * (out.force + out.friction) / out.mass;
  out.rate = p[RATE] * c->period > 0.5 ? 0.5 / c->period : p[RATE];
  out.linear = out.a / (out.rate * out.rate);
  return out;
}

static bool sees(const ethd_facts *f) ETHD_RT {
  return f && f->mass > 0 && f->mass < (double)INFINITY && f->force > 0 && f->force < (double)INFINITY &&
         f->finger_age >= 0;
}

/* Against the motion, N. */
static double friction(const ability *m, double v) ETHD_RT {
  return m->friction * within(v * (1 / STICTION), -1, 1) + m->viscous * v;
}

/* ---- where it is ---- */

static void observe(const double *p, predictive_state *s, const ethd_contact *c, const ability *m) ETHD_RT {
  const double T = c->period, b = p[MEMORY], g = 1 - b;
  double model = (c->facts->applied - friction(m, s->v)) / m->mass, a = model + s->w;
  s->way += s->speed * T + model * T * T / 2;
  s->speed += model * T;
  s->d -= s->v * T + a * T * T / 2;
  s->v += a * T;
  double e = c->d_re - s->d;
  if (s->started == 0 || !(fabs(e) <= STRAYED)) {
    s->started = 1;
    s->d = c->d_re;
    s->v = c->v;
    s->w = 0;
    return;
  }
  double rate = e / T;
  s->d += (1 - b * b * b) * e;
  s->v -= 1.5 * (1 - b * b) * g * rate;
  s->w -= g * g * g * rate / T;
}

/* Way between finger and rim, now, along n. */
static double clearance(const ethd_contact *c) ETHD_RT {
  double lag = c->d_re - c->d_fr + c->v_f * c->facts->finger_age;
  return c->facts->ring_radius - c->facts->finger_radius - lag;
}

static double curve(const ability *m, double d) ETHD_RT {
  return d <= m->linear ? m->rate * d : sqrt(2 * m->a * (d - m->linear / 2));
}

/* To the place aimed at, when this tick's force begins to act. */
static double distance(const double *p, const predictive_state *s, const ethd_facts *f) ETHD_RT {
  return s->d + p[AIM] - s->v * known(f->delay);
}

/* ---- learning ---- */

static void learn(const double *p, predictive_state *s, const ethd_contact *c, double k) ETHD_RT {
  double *memory = c->facts->memory, x = s->way / k;
  double y = s->from - c->d_re - s->v_from * s->time - s->w_from * s->time * s->time / 2;
  s->learnt = 1;
  if (!(p[LEARN] > 0) || !(s->v < s->v_from / 2)) return;
  double num = (1 - p[LEARN]) * memory[0] + x * y, den = (1 - p[LEARN]) * memory[1] + x * x;
  double ratio = (num + PRIOR * PRIOR) / (den + PRIOR * PRIOR);
  if (!(ratio > 0.25 && ratio < 4)) return; /* no braking of this ring */
  memory[0] = num;
  memory[1] = den;
}

/* ---- the three phases before the wall ---- */

static void begin(predictive_state *s) ETHD_RT {
  s->ahead = 1;
  s->time = s->stood = s->eps = s->learnt = s->way = s->speed = 0;
  s->from = s->d;
  s->v_from = s->v;
  s->w_from = s->w;
}

static bool meets_curve(const double *p, const predictive_state *s, const ethd_contact *c, const ability *m) ETHD_RT {
  double d = distance(p, s, c->facts) - s->v * c->period / 2;
  return s->v > 0 && c->v_f > 0 && s->v >= curve(m, d);
}

/* The finger's lead over the ring is brought down, by a shift, to what leaves the ring room to stop. */
static void approach(const double *p, const predictive_state *s, const ethd_contact *c, const ability *m,
                     ethd_ruling *out) ETHD_RT {
  const ethd_facts *f = c->facts;
  double late = c->v_f * f->finger_age, gap = f->ring_radius - f->finger_radius;
  double stop = c->v_f * c->v_f / (2 * m->a) + c->v_f * (known(f->delay) + c->period) + p[MARGIN];
  double lag = most(least(late, gap - stop), -gap / 2), share = within(c->v_f * (1 / SLOW), 0, 1);
  out->argument = c->d_fr;
  out->feed = share * most(friction(m, s->v), 0);
  out->shift = ethd_vec_scale(share * (late - lag), c->n);
}

static void brake(const double *p, const predictive_state *s, const ethd_contact *c, const ability *m,
                  ethd_ruling *out) ETHD_RT {
  double d = distance(p, s, c->facts), a = d > m->linear ? -m->a : -m->rate * s->v;
  a += m->rate * (curve(m, d) - s->v) - s->w;
  out->state = ETHD_BRAKING;
  out->beta = 0;
  out->argument = c->d_fr;
  out->feed = within(m->mass * a + friction(m, s->v), -m->force, m->force);
}

/* True: the wall takes over, where the ring has stood. The finger's push doesn't count. */
static bool is_over(const double *p, predictive_state *s, const ethd_contact *c, double k) ETHD_RT {
  double left = clearance(c), depth = most(0, -c->d_re);
  int stands = fabs(s->v) < p[ETHD__V_TH];
  s->time += c->period;
  if (s->learnt == 0 && (stands || left < LEARN_END)) learn(p, s, c, k);
  if (stands) {
    s->eps = s->stood != 0 ? least(s->eps, depth) : depth;
    s->stood = 1;
  }
  int behind = c->d_re - c->d_fr < RIM - (c->facts->ring_radius - c->facts->finger_radius);
  if (!(left < RIM && s->stood != 0) && !(c->v_f < -p[ETHD__V_TH]) && !behind && s->time < p[ETHD__T_MAX]) return false;
  ethd__offset_enter(&s->offset, ETHD_VO, s->stood != 0 ? s->eps : depth);
  s->ahead = 0;
  return true;
}

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  predictive_state *s = block;
  if (!sees(c->facts)) {
    if (s->ahead != 0) ethd__offset_enter(&s->offset, c->d_re < 0 ? ETHD_BRAKING : ETHD_TRANSPARENT, 0);
    s->ahead = s->started = 0;
    ethd__offset_step(p, &s->offset, c, out);
    return ETHD_OK;
  }
  ability m = ability_of(p, c);
  observe(p, s, c, &m);
  int reacts = s->offset.phase != ETHD_TRANSPARENT || (s->ahead == 0 && c->d_re < 0);
  if (s->ahead == 0 && !reacts && meets_curve(p, s, c, &m)) {
    begin(s);
    brake(p, s, c, &m, out);
  } else if (reacts || (s->ahead != 0 && is_over(p, s, c, gain(p, c->facts)))) {
    ethd__offset_step(p, &s->offset, c, out);
  } else if (s->ahead != 0) {
    brake(p, s, c, &m, out);
  } else {
    approach(p, s, c, &m, out);
  }
  return ETHD_OK;
}

/* The approach needs some of tracking's time constants to lead the ring. */
static double range(const double *p, double speed) ETHD_RT { return least(p[RANGE], APPROACH * speed); }

static void adopt(const double *p, void *block, const ethd_past *past) ETHD_RT {
  ethd__offset_adopt(p, &((predictive_state *)block)->offset, past);
}

const ethd_transition_law ethd_transition_predictive = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(predictive_state), "predictive",
            "brakes before the wall: the ring stands when the finger comes", params, COUNT, NULL, NULL},
    .step = step,
    .range = range,
    .adopt = adopt,
};
