/* The plant alone: run time against error, beside libraries that integrate systems of equations. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/bench.h"
#include "bench/problem.h"
#include "cli/cli.h"
#include "ethd/maths.h"

enum { CONTENDERS_MAX = 120, TAPS = 4, N = ETHD__ODE_SIZE, HALF = N / 2 };

#define TRUEST 1e-14 /* tolerance of the reference, GSL's rk8pd */

/* The plant as a system of first order: y = 4 coordinates, 4 speeds. */
typedef struct plain {
  const ethd__body *body;
  const ethd__piece *piece;
  ethd__touch touch;
  bool live; /* 1: touch is worked out at every evaluation, and no events are watched */
} plain;

typedef struct integrator {
  const char *name;
  const ethd__problem *problem;
  ethd__mark *marks;
  bool fixed;                  /* 1: ours with steps of order 4 */
  double setting, error, time; /* s per simulated s */
  const ethd__peer_ode *peer;  /* NULL: ours */
  void *peer_self;
  plain plain;
  ethd__ode ode;
} integrator;

static struct {
  integrator all[CONTENDERS_MAX];
  int count;
} field;

/* ---- the plant, as others integrate it ---- */

static void unpack(const double *y, ethd__touch touch, ethd__sim_state *s) {
  memcpy(s->q, y, HALF * sizeof *y);
  memcpy(s->v, y + HALF, HALF * sizeof *y);
  s->touch = touch;
}

static void pack(const ethd__sim_state *s, double *y) {
  memcpy(y, s->q, HALF * sizeof *y);
  memcpy(y + HALF, s->v, HALF * sizeof *y);
}

/* Returns the pad's depth; fills the vector from ring to finger and 1 + c p'. */
static double pad(const plain *p, const double *y, ethd_vec *r, double *damping) {
  ethd__sim_state s;
  ethd_vec x, v;
  unpack(y, p->touch, &s);
  ethd__body_ring(p->body, &s, &x, &v);
  *r = (ethd_vec){y[2] - x.x, y[3] - x.y};
  const double distance = ethd_vec_norm(*r);
  *damping = 1 + p->body->pad_damping * ethd_vec_dot(*r, (ethd_vec){y[6] - v.x, y[7] - v.y}) / distance;
  return distance - p->body->gap;
}

/* Plant n: two rigid links without coupling, each of which its motor moves. */
static void rate(void *self, double t, const double *y, double *out) {
  plain *p = self;
  const ethd__body *b = p->body;
  ethd__sim_motion hand = ethd__piece_at(p->piece, t);
  ethd_vec f = {b->hand_stiffness * (hand.x.x - y[2]) + b->hand_damping * (hand.v.x - y[6]),
                b->hand_stiffness * (hand.x.y - y[3]) + b->hand_damping * (hand.v.y - y[7])};
  double g[2], damping;
  if (p->live) {
    ethd__sim_state s;
    unpack(y, ETHD__APART, &s);
    p->touch = ethd__body_touch(b, &s);
  }
  for (int i = 0; i < 2; i++)
    g[i] = b->torque[i] - b->friction[i] * ethd_tanh(b->sharpness[i] * y[4 + i]) - b->viscous[i] * y[4 + i];
  if (p->touch == ETHD__PRESSING) {
    ethd__two sine, cosine;
    ethd_vec r;
    const double force = b->pad_stiffness * pad(p, y, &r, &damping) * damping;
    const ethd_vec push = ethd_vec_scale(force / ethd_vec_norm(r), r);
    ethd__body_waves(b, (ethd__two){y[0], y[1]}, &sine, &cosine);
    f = ethd_vec_sub(f, push);
    for (int i = 0; i < 2; i++) g[i] += b->link[i] * (cosine[i] * push.y - sine[i] * push.x);
  }
  memcpy(out, y + HALF, HALF * sizeof *y);
  for (int i = 0; i < 2; i++) out[4 + i] = g[i] / b->inertia[i];
  out[6] = hand.a.x + f.x / b->finger_mass;
  out[7] = hand.a.y + f.y / b->finger_mass;
}

/* Apart: -p; touching: p and 1 + c p', or the latter's opposite while the pad leaves. */
static void watch(void *self, double t, const double *y, double out[2]) {
  const plain *p = self;
  ethd_vec r;
  double damping;
  const double depth = pad(p, y, &r, &damping);
  (void)t;
  out[0] = depth;
  out[1] = 1;
  if (p->touch == ETHD__APART)
    out[0] = -depth;
  else
    out[1] = damping;
  if (p->touch == ETHD__LEAVING) out[1] = -out[1];
}

static void change(void *self, int i) {
  plain *p = self;
  if (i == 0)
    p->touch = p->touch == ETHD__APART ? ETHD__PRESSING : ETHD__APART;
  else
    p->touch = p->touch == ETHD__PRESSING ? ETHD__LEAVING : ETHD__PRESSING;
}

static void theirs(void *user, ethd__body *body, const ethd__stretch *s, ethd__sim_state *state) {
  integrator *c = user;
  double y[N];
  c->plain.body = body;
  c->plain.piece = &s->piece;
  c->plain.touch = state->touch;
  pack(state, y);
  c->peer->work(c->peer_self, s->begin, s->end, y);
  unpack(y, c->plain.touch, state);
}

/* ---- ours ---- */

/* Is called once a tap, because each tap has a body of its own. */
static void tolerate(ethd__body *body, double tolerance) {
  if (body->tolerance != tolerance) ethd__body_tolerate(body, tolerance);
}

static void ours(void *user, ethd__body *body, const ethd__stretch *s, ethd__sim_state *state) {
  const integrator *c = user;
  tolerate(body, c->setting);
  ethd__body_advance(body, &s->piece, s->begin, s->end - s->begin, state);
}

/* Takes steps of order 4 and equal length, which is the setting. */
static void ours_fixed(void *user, ethd__body *body, const ethd__stretch *s, ethd__sim_state *state) {
  const integrator *c = user;
  double length = s->end - s->begin;
  int n = (int)ceil(length / c->setting - 1e-9);
  tolerate(body, INFINITY);
  for (int i = 0; i < n; i++) ethd__body_advance(body, &s->piece, s->begin + length * i / n, length / n, state);
}

static void play(integrator *c) {
  ethd__problem_play(c->problem, c->peer ? theirs : c->fixed ? ours_fixed : ours, c, c->marks);
}

static integrator *enter(const ethd__problem *problem, const char *name, double setting) {
  if (field.count == CONTENDERS_MAX) ethd__fail(ETHD_EXIT_FAILED, "no room for more contenders");
  integrator *c = &field.all[field.count++];
  *c = (integrator){.name = name, .problem = problem, .setting = setting};
  c->marks = calloc((size_t)problem->mark_count, sizeof *c->marks);
  if (!c->marks) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  return c;
}

static void enter_peer(const ethd__problem *problem, const ethd__peer_ode *peer, double tolerance) {
  integrator *c = enter(problem, peer->name, tolerance);
  c->peer = peer;
  c->plain.live = peer->live;
  c->ode = (ethd__ode){&c->plain, rate, watch, change};
  c->peer_self = peer->create(&c->ode, tolerance);
}

static void enter_all(const ethd__problem *problem) {
  static const double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) enter(problem, "libethd", tolerances[i]);
  for (double h = 200e-6; h > 10e-6; h /= 2) enter(problem, "libethd with fixed steps", h)->fixed = 1;
  static const char *const libraries[] = {"gsl", "sundials", "mujoco"};
  for (int l = 0; l < 3; l++) {
    const ethd__peer_ode *peer = bench_peer(libraries[l], "peer_ode");
    for (; peer && peer->name; peer++)
      for (double t = peer->loosest; t > 0.7 * peer->tightest; t /= peer->ratio) enter_peer(problem, peer, t);
  }
}

/* ---- time at an error: between points of a curve, on logarithmic axes ---- */

static double time_at(const char *name, double error) {
  double best = INFINITY;
  for (int i = 0; i < field.count; i++) {
    const integrator *a = &field.all[i], *b = a + 1;
    if (!strstr(a->name, name)) continue;
    if (a->error <= error) best = fmin(best, a->time);
    if (b == field.all + field.count || strcmp(a->name, b->name) != 0) continue;
    if (!(a->error > error && b->error < error)) continue;
    double share = log(a->error / error) / log(a->error / b->error);
    best = fmin(best, exp(log(a->time) + share * log(b->time / a->time)));
  }
  return best;
}

static void goal(const char *peer, const char *spoken, double error, double times) {
  double ratio = time_at(peer, error) / time_at("libethd", error);
  if (!isfinite(ratio))
    printf("  goal: %s at %.0e m takes %.1f times as long: no such point\n", spoken, error, times);
  else
    printf("  goal: %s at %.0e m takes %.1f times as long: %.1f, %s\n", spoken, error, times, ratio,
           bench_verdict(ratio >= times));
}

/* Reports what halving a fixed step gains, as the mean of halvings. Single ones scatter, because a contact changes or
   friction turns at another place in its step after each. */
static void order(void) {
  double gain = 0, least = INFINITY, most = 0;
  int halvings = 0;
  for (int i = 1; i < field.count; i++)
    if (field.all[i].fixed && field.all[i - 1].fixed && field.all[i].error > 1e-12) {
      double times = field.all[i - 1].error / field.all[i].error;
      gain += log(times);
      least = fmin(least, times);
      most = fmax(most, times);
      halvings++;
    }
  gain = exp(gain / halvings);
  printf("  goal: halving the step cuts the error 14 times through contacts: %.1f (single ones %.1f to %.1f), %s\n",
         gain, least, most, bench_verdict(gain >= 14));
}

/* ---- all ---- */

static double cpu(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Contenders run in turns; the fastest round counts, in CPU time. */
static void race(int rounds) {
  for (int i = 0; i < field.count; i++) field.all[i].time = INFINITY;
  for (int r = 0; r < rounds; r++)
    for (int i = 0; i < field.count; i++) {
      integrator *c = &field.all[i];
      double start = cpu();
      play(c);
      c->time = fmin(c->time, (cpu() - start) / c->problem->duration);
    }
}

static void leave(integrator *c) {
  if (c->peer) c->peer->destroy(c->peer_self);
  free(c->marks);
}

static void write_all(const char *folder, ethd__mark *truth, const ethd__problem *problem) {
  FILE *csv = bench_csv(folder, "plant",
                        "# plant n alone, torques of taps recorded in closed loop; error: largest distance of ring\n"
                        "# or finger from GSL's rk8pd with events at 1e-14; CPU time per simulated second\n",
                        BENCH_RACE);
  for (int i = 0; i < field.count; i++) {
    integrator *c = &field.all[i];
    c->error = ethd__problem_error(problem, c->marks, truth);
    printf("  %-26s %8.1e  %9.2e m %10.1f us/s\n", c->name, c->setting, c->error, 1e6 * c->time);
    bench_row(csv, "ring or finger: error in m over a simulated second", c->name, 1e9 * c->time, c->error);
  }
}

static void run(const char *folder, int quick) {
  const ethd__peer_ode *gsl = bench_peer("gsl", "peer_ode");
  if (!gsl) {
    printf("plant: SKIP: without GSL (Debian: libgsl-dev) there is no reference\n");
    return;
  }
  ethd__problem problem = ethd__problem_record(TAPS);
  printf(
      "plant: plant n alone, %d taps of %.1f s in all, torques recorded in closed loop; error: the largest distance\n"
      "of ring or finger, every tick and torque change, from GSL's rk8pd with events at %g\n"
      "exact matrix exponential: left out, friction's tanh and the pad's K p (1 + c p') are not linear\n"
      "MuJoCo: the same forces through its passive callback, steps of fixed length, no events\n",
      TAPS, problem.duration, TRUEST);
  enter_peer(&problem, &gsl[1], TRUEST);
  play(&field.all[0]);
  ethd__mark *truth = field.all[0].marks;
  field.all[0].marks = NULL;
  leave(&field.all[0]);
  field.count = 0;
  enter_all(&problem);
  race(quick ? 8 : 60);
  write_all(folder, truth, &problem);
  goal("rkf45", "GSL rkf45", 1e-6, 2);
  goal("rkf45", "GSL rkf45", 1e-7, 1.3);
  goal("rkf45", "GSL rkf45", 1e-8, 1.3);
  goal("rkf45", "GSL rkf45", 1e-10, 1);
  goal("CVODE", "CVODE", 1e-6, 30);
  goal("CVODE", "CVODE", 1e-8, 30);
  goal("MuJoCo", "MuJoCo", 1e-6, 25);
  order();
  for (int i = 0; i < field.count; i++) leave(&field.all[i]);
  free(truth);
  ethd__problem_free(&problem);
  bench_close();
}

const bench bench_plant = {"plant", run};
