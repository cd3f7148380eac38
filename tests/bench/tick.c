/* The whole tick, recording included: hot, by law, scene and kind of finger. */
#include "bench/tick.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "clock.h"

/* ---- hot ---- */

static void tap(void *data) {
  ethd__ticking *t = data;
  for (int k = 0; k < ETHD__TAP_TICKS; k++) ethd__ticking_step(t, ethd__ticking_sense(t));
}

static const struct {
  const char *name;
  ethd__tap_wall wall;
  size_t segments;
} scenes[] = {{"none", ETHD__TAP_NOTHING, 0},    {"wall", ETHD__TAP_PLANE, 0},
              {"+1000", ETHD__TAP_BESIDE, 1000}, {"100", ETHD__TAP_OUTLINE, 100},
              {"1000", ETHD__TAP_OUTLINE, 1000}, {"100000", ETHD__TAP_OUTLINE, 100000}};
enum { NONE, WALL, BESIDE, HUNDRED, THOUSAND, MANY, SCENES };

static const char *const fingers[] = {"known", "encoder", "centre", "rays"};
enum { FINGERS = sizeof fingers / sizeof *fingers };

static const ethd_transition_law *const laws[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                  &ethd_transition_offset, &ethd_transition_predictive};
enum { LAWS = sizeof laws / sizeof *laws, OFFSET = 2, PREDICTIVE = 3 };

/* Times steps one by one and subtracts the clock's cost. */
static void time_ticks(ethd__ticking *t, double *ns, size_t count) {
  double cost = bench_clock_cost();
  for (size_t i = 0; i < count; i++) {
    const ethd_sense *sense = ethd__ticking_sense(t);
    int64_t start = ethd__clock_now();
    ethd__ticking_step(t, sense);
    ns[i] = fmax(0, (double)(ethd__clock_now() - start) - cost);
  }
}

/* Takes each tick of the taps in `ns` at the lower quartile of its times. */
static bench_times quiet_times(const double *ns, size_t count) {
  enum { ROUNDS_MAX = 256 };
  double ticks[ETHD__TAP_TICKS], rounds[ROUNDS_MAX];
  size_t n = count / ETHD__TAP_TICKS;
  for (size_t k = 0; k < ETHD__TAP_TICKS; k++) {
    for (size_t r = 0; r < n; r++) rounds[r] = ns[r * ETHD__TAP_TICKS + k];
    (void)bench_percentiles(rounds, n);
    ticks[k] = rounds[n / 4];
  }
  return bench_percentiles(ticks, ETHD__TAP_TICKS);
}

typedef struct hot {
  bench_entry entries[LAWS * FINGERS * SCENES];
  ethd__tick_row rows[LAWS * FINGERS * SCENES];
  size_t count;
  size_t at[LAWS][FINGERS][SCENES]; /* index into entries */
} hot;

/* Gathers the combinations: the default law runs in all of them, the others in those that make sense for them. */
static void gather(hot *h) {
  h->count = 0;
  for (int l = 0; l < LAWS; l++)
    for (int f = 0; f < FINGERS; f++)
      for (int s = 0; s < SCENES; s++) {
        if (l != OFFSET && (f != ETHD__TAP_RAYS || s == MANY)) continue;
        h->at[l][f][s] = h->count;
        h->rows[h->count] = (ethd__tick_row){"hot", laws[l]->law.id, scenes[s].name, fingers[f]};
        ethd__ticking *t = ethd__ticking_create(laws[l], scenes[s].wall, scenes[s].segments, (ethd__tap_finger)f);
        h->entries[h->count++] = (bench_entry){"", tap, t, ETHD__TAP_TICKS, 0};
      }
}

static double mean_of(const hot *h, int l, int f, int s) { return h->entries[h->at[l][f][s]].ns; }

/* Hot ticks at a wall under both laws, by turns, so that what else the machine does meets both. */
static double looking_ahead_costs(const hot *h, int quick) {
  const int f = ETHD__TAP_RAYS;
  bench_entry both[2] = {{"", tap, h->entries[h->at[PREDICTIVE][f][WALL]].data, ETHD__TAP_TICKS, 0},
                         {"", tap, h->entries[h->at[OFFSET][f][WALL]].data, ETHD__TAP_TICKS, 0}};
  bench_race(both, 2, quick ? 0.2 : 2);
  return both[0].ns / both[1].ns;
}

/* ---- goals ---- */

static void judge(const hot *h, const bench_times *times) {
  static const int judged[] = {ETHD__TAP_ENCODER, ETHD__TAP_RAYS}, walls[] = {BESIDE, THOUSAND};
  for (int f = 0; f < 2; f++)
    for (int s = 0; s < 2; s++) {
      const bench_times *t = &times[h->at[OFFSET][judged[f]][walls[s]]];
      char what[64];
      snprintf(what, sizeof what, "mean, %s, 1000 segments %s", fingers[judged[f]], s ? "tapped" : "beside the wall");
      bench_goal(what, t->mean, 150, "ns");
      snprintf(what, sizeof what, "p99, %s, 1000 segments %s", fingers[judged[f]], s ? "tapped" : "beside the wall");
      bench_goal(what, t->p99, 230, "ns");
    }
}

static void run(const char *folder, int quick) {
  size_t count = (size_t)(quick ? 20 : 200) * ETHD__TAP_TICKS;
  double *ns = malloc(count * sizeof *ns);
  static hot h;
  if (!ns) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  FILE *csv =
      bench_csv(folder, "tick",
                "# a tap a second: ring and finger meet the wall at x = 0.238 m and stay "
                "there for a fifth of the time\n"
                "# finger: known; encoder: the same, joint speeds estimated; centre, "
                "rays: readings at 300 Hz, filtered, fitted\n"
                "# scene: nothing, a half-plane, the half-plane and 1000 segments near "
                "it, an outline alone of as many segments as it says\n"
                "# hot mean, median, p99: of the quickest quarter of each tick's repetitions; tail, max: of all\n"
                "# tail: share_longer of the ticks take longer\n",
                "what,law,scene,finger,name,share_longer,time_ns");
  printf("the whole tick, recording included, ns; finger: rays are fitted and filtered, and joint "
         "speeds estimated\n");
  printf("  %-10s %-8s %-7s %-8s %7s %7s %7s %8s %9s\n", "", "law", "scene", "finger", "mean", "median", "p99", "p99.9",
         "max");
  gather(&h);
  bench_times times[LAWS * FINGERS * SCENES];
  for (size_t i = 0; i < h.count; i++) {
    bench_race(&h.entries[i], 1, quick ? 0.05 : 0.5); /* the parts run one after the other, each in a warm cache */
    time_ticks(h.entries[i].data, ns, count);
    bench_times quiet = quiet_times(ns, count);
    quiet.mean = h.entries[i].ns;
    times[i] = ethd__tick_report(csv, h.rows[i], ns, count, &quiet);
  }
  ethd__tick_cold(csv, quick);
  ethd__tick_live(csv, quick);
  judge(&h, times);
  bench_goal("hot mean at a wall, predictive against offset, times", looking_ahead_costs(&h, quick), 1.15, "");
  bench_goal("hot mean from 100 to 100000 segments, times",
             mean_of(&h, OFFSET, ETHD__TAP_RAYS, MANY) / mean_of(&h, OFFSET, ETHD__TAP_RAYS, HUNDRED), 2.2, "");
  ethd__tick_space(&h.entries[h.at[OFFSET][ETHD__TAP_CENTRE][NONE]], quick);
  ethd__tick_mesh(quick);
  for (size_t i = 0; i < h.count; i++) ethd__ticking_destroy(h.entries[i].data);
  free(ns);
  bench_close();
}

const bench bench_tick = {"tick", run};
