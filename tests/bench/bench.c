#include "bench/bench.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "clock.h"
#include "ethd/ethd.h"
#include "text/text.h"

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double bench_clock_cost(void) {
  enum { MANY = 10001 };
  static double cost[MANY];
  for (int i = 0; i < MANY; i++) {
    int64_t a = ethd__clock_now(), b = ethd__clock_now();
    cost[i] = (double)(b - a);
  }
  qsort(cost, MANY, sizeof *cost, ascending);
  return cost[MANY / 2];
}

/* ---- races ---- */

volatile double bench_sink;

#define TURN 2e5 /* ns */

enum { TURNS_MAX = 20000, ENTRIES_MAX = 64 };

static double turn(const bench_entry *e, int repeats) {
  int64_t start = ethd__clock_now();
  for (int i = 0; i < repeats; i++) e->work(e->data);
  return (double)(ethd__clock_now() - start);
}

/* Doubles the repeats until a turn is long enough. */
static int repeats_of(const bench_entry *e) {
  int repeats = 1;
  while (turn(e, repeats) < TURN / 2 && repeats < 1 << 24) repeats *= 2;
  return repeats;
}

void bench_race(bench_entry *entries, size_t count, double seconds) {
  int repeats[ENTRIES_MAX], turns = (int)fmin(TURNS_MAX, fmax(5, 1e9 * seconds / TURN));
  double *ns = malloc(count * (size_t)turns * sizeof *ns);
  if (!ns || count > ENTRIES_MAX) ethd__fail(ETHD_EXIT_FAILED, "no room for a race");
  for (size_t i = 0; i < count; i++) repeats[i] = repeats_of(&entries[i]);
  for (int t = 0; t < turns; t++)
    for (size_t i = 0; i < count; i++)
      ns[i * (size_t)turns + (size_t)t] = turn(&entries[i], repeats[i]) / (repeats[i] * entries[i].items);
  for (size_t i = 0; i < count; i++) {
    qsort(&ns[i * (size_t)turns], (size_t)turns, sizeof *ns, ascending);
    entries[i].ns = ns[i * (size_t)turns + (size_t)turns / 4];
  }
  free(ns);
}

bench_times bench_percentiles(double *ns, size_t count) {
  double sum = 0;
  qsort(ns, count, sizeof *ns, ascending);
  for (size_t i = 0; i < count; i++) sum += ns[i];
  bench_times t = {sum / (double)count, ns[count / 2], ns[count - 1 - count / 100], ns[count - 1 - count / 1000],
                   ns[count - 1]};
  return t;
}

/* ---- peers ---- */

static const char *peers_folder;

void bench_peers_in(const char *folder) { peers_folder = folder; }

const void *bench_peer(const char *name, const char *symbol) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s.so", peers_folder, name);
  void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  const void *table = library ? dlsym(library, symbol) : NULL;
  if (!table) printf("peer %s: absent\n", name);
  return table;
}

/* ---- output ---- */

/* "model name : ..." of the first processor, or the machine's kind. */
static void processor(char *text, size_t room) {
  struct utsname u;
  char line[256];
  FILE *f = fopen("/proc/cpuinfo", "r");
  snprintf(text, room, "%s", uname(&u) == 0 ? u.machine : "unknown");
  while (f && fgets(line, sizeof line, f)) {
    char *colon = strchr(line, ':');
    if (strncmp(line, "model name", 10) != 0 || !colon) continue;
    line[strcspn(line, "\n")] = 0;
    snprintf(text, room, "%s", colon + 2);
    break;
  }
  if (f) fclose(f);
}

static const char *about_all = "";

void bench_about(const char *text) { about_all = text; }

static ethd_replace table; /* the question that is being answered has one */

FILE *bench_csv(const char *folder, const char *name, const char *about, const char *header) {
  char path[4096], cpu[256], message[ETHD_MESSAGE_MAX];
  snprintf(path, sizeof path, "%s/%s.csv", folder, name);
  if (ethd_replace_begin(path, &table, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  FILE *f = table.file;
  processor(cpu, sizeof cpu);
  fprintf(f, "# libethd %s; %s, %ld processors; compiler %s\n", ETHD_VERSION, cpu, sysconf(_SC_NPROCESSORS_ONLN),
          __VERSION__);
  if (*about_all) fprintf(f, "# %s\n", about_all);
  fprintf(f, "%s%s\n", about, header);
  return f;
}

void bench_row(FILE *csv, const char *panel, const char *method, double ns, double error) {
  fprintf(csv, "%s,%s,%.17g,%.17g\n", panel, method, ns, error);
}

void bench_close(void) {
  char message[ETHD_MESSAGE_MAX];
  if (ethd_replace_commit(&table, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

const char *bench_verdict(int met) { return met ? "met" : "MISSED"; }

void bench_goal(const char *what, double value, double most, const char *unit) {
  printf("  goal: %-52s <= %-5g %-11s %.4g, %s\n", what, most, unit, value, bench_verdict(value <= most));
}
