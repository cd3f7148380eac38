/* Scene queries beside other libraries': the nearest of n segments, its distance, point and normal. Then solids of space,
   alone. */
#include <math.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/scene_world.h"
#include "cli/cli.h"
#include "clock.h"
#include "ethd/solids.h"

enum { OURS, LOOSE, EMBREE, CGAL, CONTENDERS };
enum { SIZES = 6, LAST = SIZES - 1 };
static const size_t sizes[SIZES] = {1, 10, 100, 1000, 10000, 100000};

/* One contender's figures in one world for one order of queries; times in ns. */
typedef struct scene_result {
  int there;
  double mean, build, bytes, apart;
  bench_times each; /* query by query, each at its best of the rounds */
} scene_result;

static ethd__scene_contender contenders[CONTENDERS];
static scene_result results[ETHD__WORLDS][SIZES][ETHD__ASKS][CONTENDERS];
static ethd_vec points[2][BENCH_POINTS]; /* a path; anywhere */

/* ---- one world ---- */

typedef struct queries {
  ethd__scene_contender *contender;
  ethd__ask ask;
  const ethd_vec *points;
} queries;

static void ask_all(void *data) {
  const queries *q = data;
  double sum = 0;
  for (int k = 0; k < BENCH_POINTS; k++) sum += ethd__contender_nearest(q->contender, q->ask, q->points[k]);
  bench_sink = sum;
}

static bench_times each_query(queries *q, int rounds) {
  static double ns[BENCH_POINTS];
  const double clock = bench_clock_cost();
  const int64_t enough = ethd__clock_now() + 200000000; /* for slow ones */
  for (int k = 0; k < BENCH_POINTS; k++) ns[k] = INFINITY;
  for (int r = 0; r < rounds && (r == 0 || ethd__clock_now() < enough); r++)
    for (int k = 0; k < BENCH_POINTS; k++) {
      int64_t start = ethd__clock_now();
      bench_sink = ethd__contender_nearest(q->contender, q->ask, q->points[k]);
      ns[k] = fmin(ns[k], fmax(0, (double)(ethd__clock_now() - start) - clock));
    }
  return bench_percentiles(ns, BENCH_POINTS);
}

/* Returns the largest difference between the distances of two contenders. */
static double apart(const queries *a, const queries *b) {
  double most = 0;
  for (int k = 0; k < BENCH_POINTS; k++) {
    double one = ethd__contender_nearest(a->contender, a->ask, a->points[k]);
    double other = ethd__contender_nearest(b->contender, b->ask, b->points[k]);
    if (!(one == other)) most = fmax(most, fabs(one - other));
  }
  return most;
}

static void ask_in(ethd__ask ask, scene_result *all, int quick) {
  queries q[CONTENDERS];
  bench_entry entries[CONTENDERS];
  size_t count = 0;
  for (int i = 0; i < CONTENDERS; i++) {
    q[i] = (queries){&contenders[i], ask, points[ask == ETHD__COLD]};
    if (all[i].there) entries[count++] = (bench_entry){"", ask_all, &q[i], BENCH_POINTS, 0};
  }
  bench_race(entries, count, quick ? 1e-3 : 5e-3); /* 5 and 25 turns, each over all points */
  for (size_t i = 0; i < count; i++) {
    scene_result *r = &all[(queries *)entries[i].data - q];
    r->mean = entries[i].ns;
    r->each = each_query(entries[i].data, quick ? 4 : 12);
    r->apart = apart(entries[i].data, &q[OURS]);
  }
}

static void run_world(ethd__world_kind kind, int size, int quick) {
  ethd__world world;
  ethd__world_create(kind, sizes[size], &world);
  contenders[OURS].chain = kind == ETHD__CONTOUR;
  for (int i = 0; i < CONTENDERS; i++) {
    int there = i == OURS || (i == LOOSE ? kind == ETHD__CONTOUR : contenders[i].peer != NULL);
    double build = INFINITY;
    for (int again = 0; there && again < (quick ? 2 : 5); again++) {
      if (again) ethd__contender_destroy(&contenders[i]);
      build = fmin(build, ethd__contender_create(&contenders[i], &world));
    }
    for (int ask = 0; there && ask < ETHD__ASKS; ask++)
      results[kind][size][ask][i] =
          (scene_result){.there = 1, .build = build, .bytes = (double)ethd__contender_bytes(&contenders[i])};
  }
  for (int ask = 0; ask < ETHD__ASKS; ask++) ask_in((ethd__ask)ask, results[kind][size][ask], quick);
  for (int i = 0; i < CONTENDERS; i++)
    if (results[kind][size][0][i].there) ethd__contender_destroy(&contenders[i]);
  ethd__world_destroy(&world);
}

/* ---- output ---- */

static void write_csv(FILE *csv) {
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int size = 0; size < SIZES; size++)
      for (int ask = 0; ask < ETHD__ASKS; ask++)
        for (int i = 0; i < CONTENDERS; i++) {
          const scene_result *r = &results[kind][size][ask][i];
          if (r->there)
            fprintf(csv, "%s,%zu,%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", ethd__world_names[kind],
                    sizes[size], ethd__ask_names[ask], contenders[i].name, r->mean, r->each.p99, r->each.p999,
                    r->each.max, r->build, r->bytes, r->apart);
        }
}

static void print_question(int kind, int ask) {
  printf("  %s, %s, ns\n  %-18s", ethd__world_names[kind], ethd__ask_names[ask], "segments");
  for (int size = 0; size < SIZES; size++) printf("%9zu", sizes[size]);
  printf(" |%9s%9s%9s\n", "p99", "p99.9", "max");
  for (int i = 0; i < CONTENDERS; i++) {
    const bench_times *each = &results[kind][LAST][ask][i].each;
    if (!results[kind][LAST][ask][i].there) continue;
    printf("    %-16s", contenders[i].name);
    for (int size = 0; size < SIZES; size++) printf("%9.3g", results[kind][size][ask][i].mean);
    printf(" |%9.3g%9.3g%9.3g\n", each->p99, each->p999, each->max);
  }
}

static void print_builds(void) {
  printf("  build of %zu, ms of processor time (MB):", sizes[LAST]);
  for (int i = 0; i < CONTENDERS; i++) {
    const scene_result *r = &results[i == LOOSE ? ETHD__CONTOUR : ETHD__RANDOM][LAST][0][i];
    if (r->there) printf(" %s %.0f (%.1f)", contenders[i].name, 1e3 * r->build, 1e-6 * r->bytes);
  }
  printf("\n");
}

/* ---- goals ---- */

static void goal_ratio(ethd__world_kind kind, int size, ethd__ask ask, int peer, double least) {
  const scene_result *r = results[kind][size][ask];
  if (!r[peer].there) return;
  double times = r[peer].mean / r[OURS].mean;
  printf("  goal: %s %zu %s: %s takes %.1f times as long: %.2f, %s\n", ethd__world_names[kind], sizes[size],
         ethd__ask_names[ask], contenders[peer].name, least, times, bench_verdict(times >= least));
}

static void judge(void) {
  enum { TEN_THOUSAND = 4 };
  goal_ratio(ETHD__CONTOUR, TEN_THOUSAND, ETHD__WARM, EMBREE, 4);
  goal_ratio(ETHD__CONTOUR, TEN_THOUSAND, ETHD__WARM, CGAL, 3);
  goal_ratio(ETHD__RANDOM, TEN_THOUSAND, ETHD__WARM, EMBREE, 1.4);
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int size = 0; size < SIZES; size++) goal_ratio((ethd__world_kind)kind, size, ETHD__COLD, EMBREE, 1);
  const scene_result *contour = &results[ETHD__CONTOUR][LAST][ETHD__WARM][OURS];
  const scene_result *random = &results[ETHD__RANDOM][LAST][ETHD__WARM][OURS];
  bench_goal("contour 100000 warm, p99", contour->each.p99, 500, "ns");
  bench_goal("build of 100000", 1e3 * fmax(contour->build, random->build), 36, "ms");
  bench_goal("memory of 100000", 1e-6 * fmax(contour->bytes, random->bytes), 12, "MB");
}

/* ---- solids ---- */

enum { SOLIDS = 1000 }; /* in a cube of 1 m about the origin */

typedef struct solids_asked {
  const ethd_solids *solids;
  ethd_vec3 x;
  double range;
} solids_asked;

static void ask_solids(void *data) {
  const solids_asked *a = data;
  ethd_surface nearest;
  bench_sink = (double)ethd_solids_surfaces(a->solids, NULL, a->x, a->range, &nearest, 1);
}

/* Times a query far from all, one with none within range, and one that finds all. */
static void run_solids(const char *shape, const char *sizes_of, int quick) {
  char *text;
  size_t length;
  ethd_solids *solids;
  FILE *out = open_memstream(&text, &length);
  for (int i = 0; i < SOLIDS; i++)
    fprintf(out, "%s %g %g %g %s\n", shape, i / 100 / 10. - 0.45, i / 10 % 10 / 10. - 0.45, i % 10 / 10. - 0.45,
            sizes_of);
  fclose(out);
  if (ethd_solids_parse(text, length, &solids, NULL)) ethd__fail(ETHD_EXIT_FAILED, "no solids");
  solids_asked asked[] = {{solids, {3, 0, 0}, 0.06}, {solids, {0, 0, 0}, 0.06}, {solids, {0, 0, 0}, 10}};
  bench_entry entries[3];
  for (int i = 0; i < 3; i++) entries[i] = (bench_entry){shape, ask_solids, &asked[i], i ? SOLIDS : 1, 0};
  bench_race(entries, 3, quick ? 1e-3 : 2e-2);
  printf("    %-10s%18.3g%18.3g%18.3g\n", shape, entries[0].ns, entries[1].ns, entries[2].ns);
  ethd_solids_destroy(solids);
  free(text);
}

static void print_solids(int quick) {
  printf("  %d solids of space, ns\n    %-10s%18s%18s%18s\n", SOLIDS, "", "far from all", "each, not near",
         "each, found");
  run_solids("sphere", "0.01", quick);
  run_solids("box", "0.01 0.01 0.01 1 1 1", quick);
}

static void run(const char *folder, int quick) {
  static const char *const files[CONTENDERS] = {[EMBREE] = "embree", [CGAL] = "cgal"};
  printf("scene: the nearest of n segments, its distance, point and normal\n"
         "  a path at 1 kHz, up to 1 m/s: warm knows its last answer, horizon wants only what is within %g mm;\n"
         "  incoherent: anywhere, nothing known; p99 to max: of %zu\n",
         1e3 * BENCH_HORIZON, sizes[LAST]);
  contenders[OURS].name = "libethd";
  contenders[LOOSE].name = "libethd loose";
  for (int i = EMBREE; i < CONTENDERS; i++) {
    contenders[i].peer = bench_peer(files[i], "peer_scene");
    if (contenders[i].peer) contenders[i].name = contenders[i].peer->name;
  }
  ethd__world_path(points[0]);
  ethd__world_anywhere(points[1]);
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int size = 0; size < SIZES; size++) run_world((ethd__world_kind)kind, size, quick);
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int ask = ETHD__ASKS - 1; ask >= 0; ask--) print_question(kind, ask);
  print_builds();
  print_solids(quick);
  judge();
  FILE *csv = bench_csv(
      folder, "scene",
      "# nearest of n segments: distance, point, normal; contour: libethd has one polyline, libethd loose and the\n"
      "# others n segments; p99 to max: query by query, each at its best of the rounds\n"
      "# difference: largest, from libethd's distance\n",
      "scene,segments,mode,contender,mean_ns,p99_ns,p999_ns,max_ns,build_s,memory_bytes,difference_m");
  write_csv(csv);
  bench_close();
}

const bench bench_scene = {"scene", run};
