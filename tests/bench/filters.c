/* Finger filters: error of the extrapolated position at every tick against ns a tick, on reaches and on recorded
   movements. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "bench/tracks.h"
#include "cli/cli.h"
#include "ethd/estimate.h"
#include "ethd/ethd.h"

enum { LATENCIES = 3, REACHES = 40, SETS_MAX = 16 };

static const double latencies[LATENCIES] = {0, 3e-3, 6e-3};
static const double goals[LATENCIES] = {0.15, 0.25, 0.30}; /* least share of cv's error that ca saves */

#define SETTLE 30 /* ticks: a filter starts at its first reading */

/* Values of up to two rows of a method's table, the best of a grid on the reaches; all other rows have their
   defaults. */
typedef struct tuning {
  const char *row[2]; /* NULL: none */
  double value[2];
} tuning;

static const tuning tunings[LATENCIES][ETHD_FILTER_COUNT] = {
    {[ETHD_FILTER_ALPHA_BETA] = {{"beta", "alpha"}, {0.447, 0.5}},
     [ETHD_FILTER_CV] = {{"acceleration", NULL}, {6.1, 0}},
     [ETHD_FILTER_CA] = {{"jerk", "memory"}, {183, 0.16}}},
    {[ETHD_FILTER_ALPHA_BETA] = {{"beta", "alpha"}, {0.447, 0.4}},
     [ETHD_FILTER_CV] = {{"acceleration", NULL}, {6.1, 0}},
     [ETHD_FILTER_CA] = {{"jerk", "memory"}, {183, 0.16}}},
    {[ETHD_FILTER_ALPHA_BETA] = {{"beta", "alpha"}, {0.447, 0.4}},
     [ETHD_FILTER_CV] = {{"acceleration", NULL}, {7.63, 0}},
     [ETHD_FILTER_CA] = {{"jerk", "memory"}, {183, 0.16}}},
};

/* One method of finding where the finger is; it starts anew with every call. */
typedef struct contender {
  const char *name;
  void (*work)(void *self, const double (*in)[3], double (*out)[2], size_t count);
  void *self;
} contender;

static double ticks_out[ETHD__TRACK_MAX][2];

/* ---- contenders ---- */

static void filter_work(void *self, const double (*in)[3], double (*out)[2], size_t count) {
  const ethd_filter *f = self;
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  for (size_t i = 0; i < count; i++) {
    ethd_vec x, v;
    ethd_filter_predict(f, &s, ETHD__TRACK_PERIOD);
    if (!isnan(in[i][2])) (void)!ethd_filter_update(f, &s, (ethd_vec){in[i][0], in[i][1]}, in[i][2]);
    ethd_filter_output(f, &s, &x, &v);
    out[i][0] = x.x;
    out[i][1] = x.y;
  }
}

static void two_readings(void *self, const double (*in)[3], double (*out)[2], size_t count) {
  double x[2] = {0, 0}, v[2] = {0, 0}, age = 0;
  int known = 0;
  (void)self;
  for (size_t i = 0; i < count; i++) {
    age += ETHD__TRACK_PERIOD;
    if (!isnan(in[i][2])) {
      for (int k = 0; k < 2; k++) {
        v[k] = known ? (in[i][k] - x[k]) / (age - in[i][2]) : 0;
        x[k] = in[i][k];
      }
      age = in[i][2];
      known = 1;
    }
    for (int k = 0; k < 2; k++) out[i][k] = x[k] + v[k] * age;
  }
}

/* ---- error ---- */

typedef struct sum {
  double squares;
  double count;
} sum;

static void add_errors(const contender *c, const ethd__tracks *set, sum *to) {
  for (size_t t = 0; t < set->count; t++) {
    const ethd__track *track = &set->at[t];
    c->work(c->self, (const double(*)[3])track->in, ticks_out, track->count);
    for (size_t i = SETTLE; i < track->count; i++)
      for (int k = 0; k < 2; k++) {
        double e = ticks_out[i][k] - track->truth[i][k];
        to->squares += e * e;
        to->count += 1;
      }
  }
}

static double error_of(const contender *c, const ethd__tracks *sets, size_t count) {
  sum all = {0, 0};
  for (size_t s = 0; s < count; s++) add_errors(c, &sets[s], &all);
  return sqrt(all.squares / all.count);
}

/* ---- time ---- */

typedef struct timed {
  contender c;
  const ethd__track *track;
} timed;

static void work(void *data) {
  timed *t = data;
  t->c.work(t->c.self, (const double(*)[3])t->track->in, ticks_out, t->track->count);
}

static void race(contender *list, size_t count, const ethd__track *track, double seconds, double *ns) {
  timed t[8];
  bench_entry entries[8];
  for (size_t i = 0; i < count; i++) {
    t[i] = (timed){list[i], track};
    entries[i] = (bench_entry){list[i].name, work, &t[i], (double)track->count, 0};
  }
  bench_race(entries, count, seconds);
  for (size_t i = 0; i < count; i++) ns[i] = entries[i].ns;
}

/* ---- one latency ---- */

/* Beside the filters: two readings. */
enum { RUNNERS = ETHD_FILTER_COUNT + 1 };

typedef struct field {
  contender list[RUNNERS];
  size_t count;
  ethd_filter filters[ETHD_FILTER_COUNT];
} field;

static const ethd_filter_method order[] = {ETHD_FILTER_HOLD, ETHD_FILTER_ALPHA_BETA, ETHD_FILTER_CV, ETHD_FILTER_CA};
_Static_assert(sizeof order / sizeof *order == ETHD_FILTER_COUNT, "each filter once");

enum { HOLD = 0, CV = 3, CA = 4 }; /* in the field */

static ethd_filter filter_of(ethd_filter_method method, const tuning *t) {
  const ethd_method *m = &ethd_filter_methods[method];
  double p[ETHD_PARAMS_MAX];
  ethd_filter f;
  ethd_error error;
  ethd_params_default(m->params, m->param_count, p);
  for (int i = 0; i < 2; i++)
    if (t->row[i]) p[ethd_params_find(m->params, m->param_count, t->row[i])] = t->value[i];
  if (ethd_filter_prepare(method, p, ETHD__TRACK_PERIOD, &f, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return f;
}

/* Gathers the contenders: hold, two readings, alpha-beta, cv, ca. */
static void gather(field *f, const tuning *t) {
  f->count = 0;
  for (int i = 0; i < ETHD_FILTER_COUNT; i++) {
    ethd_filter_method m = order[i];
    f->filters[m] = filter_of(m, &t[m]);
    f->list[f->count++] = (contender){ethd_filter_methods[m].id, filter_work, &f->filters[m]};
    if (i == 0) f->list[f->count++] = (contender){"two readings", two_readings, NULL};
  }
}

static void compare(FILE *csv, const field *f, const char *set, double latency, const ethd__tracks *sets, size_t count,
                    const double *ns, double *errors) {
  char panel[64];
  snprintf(panel, sizeof panel, "%s at %.0f ms: error in m", set, 1e3 * latency);
  printf("  %-36s", panel);
  for (size_t i = 0; i < f->count; i++) {
    errors[i] = error_of(&f->list[i], sets, count);
    bench_row(csv, panel, f->list[i].name, ns[i], errors[i]);
    printf(" %12.4f", 1e3 * errors[i]);
  }
  printf("  %5.1f %%\n", 100 * (1 - errors[CA] / errors[CV]));
}

static void one_latency(FILE *csv, int l, double seconds) {
  static const tuning defaults[ETHD_FILTER_COUNT];
  double latency = latencies[l], ns[RUNNERS], errors[RUNNERS] = {0};
  ethd__tracks reaches = ethd__tracks_reaches(REACHES, latency), recorded[SETS_MAX];
  size_t sets = ethd__tracks_recorded(latency, recorded, SETS_MAX);
  field f;
  gather(&f, tunings[l]);
  race(f.list, f.count, &reaches.at[0], seconds, ns);
  printf("  %-36s", "rms error, mm");
  for (size_t i = 0; i < f.count; i++) printf(" %12s", f.list[i].name);
  printf("  ca under cv\n");
  compare(csv, &f, "reaches", latency, &reaches, 1, ns, errors);
  double gain = 1 - errors[CA] / errors[CV];
  gather(&f, defaults);
  if (sets) compare(csv, &f, "recorded", latency, recorded, sets, ns, errors);
  printf("  %-36s", "ns a tick");
  for (size_t i = 0; i < f.count; i++) printf(" %12.1f", ns[i]);
  printf("\n  goal: ca at least %.0f %% under cv on reaches at %.0f ms: %.1f %%, %s\n", 100 * goals[l], 1e3 * latency,
         100 * gain, bench_verdict(gain >= goals[l]));
  if (sets)
    printf("  goal: ca under cv under hold on recorded movements at %.0f ms, %s\n", 1e3 * latency,
           bench_verdict(errors[CA] < errors[CV] && errors[CV] < errors[HOLD]));
  else if (l == 0)
    printf("SKIP: recorded movements: none in ETHD_MOTION_DIR\n");
  ethd__tracks_free(&reaches);
  for (size_t s = 0; s < sets; s++) ethd__tracks_free(&recorded[s]);
}

void bench_filters(const char *folder, int quick) {
  printf("finger filters: readings at 300 Hz with 0.1 mm of noise, output every ms\n");
  FILE *csv =
      bench_csv(folder, "filters",
                "# simulated readings at 300 Hz, noise 0.1 mm (sd, each axis); error: m, rms over ticks of 1 ms\n"
                "# and both axes; reaches: 40 of minimum jerk, 0.5 to 1.1 m/s, each filter tuned to them; recorded:\n"
                "# hand movements, filters as they are by default\n",
                BENCH_RACE);
  for (int l = 0; l < LATENCIES; l++) one_latency(csv, l, quick ? 0.1 : 1);
  bench_close();
}
