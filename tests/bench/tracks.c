#include "bench/tracks.h"

#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "ethd/sim.h"
#include "text/csv.h"
#include "unit/draw.h"

#define RATE 300.0 /* Hz */
#define REST 0.05  /* s */

/* ---- one movement, read ---- */

typedef ethd_vec (*path_at)(const void *path, double t);

static void *room_for(size_t count, size_t size) {
  void *p = calloc(count, size);
  if (!p) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  return p;
}

/* Reads a movement; the same seed gives the same noise and phase at any latency. */
static ethd__track read_path(path_at at, const void *path, double duration, double latency, uint64_t seed) {
  size_t count = (size_t)fmin(ETHD__TRACK_MAX, duration / ETHD__TRACK_PERIOD);
  ethd__track t = {count, room_for(count, sizeof *t.in), room_for(count, sizeof *t.truth)};
  uint64_t number = seed << 24;
  double next = draw(number++, 0, 1 / RATE);
  for (size_t k = 0; k < count; k++) {
    double now = (double)(k + 1) * ETHD__TRACK_PERIOD;
    ethd_vec truth = at(path, now);
    t.truth[k][0] = truth.x;
    t.truth[k][1] = truth.y;
    t.in[k][0] = t.in[k][1] = t.in[k][2] = (double)NAN;
    if (next + latency > now) continue;
    ethd_vec x = at(path, next);
    t.in[k][0] = x.x + ETHD__TRACK_NOISE * draw_normal(number++);
    t.in[k][1] = x.y + ETHD__TRACK_NOISE * draw_normal(number++);
    t.in[k][2] = now - next;
    next += 1 / RATE;
  }
  return t;
}

/* ---- reaches ---- */

typedef struct reach {
  double length, duration, angle;
} reach;

/* Returns the place on a reach: s = 10 u^3 - 15 u^4 + 6 u^5, whose top speed is 15/8 length / duration. */
static ethd_vec reach_at(const void *path, double t) {
  const reach *r = path;
  double u = fmin(1, fmax(0, (t - REST) / r->duration)), s = r->length * u * u * u * (10 - u * (15 - 6 * u));
  return (ethd_vec){s * cos(r->angle), s * sin(r->angle)};
}

ethd__tracks ethd__tracks_reaches(size_t count, double latency) {
  ethd__tracks set = {room_for(count, sizeof *set.at), count};
  for (uint64_t i = 0; i < count; i++) {
    double speed = draw(3 * i, 0.5, 1.1), length = draw(3 * i + 1, 0.1, 0.3);
    reach r = {length, 1.875 * length / speed, draw(3 * i + 2, 0, 2 * M_PI)};
    set.at[i] = read_path(reach_at, &r, r.duration + 2 * REST, latency, i + 1);
  }
  return set;
}

/* ---- recorded movements ---- */

static ethd_vec recorded_at(const void *path, double t) {
  ethd_vec x, v;
  ethd_path_at(path, t, &x, &v);
  return x;
}

/* Adds a file's movement; returns 0 if the file holds none. */
static int add_file(const char *file, double latency, uint64_t seed, ethd__tracks *set) {
  static const char *const wanted[] = {"t_s", "x_m", "y_m", NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd_csv csv;
  if (ethd_csv_read_columns(file, wanted, &csv, message) < 0) ethd__fail(ETHD_EXIT_INPUT, "%s", message);
  int t = ethd_csv_column(&csv, "t_s"), x = ethd_csv_column(&csv, "x_m"), y = ethd_csv_column(&csv, "y_m");
  int usable = t >= 0 && x >= 0 && y >= 0 && csv.rows >= 20;
  if (usable) {
    ethd_path_sample *samples = room_for(csv.rows, sizeof *samples);
    const double *v = csv.values;
    for (size_t i = 0; i < csv.rows; i++, v += csv.columns)
      samples[i] = (ethd_path_sample){v[t] - csv.values[t], v[x], v[y]};
    ethd_path path = {.samples = samples, .sample_count = csv.rows};
    set->at[set->count++] = read_path(recorded_at, &path, samples[csv.rows - 1].t, latency, seed);
    free(samples);
  }
  ethd_csv_free(&csv);
  return usable;
}

static ethd__tracks read_folder(const char *folder, double latency, uint64_t *seed) {
  ethd__tracks set = {NULL, 0};
  char pattern[4096];
  glob_t found;
  snprintf(pattern, sizeof pattern, "%s*.csv", folder);
  if (glob(pattern, 0, NULL, &found) != 0) return set;
  set.at = room_for(found.gl_pathc, sizeof *set.at);
  for (size_t i = 0; i < found.gl_pathc; i++) *seed += (uint64_t)add_file(found.gl_pathv[i], latency, *seed, &set);
  globfree(&found);
  return set;
}

size_t ethd__tracks_recorded(double latency, ethd__tracks *out, size_t room) {
  char *root = ethd__motion_folder();
  char pattern[4096];
  glob_t folders;
  size_t sets = 0;
  uint64_t seed = 1000;
  snprintf(pattern, sizeof pattern, "%s/*/", root);
  free(root);
  if (glob(pattern, 0, NULL, &folders) != 0) return 0;
  for (size_t i = 0; i < folders.gl_pathc && sets < room; i++) {
    ethd__tracks set = read_folder(folders.gl_pathv[i], latency, &seed);
    if (!set.count) {
      free(set.at);
      continue;
    }
    out[sets++] = set;
  }
  globfree(&folders);
  return sets;
}

void ethd__tracks_free(ethd__tracks *tracks) {
  for (size_t i = 0; i < tracks->count; i++) {
    free(tracks->at[i].in);
    free(tracks->at[i].truth);
  }
  free(tracks->at);
}
