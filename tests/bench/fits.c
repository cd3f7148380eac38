/* Finger fits: the centre's error against the Cramer-Rao bound of the same rays and noise, and ns a fit. */
#include <math.h>
#include <string.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "ethd/ethd.h"
#include "unit/draw.h"

#define RING 12e-3 /* m */
#define FINGER 7.5e-3
#define NOISE (0.3e-3 / 1.7320508075688772) /* m, sd: normal, as much as +-0.3 mm uniform */
#define OUTLIER 3e-3                        /* m */
#define OFFSET 4e-3                         /* m: centres within this of the ring's */
#define SPEED 0.4                           /* m/s, in any direction */
#define FRAME 3.33e-3                       /* s: the 16 readings of a skewed frame, one after the other */

enum { TRIALS_MAX = 40000, TIMED = 512 };

typedef struct scenario {
  const char *name, *brief;
  int lost, outlier, skew;
} scenario;

static const scenario scenarios[] = {
    {"full", "16 rays", 0, 0, 0},
    {"arc", "an arc of 8 rays lost", 8, 0, 0},
    {"outlier", "16 rays, one off by 3 mm", 0, 1, 0},
    {"skew", "16 rays, read within 3.3 ms at 0.4 m/s", 0, 0, 1},
};
enum { SCENARIOS = sizeof scenarios / sizeof *scenarios };

/* What is drawn for a trial. */
typedef struct trial {
  double r[ETHD_RAYS];
  ethd_vec centre; /* in the middle of the frame's time */
  double bound[2]; /* m^2: of the squared error; radius sought, radius known */
} trial;

static trial trials[TRIALS_MAX];

/* ---- the bound ----

   A ray in direction u meets the circle about c at p = rho u: d rho / d (c, R) = (n, 1) / (n.u), n the
   circle's normal at p. With equal and independent noise of variance s^2 the information is the sum of
   g g^T / s^2 over the rays, and no unbiased estimate of c has less mean squared error than the trace
   of its inverse over c. */

static ethd_vec direction(int k) { return (ethd_vec){cos(2 * M_PI * k / ETHD_RAYS), sin(2 * M_PI * k / ETHD_RAYS)}; }

static void add_information(double m[3][3], ethd_vec c, double reach, int k) {
  ethd_vec u = direction(k), n = ethd_vec_scale(1 / FINGER, ethd_vec_sub(ethd_vec_scale(reach, u), c));
  double along = ethd_vec_dot(n, u), g[3] = {n.x / along, n.y / along, 1 / along};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] += g[i] * g[j];
}

/* Returns the trace of the inverse over the centre; a sought radius takes its share of the information (Schur). */
static double bound(double m[3][3], int known) {
  double share = known ? 0 : 1 / m[2][2];
  double a = m[0][0] - share * m[0][2] * m[0][2], b = m[0][1] - share * m[0][2] * m[1][2];
  double d = m[1][1] - share * m[1][2] * m[1][2];
  return NOISE * NOISE * (a + d) / (a * d - b * b);
}

/* ---- trials ---- */

static ethd_vec polar(double r, double angle) { return (ethd_vec){r * cos(angle), r * sin(angle)}; }

static void make_trial(uint64_t i, const scenario *what, trial *out) {
  const uint64_t at = 64 * i;
  double m[3][3] = {{0}};
  int first = (int)draw(at, 0, ETHD_RAYS);
  ethd_vec v = polar(what->skew ? SPEED : 0, draw(at + 1, 0, 2 * M_PI));
  out->centre = polar(OFFSET * sqrt(draw(at + 2, 0, 1)), draw(at + 3, 0, 2 * M_PI));
  for (int k = 0; k < ETHD_RAYS; k++) {
    double r[ETHD_RAYS], t = ((k + 0.5) / ETHD_RAYS - 0.5) * FRAME;
    ethd_vec c = ethd_vec_add(out->centre, ethd_vec_scale(t, v));
    int lost = (k - first + ETHD_RAYS) % ETHD_RAYS < what->lost;
    ethd_fit_rays(RING, FINGER, c, r);
    out->r[k] = lost ? (double)NAN : r[k] + NOISE * draw_normal(at + 16 + (uint64_t)k);
    if (!lost) add_information(m, c, RING - r[k], k);
  }
  if (what->outlier) out->r[first] += i % 2 ? OUTLIER : -OUTLIER;
  for (int known = 0; known < 2; known++) out->bound[known] = bound(m, known);
}

/* Returns the rms bound over the trials, m. */
static double rms_bound(int count, int known) {
  double sum = 0;
  for (int i = 0; i < count; i++) sum += trials[i].bound[known];
  return sqrt(sum / count);
}

/* ---- contenders ---- */

static ethd_fit prepare(ethd_fit_method method) {
  double p[ETHD_PARAMS_MAX];
  ethd_fit fit;
  ethd_error error;
  ethd_params_default(ethd_fit_methods[method].params, ethd_fit_methods[method].param_count, p);
  if (ethd_fit_prepare(method, p, RING, FINGER, &fit, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return fit;
}

static void work(void *data) {
  const ethd_fit *fit = data;
  ethd_finger finger;
  double sum = 0;
  for (int i = 0; i < TIMED; i++)
    if (ethd_fit_step(fit, trials[i].r, &finger) == ETHD_OK) sum += finger.centre.x;
  ethd__bench_sink = sum;
}

static double rms_error(const ethd_fit *fit, int count) {
  double sum = 0;
  for (int i = 0; i < count; i++) {
    ethd_finger finger;
    if (ethd_fit_step(fit, trials[i].r, &finger) != ETHD_OK)
      ethd__fail(ETHD_EXIT_FAILED, "%s: no fit", ethd_fit_methods[fit->method].id);
    ethd_vec e = ethd_vec_sub(finger.centre, trials[i].centre);
    sum += ethd_vec_dot(e, e);
  }
  return sqrt(sum / count);
}

/* ---- goals ---- */

typedef struct fit_figure {
  double error, ns;
} fit_figure;

static void goal(const char *what, double value, double most, const char *unit) {
  printf("  goal: %-44s <= %-5g %-12s %.4g, %s\n", what, most, unit, value, ethd__bench_verdict(value <= most));
}

static void judge(fit_figure f[SCENARIOS][ETHD_FIT_COUNT], double bounds[SCENARIOS][2]) {
  double slowest = 0;
  for (int s = 0; s < SCENARIOS; s++) slowest = fmax(slowest, fmax(f[s][ETHD_FIT_KASA].ns, f[s][ETHD_FIT_ROBUST].ns));
  goal("kasa, 16 rays", f[0][ETHD_FIT_KASA].error / bounds[0][0], 1.05, "x the bound");
  goal("robust, 16 rays", f[0][ETHD_FIT_ROBUST].error / bounds[0][1], 1.05, "x the bound");
  goal("robust, 8 rays", 1e3 * f[1][ETHD_FIT_ROBUST].error, 0.13, "mm");
  goal("robust, one outlier", 1e3 * f[2][ETHD_FIT_ROBUST].error, 0.10, "mm");
  goal("kasa and robust, the slowest of all", slowest, 150, "ns");
}

static void measure(const scenario *what, int count, double seconds, fit_figure out[ETHD_FIT_COUNT], double bounds[2]) {
  ethd_fit fits[ETHD_FIT_COUNT];
  ethd__bench_entry entries[ETHD_FIT_COUNT];
  for (int i = 0; i < count; i++) make_trial((uint64_t)i, what, &trials[i]);
  for (int m = 0; m < ETHD_FIT_COUNT; m++) {
    fits[m] = prepare((ethd_fit_method)m);
    entries[m] = (ethd__bench_entry){ethd_fit_methods[m].id, work, &fits[m], TIMED, 0};
  }
  ethd__bench_race(entries, ETHD_FIT_COUNT, seconds);
  for (int m = 0; m < ETHD_FIT_COUNT; m++) out[m] = (fit_figure){rms_error(&fits[m], count), entries[m].ns};
  for (int known = 0; known < 2; known++) bounds[known] = rms_bound(count, known);
}

void ethd__bench_fits(const char *folder, int quick) {
  fit_figure f[SCENARIOS][ETHD_FIT_COUNT];
  double bounds[SCENARIOS][2];
  FILE *csv = ethd__bench_csv(folder, "fits",
                              "# 16 rays of normal noise, sd 0.173 mm (as +-0.3 mm uniform); ring 12 mm, finger "
                              "7.5 mm within 4 mm of its middle\n"
                              "# bound: Cramer-Rao, the radius sought or known, rms over the same trials\n",
                              "scenario,method,time_ns,error_rms_mm,bound_sought_mm,bound_known_mm");
  printf("ring fits: rms error of the centre, mm, and ns a fit; bound: Cramer-Rao, radius sought / "
         "known\n");
  printf("  %-40s", "");
  for (int m = 0; m < ETHD_FIT_COUNT; m++) printf(" %16s", ethd_fit_methods[m].id);
  printf(" %16s\n", "bound");
  for (int s = 0; s < SCENARIOS; s++) {
    measure(&scenarios[s], quick ? 10000 : TRIALS_MAX, quick ? 0.1 : 1, f[s], bounds[s]);
    printf("  %-40s", scenarios[s].brief);
    for (int m = 0; m < ETHD_FIT_COUNT; m++) {
      printf("  %6.4f %5.0f ns", 1e3 * f[s][m].error, f[s][m].ns);
      fprintf(csv, "%s,%s,%.17g,%.17g,%.17g,%.17g\n", scenarios[s].name, ethd_fit_methods[m].id, f[s][m].ns,
              1e3 * f[s][m].error, 1e3 * bounds[s][0], 1e3 * bounds[s][1]);
    }
    printf("  %6.4f / %6.4f\n", 1e3 * bounds[s][0], 1e3 * bounds[s][1]);
  }
  judge(f, bounds);
  ethd__bench_close();
}
