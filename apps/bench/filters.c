/* Finger filters: error of the extrapolated position at every tick against ns a tick, on reaches and on
   recorded movements. Each filter has the tuning that suits the reaches best. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "bench/filter_tuning.h"
#include "bench/peers.h"
#include "cli/cli.h"
#include "ethd/ethd.h"

enum { LATENCIES = 3, REACHES = 40, SETS_MAX = 16 };

static const double latencies[LATENCIES] = {0, 3e-3, 6e-3};
static const double goals[LATENCIES] = {0.15, 0.25, 0.30}; /* share by which ca's error is less than cv's */

/* ---- time ---- */

static double ticks_out[ETHD__TRACK_MAX][2];

typedef struct timed {
  ethd__filter_contender c;
  const ethd__track *track;
} timed;

static void work(void *data) {
  timed *t = data;
  t->c.work(t->c.self, (const double(*)[3])t->track->in, ticks_out, t->track->count);
}

static void race(ethd__filter_contender *list, size_t count, const ethd__track *track, double seconds, double *ns) {
  timed t[8];
  ethd__bench_entry entries[8];
  for (size_t i = 0; i < count; i++) {
    t[i] = (timed){list[i], track};
    entries[i] = (ethd__bench_entry){list[i].name, work, &t[i], (double)track->count, 0};
  }
  ethd__bench_race(entries, count, seconds);
  for (size_t i = 0; i < count; i++) ns[i] = entries[i].ns;
}

/* ---- one latency ---- */

static FILE *csv;

static void row(const char *set, double latency, const ethd__filter_contender *c, double ns, double error,
                const char *tuned) {
  fprintf(csv, "%s,%.17g,%s,%.17g,%.17g,%s\n", set, 1e3 * latency, c->name, ns, 1e3 * error, tuned);
}

/* Beside the filters: two readings, and the peer. */
enum { RUNNERS = ETHD_FILTER_COUNT + 2 };

typedef struct field {
  ethd__filter_contender list[RUNNERS];
  size_t count;
  ethd_filter filters[ETHD_FILTER_COUNT];
  char tuned[RUNNERS][64];
} field;

static const ethd_filter_method order[] = {ETHD_FILTER_HOLD, ETHD_FILTER_ALPHA_BETA, ETHD_FILTER_CV, ETHD_FILTER_CA};
_Static_assert(sizeof order / sizeof *order == ETHD_FILTER_COUNT, "each filter once");

enum { CV = 3, CA = 4, PEER = ETHD_FILTER_COUNT + 1 }; /* in the field */

/* Gathers the contenders: hold, two readings, alpha-beta, cv, ca, the peer, which is tuned as ca is. */
static void gather(field *f, const ethd__tracks *reaches, const ethd__peer_filter *peer) {
  ethd__tuning ca = {{NULL, NULL}, {0, 0}};
  f->count = 0;
  for (int i = 0; i < ETHD_FILTER_COUNT; i++) {
    ethd_filter_method m = order[i];
    ethd__tuning t = ethd__tuning_best(m, reaches, 1);
    if (m == ETHD_FILTER_CA) ca = t;
    f->filters[m] = ethd__tuning_filter(m, &t);
    ethd__tuning_text(&t, f->tuned[f->count]);
    f->list[f->count++] = (ethd__filter_contender){ethd_filter_methods[m].id, ethd__filter_work, &f->filters[m]};
    if (i == 0) {
      f->tuned[f->count][0] = 0;
      f->list[f->count++] = (ethd__filter_contender){"two readings", ethd__two_readings, NULL};
    }
  }
  if (!peer) return;
  strcpy(f->tuned[PEER], f->tuned[CA]);
  void *self = peer->create(ETHD__TRACK_PERIOD, ca.value[0], ca.value[1], ETHD__TRACK_NOISE);
  f->list[f->count++] = (ethd__filter_contender){peer->name, peer->work, self};
}

static int by_error(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Prints a ranking such as "ca < cv < hold". */
static void print_ranking(const field *f, const double *errors, size_t count) {
  double sorted[RUNNERS];
  memcpy(sorted, errors, count * sizeof *sorted);
  qsort(sorted, count, sizeof *sorted, by_error);
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < count; k++)
      if (errors[k] == sorted[i]) printf("%s%s", i ? " < " : "", f->list[k].name);
}

static void print_errors(const char *set, double latency, const double *errors, size_t count) {
  printf("  %-22s %4.0f ms", set, 1e3 * latency);
  for (size_t i = 0; i < count; i++) printf(" %12.4f", 1e3 * errors[i]);
  printf("  %5.1f %%\n", 100 * (1 - errors[CA] / errors[CV]));
}

static void compare(const field *f, const char *set, double latency, const ethd__tracks *sets, size_t count,
                    const double *ns, double *errors) {
  for (size_t i = 0; i < f->count; i++) {
    errors[i] = ethd__filter_contender_error(&f->list[i], sets, count);
    row(set, latency, &f->list[i], ns[i], errors[i], f->tuned[i]);
  }
  print_errors(set, latency, errors, f->count);
}

static void print_cv_ca(const ethd__tracks *recorded, size_t sets) {
  static const ethd_filter_method methods[2] = {ETHD_FILTER_CV, ETHD_FILTER_CA};
  double defaults[2], best[2];
  char text[2][64];
  for (int i = 0; i < 2; i++) {
    const ethd__tuning none = {{NULL, NULL}, {0, 0}};
    ethd__tuning t = ethd__tuning_best(methods[i], recorded, sets);
    defaults[i] = 1e3 * ethd__tuning_error(methods[i], &none, recorded, sets);
    best[i] = 1e3 * ethd__tuning_error(methods[i], &t, recorded, sets);
    ethd__tuning_text(&t, text[i]);
  }
  printf("    by default cv %.4f, ca %.4f, %.1f %%; tuned to them cv %.4f (%s), ca %.4f (%s), %.1f %%\n", defaults[0],
         defaults[1], 100 * (1 - defaults[1] / defaults[0]), best[0], text[0], best[1], text[1],
         100 * (1 - best[1] / best[0]));
}

static int one_latency(int l, double seconds, const ethd__peer_filter *peer) {
  double latency = latencies[l], ns[RUNNERS], errors[RUNNERS];
  ethd__tracks reaches = ethd__tracks_reaches(REACHES, latency), recorded[SETS_MAX];
  size_t sets = ethd__tracks_recorded(latency, recorded, SETS_MAX);
  field f;
  gather(&f, &reaches, peer);
  race(f.list, f.count, &reaches.at[0], seconds, ns);
  if (l == 0) {
    printf("  %-22s %7s", "rms error, mm", "");
    for (size_t i = 0; i < f.count; i++) printf(" %12s", f.list[i].name);
    printf("  ca under cv\n");
  }
  compare(&f, "reaches", latency, &reaches, 1, ns, errors);
  int met = errors[CA] <= (1 - goals[l]) * errors[CV];
  double gain = 100 * (1 - errors[CA] / errors[CV]);
  for (size_t s = 0; s < sets; s++) compare(&f, recorded[s].name, latency, &recorded[s], 1, ns, errors);
  if (sets) compare(&f, "all recorded", latency, recorded, sets, ns, errors);
  printf("  %-22s %7s", "ns a tick", "");
  for (size_t i = 0; i < f.count; i++) printf(" %12.1f", ns[i]);
  printf("\n  tuned: alpha-beta %s, cv %s, ca %s\n", f.tuned[2], f.tuned[3], f.tuned[4]);
  if (sets) {
    printf("  ranking on all recorded: ");
    print_ranking(&f, errors, PEER);
    printf("\n");
    print_cv_ca(&recorded[0], sets);
  }
  printf("  goal: ca at least %.0f %% under cv on reaches at %.0f ms: %.1f %%, %s\n", 100 * goals[l], 1e3 * latency,
         gain, ethd__bench_verdict(met));
  if (peer) peer->destroy(f.list[5].self);
  ethd__tracks_free(&reaches);
  for (size_t s = 0; s < sets; s++) ethd__tracks_free(&recorded[s]);
  return (int)sets;
}

static int run(const char *folder, int quick) {
  printf("finger filters: readings at 300 Hz with 0.1 mm of noise, output every ms\n");
  const ethd__peer_filter *peer = ethd__bench_peer("eigen", "peer_filter");
  csv = ethd__bench_csv(folder, "filters",
                        "# simulated readings at 300 Hz, noise 0.1 mm (sd, each axis); error rms over "
                        "ticks of 1 ms and both axes\n"
                        "# reaches: 40 of minimum jerk, 0.5 to 1.1 m/s; each filter tuned to them\n",
                        "set,latency_ms,method,time_ns,error_rms_mm,tuning");
  int sets = 0;
  for (int l = 0; l < LATENCIES; l++) sets = one_latency(l, quick ? 0.1 : 1, peer);
  if (!sets) printf("SKIP: recorded movements: none in ETHD_MOTION_DIR\n");
  return ethd__bench_close();
}

const ethd__bench ethd__bench_filters = {"filters", "where the finger is now, from late readings", run};
