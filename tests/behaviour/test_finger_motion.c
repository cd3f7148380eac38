/* The finger filters on recorded human movements (ETHD_MOTION_DIR): readings at 300 Hz with 0.1 mm of
   noise are made of each, and the filters compared where the finger is at every tick. Recordings are
   sampled at 100 to 250 Hz; between samples a cubic through four of them stands for the truth. */
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>

#include "unit/finger_run.h"

enum { SAMPLES_MAX = 4000, FILES_MAX = 1000 };

typedef struct recording {
  int count;
  double *t, *x, *y;
} recording;

static double cubic(const double *t, const double *p, int i, int n, double at) {
  int a = i > 0 ? i - 1 : 0, d = i + 2 < n ? i + 2 : n - 1;
  double h = t[i + 1] - t[i], u = (at - t[i]) / h;
  double m0 = (p[i + 1] - p[a]) / (t[i + 1] - t[a]) * h, m1 = (p[d] - p[i]) / (t[d] - t[i]) * h;
  double bend = p[i + 1] - p[i];
  return p[i] + u * (m0 + u * (3 * bend - 2 * m0 - m1 + u * (m0 + m1 - 2 * bend)));
}

static ethd_vec recording_at(const void *data, double t) {
  const recording *r = data;
  int low = 0, high = r->count - 1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (r->t[middle] <= t)
      low = middle;
    else
      high = middle;
  }
  t = fmin(fmax(t, r->t[low]), r->t[low + 1]);
  return (ethd_vec){cubic(r->t, r->x, low, r->count, t), cubic(r->t, r->y, low, r->count, t)};
}

static int load(const char *name, recording *out) {
  FILE *file = fopen(name, "r");
  char line[256];
  if (!file) return 0;
  *out = (recording){0, calloc(SAMPLES_MAX, 8), calloc(SAMPLES_MAX, 8), calloc(SAMPLES_MAX, 8)};
  if (!fgets(line, sizeof line, file)) line[0] = 0;
  int is_movement = strncmp(line, "t_s,x_m,y_m", 11) == 0, i = 0;
  while (is_movement && i < SAMPLES_MAX && fgets(line, sizeof line, file))
    if (sscanf(line, "%lf,%lf,%lf", &out->t[i], &out->x[i], &out->y[i]) == 3) i++;
  fclose(file);
  for (int k = i - 1; k >= 0; k--) out->t[k] -= out->t[0];
  out->count = i;
  return i >= 20;
}

static recording recordings[FILES_MAX];
static finger_path paths[FILES_MAX];

/* Loads a folder's movements behind the first `count`; how many there are then. */
static int load_folder(const char *folder, int count) {
  char pattern[4096];
  glob_t found;
  snprintf(pattern, sizeof pattern, "%s*.csv", folder);
  if (glob(pattern, 0, NULL, &found) != 0) return count;
  for (size_t i = 0; i < found.gl_pathc && count < FILES_MAX; i++) {
    recording *r = &recordings[count];
    if (!load(found.gl_pathv[i], r)) continue;
    paths[count++] = (finger_path){recording_at, r, r->t[r->count - 1]};
  }
  globfree(&found);
  return count;
}

static void errors(int first, int last, double latency, double rms[ETHD_FILTER_COUNT], long *gated) {
  for (int m = 0; m < ETHD_FILTER_COUNT; m++) {
    ethd_filter f = finger_filter((ethd_filter_method)m, NULL, 0);
    finger_error e = {0, 0, 0};
    for (int k = first; k < last; k++) finger_run(&f, &paths[k], latency, (uint64_t)k, &e);
    rms[m] = finger_rms(e);
    *gated += e.gated;
  }
}

static void report(const char *name, int first, int last) {
  for (int l = 0; l < 3; l++) {
    double rms[ETHD_FILTER_COUNT];
    long gated = 0;
    errors(first, last, finger_latencies[l], rms, &gated);
    double cv = rms[ETHD_FILTER_CV], ca = rms[ETHD_FILTER_CA];
    printf("%-24s %5d %10.0f %7.3f %10.4f %7.4f %7.4f %6.1f %% %5ld\n", name, last - first, 1e3 * finger_latencies[l],
           rms[ETHD_FILTER_HOLD], rms[ETHD_FILTER_ALPHA_BETA], cv, ca, 100 * (1 - ca / cv), gated);
  }
}

/* Over all movements: with each one's best tuning and with the defaults, hold is behind cv is behind ca,
   and nothing a person did is gated. */
static int ranked(int count) {
  int right = 1;
  for (int l = 0; l < 3; l++) {
    double latency = finger_latencies[l], q = 0, j = 0, rms[ETHD_FILTER_COUNT];
    long gated = 0;
    double cv = finger_best(ETHD_FILTER_CV, "acceleration", 4.2, 5, paths, count, latency, &q);
    double ca = finger_best(ETHD_FILTER_CA, "jerk", 220, 5, paths, count, latency, &j);
    errors(0, count, latency, rms, &gated);
    printf("all, best tuning, %.0f ms: cv %.4f (%.1f m/s^2), ca %.4f (%.0f m/s^3), %.1f %% less\n", 1e3 * latency, cv,
           q, ca, j, 100 * (1 - ca / cv));
    right &= rms[ETHD_FILTER_HOLD] > cv && cv > ca && rms[ETHD_FILTER_CV] > rms[ETHD_FILTER_CA] && gated == 0;
  }
  return right;
}

int main(void) {
  const char *root = getenv("ETHD_MOTION_DIR");
  char pattern[4096];
  glob_t folders;
  int count = 0;
  snprintf(pattern, sizeof pattern, "%s/*/", root ? root : "tests/motion");
  int none = glob(pattern, 0, NULL, &folders);
  if (none) folders.gl_pathc = 0;
  for (size_t i = 0; i < folders.gl_pathc; i++) {
    int first = count;
    count = load_folder(folders.gl_pathv[i], count);
    if (count == first) continue;
    if (!first)
      printf("error rms, mm: defaults   files latency ms    hold alpha-beta      cv      ca ca under cv "
             "gated\n");
    report(folders.gl_pathv[i] + strlen(pattern) - 2, first, count);
  }
  if (!none) globfree(&folders);
  if (!count) {
    printf("no recorded movements: %s\n", pattern);
    return EXIT_FAILURE;
  }
  report("all", 0, count);
  return ranked(count) ? EXIT_SUCCESS : EXIT_FAILURE;
}
