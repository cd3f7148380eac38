/* Scene queries beside other libraries': the nearest of n segments, its distance, point and normal. */
#include "bench/scene_race.h"

#include <math.h>

#include "cli/cli.h"

static const char *name_of(const ethd__contest *t, int i) { return t->contenders[i].name; }

static void write_times(FILE *csv, const ethd__bench_times *t, double mean) {
  fprintf(csv, ",%.17g,%.17g,%.17g,%.17g,%.17g", mean, t->median, t->p99, t->p999, t->max);
}

static void write_csv(const ethd__contest *t, FILE *csv) {
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int size = 0; size < SIZES; size++)
      for (int ask = 0; ask < ETHD__ASKS; ask++)
        for (int i = 0; i < CONTENDERS; i++) {
          const ethd__race_result *r = &t->results[kind][size][ask][i];
          if (!r->there) continue;
          fprintf(csv, "%s,%zu,%s,%s", ethd__world_names[kind], ethd__contest_sizes[size], ethd__ask_names[ask],
                  name_of(t, i));
          write_times(csv, &r->each, r->mean);
          if (size < CALM_FROM)
            fprintf(csv, ",,,,,");
          else
            write_times(csv, &r->calm, r->calm.mean);
          fprintf(csv, ",%.17g,", r->build);
          if (r->bytes > 0) fprintf(csv, "%.17g", r->bytes);
          fprintf(csv, ",%.17g\n", r->apart);
        }
}

static void print_short(double ns) {
  if (ns < 999.5)
    printf("%9.3g", ns);
  else if (ns < 999.5e3)
    printf("%7.3g us", 1e-3 * ns);
  else
    printf("%7.3g ms", 1e-6 * ns);
}

static void print_question(const ethd__contest *t, int kind, int ask) {
  printf("  %s, %s\n  %-18s", ethd__world_names[kind], ethd__ask_names[ask], "segments");
  for (int size = 0; size < SIZES; size++) printf("%9zu", ethd__contest_sizes[size]);
  printf(" |%9s%9s%9s |%9s%9s\n", "p99", "p99.9", "max", "cold 50%", "p99");
  for (int i = 0; i < CONTENDERS; i++) {
    const ethd__race_result(*r)[ETHD__ASKS][CONTENDERS] = t->results[kind];
    if (!r[SIZES - 1][ask][i].there) continue;
    printf("    %-16s", name_of(t, i));
    for (int size = 0; size < SIZES; size++) print_short(r[size][ask][i].mean);
    const ethd__race_result *last = &r[SIZES - 1][ask][i];
    printf(" |");
    print_short(last->each.p99);
    print_short(last->each.p999);
    print_short(last->each.max);
    printf(" |");
    print_short(last->calm.median);
    print_short(last->calm.p99);
    printf("\n");
  }
}

static void print_builds(const ethd__contest *t) {
  printf("  build of %zu, ms of processor time (MB):", ethd__contest_sizes[SIZES - 1]);
  for (int i = 0; i < CONTENDERS; i++) {
    const ethd__race_result *r = &t->results[i == LOOSE ? ETHD__CONTOUR : ETHD__RANDOM][SIZES - 1][0][i];
    if (!r->there) continue;
    printf(" %s %.0f", name_of(t, i), 1e3 * r->build);
    if (r->bytes > 0) printf(" (%.1f)", 1e-6 * r->bytes);
  }
  printf("\n");
}

/* ---- goals ---- */

static void goal_ratio(const ethd__contest *t, ethd__world_kind kind, int size, ethd__ask ask, int peer, double least) {
  const ethd__race_result *r = t->results[kind][size][ask];
  if (!r[peer].there) return;
  double times = r[peer].mean / r[OURS].mean;
  printf("  goal: %s %zu %s: %s takes %.1f times as long: %.2f, %s\n", ethd__world_names[kind],
         ethd__contest_sizes[size], ethd__ask_names[ask], name_of(t, peer), least, times,
         ethd__bench_verdict(times >= least));
}

static void goal_incoherent(const ethd__contest *t) {
  if (!t->contenders[EMBREE].peer) return;
  for (int kind = 0; kind < ETHD__WORLDS; kind++) {
    int met = 1;
    printf("  goal: %s incoherent: Embree never quicker; it takes", ethd__world_names[kind]);
    for (int size = 0; size < SIZES; size++) {
      const ethd__race_result *r = t->results[kind][size][ETHD__COLD];
      met &= r[EMBREE].mean >= r[OURS].mean;
      printf(" %.2f", r[EMBREE].mean / r[OURS].mean);
    }
    printf(" times as long, %s\n", ethd__bench_verdict(met));
  }
}

static void goal_most(const char *what, double found, double most, const char *unit) {
  printf("  goal: %s at most %g %s: %.3g, %s\n", what, most, unit, found, ethd__bench_verdict(found <= most));
}

static void print_goals(const ethd__contest *t) {
  enum { TEN = 4, HUNDRED = 5 }; /* thousands */
  goal_ratio(t, ETHD__CONTOUR, TEN, ETHD__WARM, EMBREE, 4);
  goal_ratio(t, ETHD__CONTOUR, TEN, ETHD__WARM, CGAL, 3);
  goal_ratio(t, ETHD__RANDOM, TEN, ETHD__WARM, EMBREE, 1.4);
  goal_incoherent(t);
  const ethd__race_result *contour = &t->results[ETHD__CONTOUR][HUNDRED][ETHD__WARM][OURS];
  const ethd__race_result *random = &t->results[ETHD__RANDOM][HUNDRED][ETHD__WARM][OURS];
  goal_most("contour 100000 warm, p99", contour->each.p99, 500, "ns");
  goal_most("build of 100000", 1e3 * fmax(contour->build, random->build), 36, "ms");
  goal_most("memory of 100000", 1e-6 * fmax(contour->bytes, random->bytes), 12, "MB");
}

static void run(const char *folder, int quick) {
  static ethd__contest t;
  static const struct {
    int i;
    const char *file;
  } peers[] = {{EMBREE, "embree"}, {CGAL, "cgal"}};
  printf("scene: the nearest of n segments, its distance, point and normal; ns\n"
         "  a path at 1 kHz, up to 1 m/s: warm knows its last answer, horizon wants only what is within %g mm;\n"
         "  incoherent: anywhere, nothing known. Best of rounds; p99 to max and cold (caches used by others): of %zu\n",
         1e3 * ETHD__BENCH_HORIZON, ethd__contest_sizes[SIZES - 1]);
  t.quick = quick;
  t.contenders[OURS].name = "libethd";
  t.contenders[LOOSE].name = "libethd loose";
  for (size_t k = 0; k < sizeof peers / sizeof *peers; k++) {
    ethd__scene_contender *c = &t.contenders[peers[k].i];
    c->peer = ethd__bench_peer(peers[k].file, "peer_scene");
    if (c->peer) c->name = c->peer->name;
  }
  ethd__contest_run(&t);
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int ask = ETHD__ASKS - 1; ask >= 0; ask--) print_question(&t, kind, ask);
  print_builds(&t);
  print_goals(&t);
  FILE *csv = ethd__bench_csv(
      folder, "scene",
      "# nearest of n segments: distance, point, normal; contour: libethd has one polyline, libethd "
      "loose and the others n segments\n"
      "# mean: blocks of 100 queries, each at its best of the rounds; median to max: query by query, likewise\n"
      "# cold: 8 MB of something else used between two queries. difference: largest, from libethd's distance\n",
      "scene,segments,mode,contender,mean_ns,median_ns,p99_ns,p999_ns,max_ns,cold_mean_ns,cold_median_ns,"
      "cold_p99_ns,cold_p999_ns,cold_max_ns,build_s,memory_bytes,difference_m");
  write_csv(&t, csv);
  ethd__bench_close();
}

const ethd__bench ethd__bench_scene = {"scene", run};
