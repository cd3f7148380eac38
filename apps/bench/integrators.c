/* The plant alone: run time against error, for every method that integrates it. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/bench.h"
#include "bench/methods.h"
#include "cli/cli.h"

enum { CONTENDERS_MAX = 120, TAPS = 4 };

typedef struct integrator {
  const char *name;
  const ethd__problem *problem;
  ethd__mark *marks;
  bool fixed;                  /* 1: ours with steps of order 4 */
  double setting, error, time; /* s per simulated s */
  ethd__runner runner;         /* ours: without a method */
} integrator;

static struct {
  integrator all[CONTENDERS_MAX];
  int count;
} field;

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

static void play(void *user) {
  integrator *c = user;
  c->runner.h = 1e-4;
  if (c->runner.method || c->runner.peer)
    ethd__problem_play(c->problem, ethd__runner_stretch, &c->runner, c->marks);
  else
    ethd__problem_play(c->problem, c->fixed ? ours_fixed : ours, c, c->marks);
}

static integrator *enter(const ethd__problem *problem, const char *name, double setting) {
  if (field.count == CONTENDERS_MAX) ethd__fail(ETHD_EXIT_FAILED, "no room for more contenders");
  integrator *c = &field.all[field.count++];
  *c = (integrator){.name = name, .problem = problem, .setting = setting};
  c->marks = calloc((size_t)problem->mark_count, sizeof *c->marks);
  if (!c->marks) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  c->runner.setting = setting;
  c->runner.ode = ethd__plain_ode(&c->runner.plain);
  return c;
}

static void enter_all(const ethd__problem *problem) {
  static const double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) enter(problem, "libethd", tolerances[i]);
  for (double h = 200e-6; h > 10e-6; h /= 2) enter(problem, "libethd with fixed steps", h)->fixed = 1;
  for (int m = 0; m < ethd__method_count; m++)
    for (int i = 0; i < 8 && ethd__methods[m].settings[i] > 0; i++) {
      integrator *c = enter(problem, ethd__methods[m].name, ethd__methods[m].settings[i]);
      c->runner.method = &ethd__methods[m];
      c->runner.plain.live = !ethd__methods[m].events;
    }
  static const char *const libraries[] = {"gsl", "sundials", "odeint", "mujoco"};
  for (int l = 0; l < 4; l++) {
    const ethd__peer_ode *peer = ethd__bench_peer(libraries[l], "peer_ode");
    for (; peer && peer->name; peer++)
      for (double t = peer->loosest; t > 0.7 * peer->tightest; t /= peer->ratio) {
        integrator *c = enter(problem, peer->name, t);
        c->runner.peer = peer;
        c->runner.plain.live = peer->live;
        c->runner.peer_self = peer->create(&c->runner.ode, t);
      }
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
           ethd__bench_verdict(ratio >= times));
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
         gain, least, most, ethd__bench_verdict(gain >= 14));
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

static int run(const char *folder, int quick) {
  ethd__problem problem = ethd__problem_record(TAPS);
  field.count = 0;
  printf("integrators: plant n alone, %d taps of %.1f s in all, torques recorded in closed loop; error: "
         "the\n"
         "largest distance of ring or finger, every tick and torque change, from DOPRI5 with events at "
         "1e-15\n"
         "exact matrix exponential: left out, friction's tanh and the pad's K p (1 + c p') are not linear\n"
         "MuJoCo: the same forces through its passive callback, steps of fixed length, no events\n",
         TAPS, problem.duration);
  integrator *reference = enter(&problem, "reference", 1e-15);
  reference->runner.method = &ethd__methods[ethd__method_count - 1];
  reference->runner.setting = 1e-15;
  play(reference);
  ethd__mark *truth = reference->marks;
  field.count = 0;
  enter_all(&problem);
  race(quick ? 8 : 60);
  FILE *csv =
      ethd__bench_csv(folder, "integrators",
                      "# plant n alone, torques of taps recorded in closed loop; error: largest distance of ring\n"
                      "# or finger from DOPRI5 with events at tolerance 1e-15; CPU time per simulated second\n",
                      "method,setting,error_m,time_s");
  for (int i = 0; i < field.count; i++) {
    integrator *c = &field.all[i];
    c->error = ethd__problem_error(&problem, c->marks, truth);
    printf("  %-26s %8.1e  %9.2e m %10.1f us/s\n", c->name, c->setting, c->error, 1e6 * c->time);
    fprintf(csv, "\"%s\",%.17g,%.17g,%.17g\n", c->name, c->setting, c->error, c->time);
  }
  goal("rkf45", "GSL rkf45", 1e-6, 2);
  goal("rkf45", "GSL rkf45", 1e-7, 1.3);
  goal("rkf45", "GSL rkf45", 1e-8, 1.3);
  goal("rkf45", "GSL rkf45", 1e-10, 1);
  goal("CVODE", "CVODE", 1e-6, 30);
  goal("CVODE", "CVODE", 1e-8, 30);
  goal("MuJoCo", "MuJoCo", 1e-6, 25);
  order();
  for (int i = 0; i < field.count; i++) {
    if (field.all[i].runner.peer) field.all[i].runner.peer->destroy(field.all[i].runner.peer_self);
    free(field.all[i].marks);
  }
  free(truth);
  ethd__problem_free(&problem);
  return ethd__bench_close();
}

const ethd__bench ethd__bench_integrators = {"integrators",
                                             "the plant's integration, against GSL, CVODE, odeint, MuJoCo", run};
