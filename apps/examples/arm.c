/* An arm in space, as its configuration says, in a loop of its own thread for some seconds:
     cc arm.c -o arm $(pkg-config --cflags --libs ethd-drivers) -lm && ./arm arm.ini 5
   With -DMESH a mesh takes the place of the configuration's solids (mesh.h, which lies beside this file):
     cc -DMESH arm.c ... $(pkg-config --cflags --libs assimp) -lembree4 && ./arm arm.ini 5 FILE */
#include <ethd/config.h>
#include <ethd/loop.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define RANGE 0.5 /* m: no surface that is farther matters to this arm */
#ifdef MESH
#include "mesh.h"
static uint32_t near_world(void *world, const ethd_space_sense *sense, ethd_surface *out) ETHD_RT {
  return surfaces_near(world, ethd_vec3_of(sense->x), RANGE, out, ETHD_SURFACES_MAX);
}
#else
static uint32_t near_world(void *solids, const ethd_space_sense *sense, ethd_surface *out) ETHD_RT {
  const size_t count = ethd_solids_surfaces(solids, NULL, ethd_vec3_of(sense->x), RANGE, out, ETHD_SURFACES_MAX);
  return (uint32_t)(count < ETHD_SURFACES_MAX ? count : ETHD_SURFACES_MAX);
}
#endif

static int fail(const char *message) { return fprintf(stderr, "arm: %s\n", message), 1; }

static void print(const ethd_space_row *row) {
  const ethd_space_trace *t = &row->trace;
  printf("%8.3f s  x %7.4f %7.4f %7.4f m  %8.5f m to the wall  %6.3f m/s  finger %7.4f m to it  %s, %s\n",
         1e-9 * (double)t->sense.time_ns, t->sense.x[0], t->sense.x[1], t->sense.x[2], t->d_re, t->v_n, t->d_fe,
         row->armed ? "armed" : "disarmed", ethd_fault_sentence((ethd_fault)t->fault));
}

int main(int argc, char **argv) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_error error = {0};
  ethd_config *config;
  ethd_device *device;
  ethd_space *space;
  ethd_loop *loop;
  ethd_space_row row;
#ifdef MESH
  mesh world;
  if (argc != 4 || !load(argv[3], &world)) return fail("usage: arm CONFIG SECONDS MESH"), 2;
#else
  if (argc != 3) return fail("usage: arm CONFIG SECONDS"), 2;
#endif
  if (ethd_config_load(argv[1], &config, message)) return fail(message);
  if (!config->is_space) return fail("the configuration has no section [space]");
  ethd_space_setup *setup = &config->space;
  const ethd_device_def def = {.settings = config->settings,
                               .setting_count = config->setting_count,
                               .folder = config->folder,
                               .file = config->path,
                               .space = setup};
  if (ethd_device_open(config->device, NULL, &def, &device, message)) return fail(message);
  const ethd_limits limits = ethd_device_limits(device);
  ethd_space_narrow(setup, &limits);
  if (ethd_space_create(setup, &space, &error)) return ethd_error_text(argv[1], &error, message), fail(message);
  ethd_loop_def with = ethd_loop_default();
  with.device = device, with.space = space, with.period = setup->period, with.gap = setup->gap;
#ifdef MESH
  with.surfaces = near_world, with.surfaces_of = &world;
#else
  if (config->solids) with.surfaces = near_world, with.surfaces_of = config->solids;
#endif
  if (ethd_loop_create(&with, &loop, &error)) return ethd_error_text("the loop", &error, message), fail(message);
  if (ethd_device_start(device)) return fail("the device doesn't start");
  if (ethd_loop_start(loop, &error)) return ethd_error_text("the loop", &error, message), fail(message);
  int64_t shown = 0, fault = 0;
  for (double end = atof(argv[2]); (double)ethd_loop_periods(loop) * setup->period < end && !ethd_loop_ended(loop);) {
    usleep(20000);
    while (ethd_loop_take_space(loop, &row) == ETHD_OK) {
      if (row.trace.sense.time_ns - shown < 100000000 && row.trace.fault == fault) continue;
      print(&row);
      shown = row.trace.sense.time_ns, fault = row.trace.fault;
    }
  }
  ethd_loop_stop(loop);
  if (ethd_loop_join(loop)) return fail("the loop's thread hangs");
  ethd_loop_destroy(loop);
  (void)!ethd_device_stop(device);
  ethd_device_close(device);
  ethd_space_destroy(space);
  ethd_config_free(config);
}
