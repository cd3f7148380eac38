/* Every recorded movement under every law, closed loop: the simulated hand follows it, touches where it should, and nothing
   is at fault. The laws' numbers: tests/replay.py. The folder is ETHD_MOTION_DIR, tests/motion without. */
#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "tap/study.h"
#include "unit/suite.h"

static const char *const laws[] = {"abrupt", "smooth", "offset"};
static const char *const words[] = {"low", "high"};

/* ---- the file, read anew ---- */

typedef struct recording {
  double (*at)[3]; /* t, x, y */
  size_t count;
} recording;

static recording read_recording(const char *path) {
  recording r = {NULL, 0};
  char line[256];
  FILE *file = fopen(path, "r");
  ck_assert_ptr_nonnull(file);
  ck_assert_ptr_nonnull(fgets(line, sizeof line, file));
  ck_assert_msg(!strncmp(line, "t_s,x_m,y_m", 11), "%s: %s", path, line);
  while (fgets(line, sizeof line, file)) {
    r.at = realloc(r.at, (r.count + 1) * sizeof *r.at);
    double *p = r.at[r.count++];
    if (sscanf(line, "%lf,%lf,%lf", &p[0], &p[1], &p[2]) != 3) ck_abort_msg("%s: %s", path, line);
  }
  fclose(file);
  return r;
}

/* ---- the path that was driven is the one that was read ---- */

static int within_reach(double x, double y) { return sqrt(x * x + y * y) < 0.5; }

/* Samples of the recording that can be reached around the touchdown. */
static void reachable(const recording *r, const double shift[2], double t, size_t *begin, size_t *end) {
  *begin = 0;
  *end = r->count;
  for (size_t i = 0; i < r->count; i++) {
    if (within_reach(r->at[i][1] + shift[0], r->at[i][2] + shift[1])) continue;
    if (r->at[i][0] - r->at[0][0] <= t) *begin = i + 1;
    if (r->at[i][0] - r->at[0][0] > t && *end == r->count) *end = i;
  }
}

/* Slope times h of the parabola through sample i and its neighbours; 0 at the ends. */
static double tangent(const recording *r, size_t begin, size_t end, size_t i, int c, double h) {
  if (i == begin || i + 1 == end) return 0;
  const double *p = r->at[i - 1], *q = r->at[i], *s = r->at[i + 1];
  double a = q[0] - p[0], b = s[0] - q[0];
  return h * ((q[c] - p[c]) / a * b + (s[c] - q[c]) / b * a) / (a + b);
}

/* A cubic leaves the chord by at most a quarter of what its end slopes differ from the chord's. */
static void assert_on_path(const recording *r, size_t begin, size_t end, size_t i, double t, const double shift[2],
                           const double hand[2], const char *where) {
  for (int c = 1; c <= 2; c++) {
    double from = r->at[i][c], to = from, h = 1, s = 0, bound = 0;
    if (i + 1 < end) {
      to = r->at[i + 1][c];
      h = r->at[i + 1][0] - r->at[i][0];
      s = (t - r->at[i][0]) / h;
      bound = fmax(fabs(tangent(r, begin, end, i, c, h) - (to - from)),
                   fabs(tangent(r, begin, end, i + 1, c, h) - (to - from))) /
              4;
    }
    if (fabs(s) < 1e-6) bound = 0; /* at a sample, exactly */
    double expected = from + s * (to - from) + shift[c - 1];
    if (!(fabs(hand[c - 1] - expected) <= bound + 1e-9))
      ck_abort_msg("%s: t = %g: the hand is at %.9g, not %.9g", where, t, hand[c - 1], expected);
  }
}

static void assert_path(const recording *r, const ethd__tap_rows *rows, const ethd__touchdown *touchdown,
                        const char *where) {
  const double shift[2] = {0.25 - touchdown->x.x, 0.25 - touchdown->x.y};
  size_t begin, end;
  reachable(r, shift, touchdown->t, &begin, &end);
  size_t i = begin;
  for (size_t k = 0; k < rows->count; k++) {
    double t = rows->truth[k].t + r->at[begin][0];
    while (i + 1 < end && r->at[i + 1][0] <= t + 1e-9) i++;
    assert_on_path(r, begin, end, i, t, shift, rows->truth[k].hand, where);
  }
}

/* ---- where it touches ---- */

/* The chord's speed at the touchdown and on either side brackets the wanted one; never that fast: nowhere
   faster than it by more than a sample's noise allows. */
static void assert_touchdown(const recording *r, const ethd__speed *speed, const char *where) {
  const ethd__touchdown *d = &speed->touchdown;
  double fastest = -INFINITY, low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i + 1 < r->count; i++) {
    double a = r->at[i][0] - r->at[0][0], b = r->at[i + 1][0] - r->at[0][0];
    double v = -(r->at[i + 1][1] - r->at[i][1]) / (b - a);
    fastest = fmax(fastest, v);
    if (b < d->t - 21e-3 || a > d->t + 21e-3) continue;
    low = fmin(low, v);
    high = fmax(high, v);
  }
  if (d->never_fast)
    ck_assert_msg(high >= 0.9 * fastest && fastest < speed->centre + 0.05, "%s: touches at %g m/s of %g", where, high,
                  fastest);
  else if (d->t < r->at[r->count - 1][0] - r->at[0][0])
    ck_assert_msg(low <= speed->centre && speed->centre <= high && fastest >= speed->centre,
                  "%s: touches at %g to %g m/s", where, low, high);
}

/* ---- all ---- */

static void run_file(ethd__study *study, const ethd_plant *plant, const char *path,
                     size_t reasons[ETHD_TAP_REASON_COUNT]) {
  char message[ETHD_MESSAGE_MAX], where[512];
  recording r = read_recording(path);
  ck_assert_msg(!ethd__movement_load(path, &ethd__movement_si, &study->movement, message), "%s", message);
  ck_assert_msg(!ethd__study_prepare(study, message), "%s", message);
  for (int l = 0; l < 3; l++) {
    ethd__stage stage;
    ck_assert_msg(!ethd__stage_open(study, laws[l], &stage, message), "%s", message);
    for (size_t s = 0; s < study->speed_count; s++) {
      ethd__result result;
      ethd_sim_tap tap;
      snprintf(where, sizeof where, "%s %s %s", strrchr(path, '/') + 1, laws[l], words[s]);
      ck_assert_msg(!ethd__stage_run(&stage, &study->speeds[s], s, &result, message), "%s: %s", where, message);
      ethd_sim_draw(plant, study->seed, s, 0.3, study->meet, &tap);
      reasons[result.metrics.reason]++;
      if (!l) assert_touchdown(&r, &study->speeds[s], where);
      assert_path(&r, &stage.rows, &study->speeds[s].touchdown, where);
      for (size_t k = 0; k < stage.rows.count; k++)
        if (stage.rows.trace[k].fault) ck_abort_msg("%s: tick %zu: %d", where, k, (int)stage.rows.trace[k].fault);
    }
    ethd__stage_close(&stage);
  }
  ethd__movement_free(&study->movement);
  free(r.at);
}

TEST(test_every_movement_and_law) {
  const char *folder = getenv("ETHD_MOTION_DIR"), *sanitizer = getenv("SAN");
  const size_t stride = sanitizer && *sanitizer ? 12 : 1; /* of files: sanitizers are slow */
  glob_t files;
  char pattern[4096];
  snprintf(pattern, sizeof pattern, "%s/*/*.csv", folder && *folder ? folder : "tests/motion");
  ck_assert_msg(glob(pattern, 0, NULL, &files) == 0, "no recorded movements: %s", pattern);
  char message[ETHD_MESSAGE_MAX], *plant = ethd__data_path("n.plant"), *ini = ethd__data_path("n.ini");
  ethd_config *config;
  ethd__study study = {.seed = 7, .speed_count = 2};
  ethd__speed speeds[2];
  size_t reasons[ETHD_TAP_REASON_COUNT] = {0}, count = 0;
  ethd__flush_denormals();
  ck_assert_msg(!ethd_plant_load(plant, &study.plant, message), "%s", message);
  ck_assert_msg(!ethd_config_load(ini, &config, message), "%s", message);
  study.config = config;
  study.speeds = speeds;
  for (int s = 0; s < 2; s++) ck_assert(ethd__speed_parse(words[s], &study.plant, &speeds[s]));
  for (size_t i = 0; i < files.gl_pathc; i += stride, count++)
    run_file(&study, &study.plant, files.gl_pathv[i], reasons);
  printf("%zu movements, 3 laws, 2 speeds:", count);
  for (int i = 0; i < ETHD_TAP_REASON_COUNT; i++) printf(" %s %zu", ethd__reason_words[i], reasons[i]);
  printf("\n");
  fflush(stdout);
  globfree(&files);
  ethd_config_free(config);
  free(plant);
  free(ini);
}
