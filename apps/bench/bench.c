#include "bench/bench.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "common/cli.h"
#include "ethd/ethd.h"

int64_t ethd__bench_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

double ethd__bench_clock_cost(void) {
  int64_t least = INT64_MAX;
  for (int i = 0; i < 10000; i++) {
    int64_t a = ethd__bench_now(), b = ethd__bench_now();
    if (b - a < least) least = b - a;
  }
  return (double)least;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

ethd__bench_times ethd__bench_percentiles(double *ns, size_t count) {
  double sum = 0;
  qsort(ns, count, sizeof *ns, ascending);
  for (size_t i = 0; i < count; i++) sum += ns[i];
  ethd__bench_times t = {sum / (double)count, ns[count / 2], ns[count - 1 - count / 100],
                         ns[count - 1 - count / 1000], ns[count - 1]};
  return t;
}

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

#ifdef __OPTIMIZE__
#define OPTIMIZED "optimized"
#else
#define OPTIMIZED "not optimized"
#endif

FILE *ethd__bench_csv(const char *folder, const char *name, const char *header) {
  char path[4096], cpu[256];
  snprintf(path, sizeof path, "%s/%s.csv", folder, name);
  FILE *f = fopen(path, "w");
  if (!f) ethd__fail(ETHD_EXIT_FAILED, "%s: %s", path, strerror(errno));
  processor(cpu, sizeof cpu);
  fprintf(f, "# libethd %s; %s, %ld processors; %s, %s\n%s\n", ETHD_VERSION, cpu,
          sysconf(_SC_NPROCESSORS_ONLN), __VERSION__, OPTIMIZED, header);
  return f;
}
