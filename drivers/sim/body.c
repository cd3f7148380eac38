/* Links at absolute angles th, joints at q (serial: q2 = th2 - th1), link vectors a and b with ring = a
   + b:

     I1 th1'' + H cos(th2 - th1) th2'' - H sin(th2 - th1) th2'^2 = g1 + a x F
     I2 th2'' + H cos(th2 - th1) th1'' + H sin(th2 - th1) th1'^2 = g2 + b x F

   with g of the joints' drive torques d (serial: g1 = d1 - d2), F the pad's force on the ring. Rigid:
   d = torque - friction(q'). Compliant, motors' sides at m: d = k (m - q) + c (m' - q'),
   J m'' = torque - friction(m') - d. */
#include "sim/body.h"

#include "ethd/maths.h"

#define NEAR 0.02 /* rad within which small_turn is right to the last digit */

void ethd__body_prepare(const ethd_sim_def *def, double finger_radius, ethd__body *out) {
  const ethd_plant *p = &def->plant;
  bool compliant = p->stiffness < INFINITY;
  *out = (ethd__body){.dof = compliant ? 6 : 4,
                      .serial = def->arm.mechanism == ETHD_ARM_SERIAL,
                      .compliant = compliant,
                      .link = {def->arm.link1, def->arm.link2},
                      .coupling = p->coupling,
                      .gap = def->ring_radius - finger_radius,
                      .pad_stiffness = p->pad_stiffness,
                      .pad_damping = p->pad_damping,
                      .finger_mass = p->finger_mass,
                      .hand_stiffness = p->hand_stiffness,
                      .hand_damping = p->hand_damping,
                      .at = {INFINITY, INFINITY}};
  for (int j = 0; j < 2; j++) {
    double l = out->link[j], l2 = l * l;
    out->inertia[j] = (p->mass[j] - (compliant ? p->motor_mass : 0)) * l2;
    out->motor_inertia[j] = p->motor_mass * l2;
    out->stiffness[j] = p->stiffness * l2;
    out->damping[j] = p->damping * l2;
    out->friction[j] = p->friction * l;
    out->viscous[j] = p->viscous * l2;
    out->sharpness[j] = l / ETHD__STICK;
    out->torque_max[j] = p->force_limit * l;
  }
  ethd__body_tolerate(out, def->tolerance);
}

void ethd__body_tolerate(ethd__body *body, double tolerance) {
  double order = ceil(1 - ethd_log(tolerance) / 2);
  body->tolerance = tolerance;
  body->order_max = (int)fmin(fmax(order, ETHD__ORDER_MIN), ETHD__ORDER_MAX);
}

/* ---- geometry ---- */

/* Sines and cosines of at + d from those of at, |d| <= NEAR. */
static void small_turn(ethd__two d, ethd__two *sine, ethd__two *cosine) {
  ethd__two d2 = d * d;
  ethd__two s = d * (1 - d2 * (1. / 6) * (1 - d2 * (1. / 20) * (1 - d2 * (1. / 42))));
  ethd__two c = d2 / 2 * (1 - d2 * (1. / 12) * (1 - d2 * (1. / 30))); /* 1 - cos d */
  ethd__two s0 = *sine, c0 = *cosine;
  *sine = s0 + (c0 * s - s0 * c);
  *cosine = c0 - (s0 * s + c0 * c);
}

void ethd__body_waves(const ethd__body *b, ethd__two angle, ethd__two *sine, ethd__two *cosine) {
  ethd__two d = angle - ethd__pair(b->at);
  *sine = ethd__pair(b->sine);
  *cosine = ethd__pair(b->cosine);
  if (fabs(d[0]) <= NEAR && fabs(d[1]) <= NEAR) {
    small_turn(d, sine, cosine);
    return;
  }
  double s[2], c[2];
  for (int j = 0; j < 2; j++) ethd_sincos(angle[j], &s[j], &c[j]);
  *sine = ethd__pair(s);
  *cosine = ethd__pair(c);
}

static ethd_vec turn(double w, ethd_vec a) { return (ethd_vec){-w * a.y, w * a.x}; }

typedef struct pose {
  ethd_vec a, b;
} pose;

static pose links(const ethd__body *body, const double *angle) {
  ethd__two sine, cosine, length = ethd__pair(body->link);
  ethd__body_waves(body, ethd__pair(angle), &sine, &cosine);
  ethd__two x = length * cosine, y = length * sine;
  return (pose){{x[0], y[0]}, {x[1], y[1]}};
}

static ethd_vec velocity(const pose *p, const double *w) { return ethd_vec_add(turn(w[0], p->a), turn(w[1], p->b)); }

void ethd__body_refer(ethd__body *body, const ethd__sim_state *state) {
  for (int j = 0; j < 2; j++) {
    if (fabs(state->q[ETHD__LINK + j] - body->at[j]) <= NEAR / 2) continue;
    body->at[j] = state->q[ETHD__LINK + j];
    ethd_sincos(body->at[j], &body->sine[j], &body->cosine[j]);
  }
}

void ethd__body_joints(const ethd__body *body, const double x[ETHD__DOF_MAX], double out[2]) {
  out[0] = body->compliant ? x[ETHD__MOTOR] : x[ETHD__LINK];
  out[1] = body->compliant ? x[ETHD__MOTOR + 1] : x[ETHD__LINK + 1] - (body->serial ? x[ETHD__LINK] : 0);
}

void ethd__body_place(const ethd__body *body, const double q[2], ethd__sim_state *out) {
  double *x = out->q;
  x[ETHD__LINK] = x[ETHD__MOTOR] = q[0];
  x[ETHD__LINK + 1] = body->serial ? q[0] + q[1] : q[1];
  x[ETHD__MOTOR + 1] = q[1];
}

void ethd__body_ring(const ethd__body *body, const ethd__sim_state *state, ethd_vec *x, ethd_vec *v) {
  pose p = links(body, state->q);
  *x = ethd_vec_add(p.a, p.b);
  *v = velocity(&p, state->v);
}

void ethd__body_motor(const ethd__body *body, const ethd__sim_state *state, ethd_vec *x, ethd_vec *v) {
  double q[2], w[2];
  ethd__body_joints(body, state->q, q);
  ethd__body_joints(body, state->v, w);
  if (body->serial) {
    q[1] += q[0];
    w[1] += w[0];
  }
  pose p = links(body, q);
  *x = ethd_vec_add(p.a, p.b);
  *v = velocity(&p, w);
}

/* ---- pad ---- */

typedef struct pad {
  ethd_vec r; /* from ring to finger */
  double distance, p;
} pad;

static pad pad_of(const ethd__body *body, const pose *links, const double *x) {
  ethd_vec finger = {x[ETHD__FINGER], x[ETHD__FINGER + 1]};
  pad d = {.r = ethd_vec_sub(finger, ethd_vec_add(links->a, links->b))};
  d.distance = ethd_vec_norm(d.r);
  d.p = d.distance - body->gap;
  return d;
}

/* 1 + c p_dot. */
static double damping(const ethd__body *body, const pad *d, const pose *links, const double *v) {
  ethd_vec finger = {v[ETHD__FINGER], v[ETHD__FINGER + 1]};
  ethd_vec away = ethd_vec_sub(finger, velocity(links, v));
  return 1 + body->pad_damping * (ethd_vec_dot(d->r, away) / d->distance);
}

ethd__touch ethd__body_touch(const ethd__body *body, const ethd__sim_state *state) {
  pose l = links(body, state->q);
  pad d = pad_of(body, &l, state->q);
  if (!(d.p > 0)) return ETHD__APART;
  return damping(body, &d, &l, state->v) > 0 ? ETHD__PRESSING : ETHD__LEAVING;
}

/* Returns the force on the ring. Touch, not p, chooses the branch, so that the force is smooth across the branch's
   ends. */
static ethd_vec press(const ethd__body *body, const pose *links, const double *x, const double *v) {
  pad d = pad_of(body, links, x);
  double force = body->pad_stiffness * d.p * damping(body, &d, links, v);
  return ethd_vec_scale(force / d.distance, d.r);
}

void ethd__body_pad(const ethd__body *body, const ethd__sim_state *state, double *p, double *force) {
  pose l = links(body, state->q);
  *p = pad_of(body, &l, state->q).p;
  *force = state->touch == ETHD__PRESSING ? ethd_vec_norm(press(body, &l, state->q, state->v)) : 0;
}
