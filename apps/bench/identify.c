/* What identification asks of the simulator: arms without a finger over short windows, one after another and four side
   by side; whole fits of arms, and of touches. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/bench.h"
#include "bench/identify_touches.h"
#include "bench/methods.h"
#include "cli/cli.h"
#include "identify/fit.h"
#include "sim/plant.h"

#define GOAL 2000.0 /* simulated seconds per CPU second */
#define USED 1e-9   /* m/s: tolerance of the numbers that a fit says */
#define EXACT 1e-8  /* m: error at that tolerance */
#define TRUEST 1e-15
#define LONGEST 1e-5 /* s: steps of the reference, which looks out for no reversal of friction */
#define SINES 24

enum { WINDOWS = 12, TICKS = 250, ANGLES = 2 * TICKS, FIT_WINDOWS = 80, ROUNDS_MAX = 40 };

static const double tolerances[] = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, USED, 1e-10, 1e-11};
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances };

typedef struct one_arm {
  const char *name, *file;
  double coupling; /* kg m^2, more than the file has */
} one_arm;

static const one_arm arms[] = {
    {"n", "n.plant", 0}, {"b", "b.plant", 0}, {"p, elastic", "p.plant", 0}, {"n, coupled", "n.plant", 1.2e-3}};
enum { ARMS = sizeof arms / sizeof *arms };

typedef struct trip {
  ethd_plant plant;
  ethd__evidence evidence;
  ethd__passage passage;
  ethd__shot shots[FIT_WINDOWS];
  double states[FIT_WINDOWS][ETHD__STATE_MOST];
  int windows;
} trip;

static double cpu(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- commands ---- */

/* N at the ring; geometric sines, larger than friction and smaller than the force limit, as --excite gives them. */
static double force(int joint, double t) {
  double sum = 0;
  for (int i = 0; i < SINES; i++) sum += sin(2 * M_PI * 0.8 * pow(1.19, i + 0.5 * joint) * t + 2.4 * i * i + joint);
  return 0.28 * sum;
}

static void open_trip(const one_arm *a, int windows, trip *t) {
  char message[ETHD_MESSAGE_MAX], *path = ethd__data_path(a->file);
  size_t ticks = (size_t)windows * TICKS + ETHD__BACK;
  memset(t, 0, sizeof *t);
  if (ethd_plant_load(path, &t->plant, message)) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  free(path);
  t->plant.coupling += a->coupling;
  ethd_setup setup = ethd_setup_default();
  t->windows = windows;
  t->evidence = (ethd__evidence){.arm = setup.arm,
                                 .period = setup.period,
                                 .ring_radius = setup.ring_radius,
                                 .count = ticks,
                                 .stretches = &t->passage,
                                 .stretch_count = 1,
                                 .recording_count = 1,
                                 .q = calloc(ticks, sizeof *t->evidence.q),
                                 .torque = calloc(ticks, sizeof *t->evidence.torque)};
  t->passage = (ethd__passage){0, ticks, 0};
  if (!t->evidence.q || !t->evidence.torque) ethd__fail_memory();
  double link[2] = {setup.arm.link1, setup.arm.link2};
  for (size_t k = 0; k < ticks; k++)
    for (int j = 0; j < 2; j++) t->evidence.torque[k][j] = link[j] * force(j, (double)k * setup.period);
  for (int i = 0; i < windows; i++) {
    t->shots[i] = (ethd__shot){ETHD__BACK + (size_t)i * TICKS, 0, ticks, TICKS, 0};
    for (int s = 0; s < ETHD__STATE_RIGID; s++)
      t->states[i][s] = s < 2 ? (s ? 0.15 : 1.45) : ethd__bench_draw(4 * (uint64_t)i + (uint64_t)s, -0.5, 0.5);
  }
}

static void close_trip(trip *t) {
  free(t->evidence.q);
  free(t->evidence.torque);
}

/* ---- the reference: DOPRI5 on links and motors ---- */

static void rates(void *body_, double t, const double *y, double *out) {
  const ethd__body *b = body_;
  const ethd__sim_motion still = {.x = {0, 0}};
  (void)t;
  double q[ETHD__DOF_MAX] = {y[0], y[1], 0, 0, y[2], y[3]}, v[ETHD__DOF_MAX] = {y[4], y[5], 0, 0, y[6], y[7]};
  double a[ETHD__DOF_MAX] = {0};
  ethd__body_accelerate(b, ETHD__APART, &still, q, v, a);
  const double all[ETHD__ODE_SIZE] = {v[0], v[1], v[4], v[5], a[0], a[1], a[4], a[5]};
  memcpy(out, all, sizeof all);
}

static void run_reference(const ethd__method *method, const ethd__body *body, double time, double *y) {
  ethd__ode ode = {.self = (void *)(size_t)body, .rate = rates};
  double k1[ETHD__ODE_SIZE], next[ETHD__ODE_SIZE], out[ETHD__ODE_SIZE], done = 0;
  int fresh, steps = (int)ceil(time / LONGEST - 1e-9);
  for (int i = 1; i <= steps; i++) {
    double end = time * i / steps;
    rates((void *)(size_t)body, 0, y, k1);
    (void)method->step(&ode, done, end - done, y, k1, out, next, &fresh);
    memcpy(y, out, sizeof out);
    done = end;
  }
}

static void reference(const trip *t, double (*angles)[ANGLES]) {
  const ethd__method *method = &ethd__methods[ethd__method_count - 1];
  double T = t->evidence.period, late = t->plant.delay;
  for (int w = 0; w < t->windows; w++) {
    ethd__predictor p;
    ethd__predictor_prepare(&t->evidence, &t->plant, TRUEST, &p);
    const double *x = t->states[w];
    double y[ETHD__ODE_SIZE] = {x[0], x[1], x[0], x[1], x[2], x[3], x[2], x[3]};
    for (int k = 0; k < TICKS; k++) {
      const double(*torque)[2] = (const double(*)[2])t->evidence.torque + t->shots[w].first + k;
      double joints[4] = {y[0], y[1], y[2], y[3]};
      memcpy(angles[w] + 2 * k, joints + (p.body.compliant ? 2 : 0), 2 * sizeof *joints);
      for (int half = 0; half < 2; half++) {
        for (int j = 0; j < 2; j++)
          p.body.torque[j] = fmin(fmax(torque[half - 1][j], -p.body.torque_max[j]), p.body.torque_max[j]);
        run_reference(method, &p.body, half ? T - late : late, y);
      }
    }
  }
}

/* ---- contenders ---- */

typedef struct simulator {
  const char *name;
  bool at_once;
} simulator;

static const simulator simulators[] = {{"one after another", false}, {"four side by side", true}};
enum { SIMULATORS = sizeof simulators / sizeof *simulators };

/* Four plants that are alike, as the slopes of a fit ask for; simulated seconds. */
static double predict(const trip *t, const simulator *c, double tolerance, double (*angles)[ANGLES]) {
  double others[ETHD__ARMS][ANGLES];
  ethd__predictor p[ETHD__ARMS];
  for (int w = 0; w < t->windows; w++) {
    ethd__forecast f[ETHD__ARMS];
    for (int i = 0; i < ETHD__ARMS; i++) {
      ethd_plant plant = t->plant;
      plant.mass[i & 1] *= 1 + 3e-4 * i;
      ethd__predictor_prepare(&t->evidence, &plant, tolerance, &p[i]);
      f[i] = (ethd__forecast){&p[i], t->states[w], i ? others[i] : angles[w]};
    }
    if (c->at_once) ethd__predict_many(f, ETHD__ARMS, &t->shots[w]);
    for (int i = 0; i < ETHD__ARMS && !c->at_once; i++) ethd__predict(&p[i], &t->shots[w], f[i].state, f[i].out);
  }
  return ETHD__ARMS * t->windows * TICKS * t->evidence.period;
}

/* m at the ring, the largest of both joints. */
static double error_of(const trip *t, double (*a)[ANGLES], double (*b)[ANGLES]) {
  double worst = 0, link[2] = {t->evidence.arm.link1, t->evidence.arm.link2};
  for (int w = 0; w < t->windows; w++)
    for (int k = 0; k < ANGLES; k++) {
      double e = fabs(a[w][k] - b[w][k]) * link[k & 1];
      worst = e <= worst ? worst : e;
    }
  return worst;
}

typedef struct outcome {
  double error, rate; /* m, simulated s per CPU s */
} outcome;

static void race(const trip *t, int rounds, double (*truth)[ANGLES], outcome out[SIMULATORS][TOLERANCES]) {
  static double angles[WINDOWS][ANGLES];
  memset(out, 0, sizeof(outcome[SIMULATORS][TOLERANCES]));
  for (int r = 0; r < rounds; r++)
    for (int i = 0; i < SIMULATORS * TOLERANCES; i++) {
      outcome *o = &out[i % SIMULATORS][i / SIMULATORS];
      double begin = cpu(), seconds = predict(t, &simulators[i % SIMULATORS], tolerances[i / SIMULATORS], angles);
      o->rate = fmax(o->rate, seconds / (cpu() - begin));
      o->error = error_of(t, angles, truth);
    }
}

/* ---- a whole fit ---- */

/* Of encoders that the simulator itself gives, rounded to counts; simulated seconds per CPU second, all in all. */
static double fit_rate(const one_arm *a, int windows, double *seconds) {
  static trip t;
  ethd__predictor p;
  ethd__shooting problem;
  ethd__fit fit;
  double *out = calloc(2 * (size_t)windows * TICKS, sizeof *out);
  if (!out) ethd__fail_memory();
  open_trip(a, windows, &t);
  double count = t.plant.count;
  for (int i = 0; i < windows; i++) {
    ethd__predictor_prepare(&t.evidence, &t.plant, USED, &p);
    ethd__predict(&p, &t.shots[i], t.states[i], out);
    for (int k = 0; k < ANGLES; k++)
      t.evidence.q[t.shots[i].first + (size_t)(k / 2)][k & 1] = count * rint(out[k] / count);
  }
  free(out);
  ethd__fit_run(&t.evidence, &t.plant, count, &problem, &fit);
  ethd__shooting_close(&problem);
  close_trip(&t);
  *seconds = fit.seconds;
  return fit.simulated / fit.seconds;
}

/* ---- all ---- */

static void print_arm(FILE *csv, const one_arm *a, outcome out[SIMULATORS][TOLERANCES]) {
  printf("plant %s\n", a->name);
  for (int c = 0; c < SIMULATORS; c++)
    for (int i = 0; i < TOLERANCES; i++) {
      outcome o = out[c][i];
      printf("  %-18s %7.0e m/s %9.2e m %9.0f s per CPU second\n", simulators[c].name, tolerances[i], o.error, o.rate);
      fprintf(csv, "\"%s\",\"%s\",%.17g,%.17g,%.17g\n", a->name, simulators[c].name, tolerances[i], o.error, o.rate);
    }
  for (int i = 0; i < TOLERANCES; i++)
    if (tolerances[i] == USED)
      printf("  goal: at %.0e m/s, which a fit uses, an error of at most %.0e m side by side: %.1e, %s\n", USED, EXACT,
             out[1][i].error, ethd__bench_verdict(out[1][i].error <= EXACT));
}

static int run(const char *folder, int quick) {
  static double truth[WINDOWS][ANGLES];
  static trip t;
  outcome out[SIMULATORS][TOLERANCES];
  printf("identify: encoders predicted from commands, %d windows of %.2f s; error: the largest way of a joint at the "
         "ring\n"
         "from DOPRI5 in steps of %g s\n",
         WINDOWS, ETHD__WINDOW, LONGEST);
  FILE *csv =
      ethd__bench_csv(folder, "identify",
                      "# encoders predicted from commands; error: from DOPRI5 in steps of 10 us; simulated seconds\n"
                      "# per CPU second\n",
                      "plant,simulator,tolerance,error_m,seconds_per_cpu_second");
  for (int a = 0; a < ARMS; a++) {
    open_trip(&arms[a], WINDOWS, &t);
    reference(&t, truth);
    race(&t, quick ? 2 : ROUNDS_MAX, truth, out);
    print_arm(csv, &arms[a], out);
    close_trip(&t);
  }
  for (int a = quick ? 2 : 0; a < (quick ? 3 : ARMS); a++) {
    double seconds, rate = fit_rate(&arms[a], quick ? 20 : FIT_WINDOWS, &seconds);
    printf("  goal: a whole fit of plant %s predicts %.0f s per CPU second: %.0f in %.1f s, %s\n", arms[a].name, GOAL,
           rate, seconds, ethd__bench_verdict(rate >= GOAL));
  }
  static const char *const tapped[] = {"n", "b", "p"};
  for (int i = 0; i < (quick ? 1 : 3); i++) {
    double seconds;
    size_t touches;
    double rate = ethd__bench_touches(tapped[i], quick ? 12 : 20, folder, &seconds, &touches);
    printf("  goal: a whole fit of %zu touches on plant %s predicts %.0f s per CPU second: %.0f in %.1f s, %s\n",
           touches, tapped[i], GOAL, rate, seconds, ethd__bench_verdict(rate >= GOAL));
  }
  return ethd__bench_close();
}

const ethd__bench ethd__bench_identify = {"identify",
                                          "predictions of identification: run time against error, a whole fit", run};
