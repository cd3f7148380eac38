#include "bench/identify_touches.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "identify/touch_fit.h"
#include "tap/load.h"
#include "tap/run.h"

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

/* Records taps as ethd-tap --transition offset does. */
static void record(const ethd__loaded *device, uint64_t taps, const char *folder) {
  static const char *const laws[] = {"offset"}, *const names[] = {"low", "high"};
  char message[ETHD_MESSAGE_MAX], left[ETHD_MESSAGE_MAX];
  ethd__speed speeds[2];
  ethd__output output;
  for (int i = 0; i < 2; i++) (void)ethd__speed_parse(names[i], &device->plant, &speeds[i]);
  ethd__study study = {.config = device->config, .plant = device->plant, .speeds = speeds, .speed_count = 2, .seed = 1};
  check(ethd__study_prepare(&study, message), message);
  const ethd__tap_plan plan = {&study, laws, 1, taps};
  ethd__cell *cells = ethd__cells_create(&plan);
  if (!cells) ethd__fail_memory();
  check(ethd__output_open(&(ethd__output_paths){NULL, folder, true}, study.config, &output, message), message);
  ethd_status status = ethd__cells_run(&plan, &output, cells, message), closed = ethd__output_close(&output, left);
  check(status, message);
  check(closed, left);
  ethd__cells_free(cells);
}

static char *inside(const char *folder, const char *name) {
  char *path;
  if (asprintf(&path, "%s/%s", folder, name) < 0) ethd__fail_memory();
  return path;
}

static void forget(const char *folder) {
  static const char *const files[] = {"config.ini", "events.csv", "scene.scene", "taps.csv", "tick.npy", "truth.npy"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    char *path = inside(folder, files[i]);
    (void)unlink(path);
    free(path);
  }
  (void)rmdir(folder);
}

double ethd__bench_touches(const char *plant, uint64_t taps, const char *folder, double *seconds, size_t *touches) {
  static ethd__fit fit;
  char message[ETHD_MESSAGE_MAX], *path = inside(folder, "identify-taps");
  ethd__evidence evidence = {0};
  ethd__sensing sensing;
  ethd__touch_fit found;
  ethd__loaded device;
  ethd__load(NULL, plant, true, false, &device);
  record(&device, taps, path);
  check(ethd__evidence_add(&evidence, path, message), message);
  check(ethd__sensing_find(&evidence, &sensing, message), message);
  forget(path);
  free(path);
  memset(&fit, 0, sizeof fit);
  fit.plant = device.plant;
  ethd__touch_fit_run(&evidence, &sensing, &fit, &found);
  ethd__evidence_free(&evidence);
  ethd__loaded_free(&device);
  *seconds = found.seconds;
  *touches = found.seen;
  return found.simulated / found.seconds;
}
