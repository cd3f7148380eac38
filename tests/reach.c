/* A hand reaches through the wall of a configuration of space, before its device, on a virtual clock: reach CONFIG. A headset
   sees it, at 72 Hz, 30 ms late and 1 mm off. The device's first six figures say where its plate really is, and how fast. A
   line for each reach: its greatest speed, its slant from the wall's normal, and where the plate is when the finger comes
   to it, and its speed, both along the normal. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "arm/finger.h"
#include "ethd/config.h"
#include "ethd/loop.h"

static ethd__arm_finger finger;
static char message[ETHD_MESSAGE_MAX];

static ethd_status open_hand(const ethd_device_def *def, void **device, char *why) {
  (void)def, (void)why;
  return *device = &finger, ETHD_OK;
}

static ethd_status start_hand(void *device) { return ((ethd__arm_finger *)device)->given = 0, ETHD_OK; }

static ethd_status read_hand(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  return ethd__arm_finger_read(device, now_ns, out), ETHD_OK;
}

static void close_hand(void *device) { (void)device; }

static const ethd_driver hand = {.size = sizeof hand,
                                 .abi = ETHD_DRIVER_ABI,
                                 .id = "hand",
                                 .brief = "a hand",
                                 .open = open_hand,
                                 .start = start_hand,
                                 .close = close_hand,
                                 .read_space = read_hand};

static void need(ethd_status status) {
  if (status == ETHD_OK) return;
  fprintf(stderr, "reach: %s: %s\n", ethd_status_sentence(status), message);
  _Exit(1);
}

static uint32_t near_solids(void *solids, const ethd_space_sense *sense, ethd_surface *out) ETHD_RT {
  return (uint32_t)ethd_solids_surfaces(solids, NULL, ethd_vec3_of(sense->x), 1, out, ETHD_SURFACES_MAX);
}

static void plate_of(const ethd_device *device, ethd_vec3 *x, ethd_vec3 *v) {
  ethd_figure is[6];
  if (ethd_device_figures(device, is, 6) != 6) need(ETHD_E_DEVICE);
  *x = (ethd_vec3){is[0].value, is[1].value, is[2].value};
  *v = (ethd_vec3){is[3].value, is[4].value, is[5].value};
}

/* Puts the finger before the wall that is beyond the plate, at rest until the reach; returns the wall's normal. */
static ethd_vec3 put_finger(const ethd_config *config, ethd_vec3 plate, double speed, double slant) {
  ethd_space_sense at = {0};
  ethd_surface wall[ETHD_SURFACES_MAX];
  ethd_vec3_put(plate, at.x);
  if (near_solids(config->solids, &at, wall) != 1) need(ETHD_E_RANGE);
  const ethd_vec3 n = wall[0].n, meet = ethd_vec3_sub(wall[0].point, ethd_vec3_scale(config->space.finger_radius, n));
  ethd__arm_finger f = ethd__arm_finger_at(meet, n);
  f.n = ethd_vec3_add(ethd_vec3_scale(cos(slant), n), ethd_vec3_scale(sin(slant), f.across));
  f.path = (ethd_path){.from = {0.2, 0}, .to_x = -0.08, .speed = speed, .profile = ETHD_PROFILE_MINIMUM_JERK};
  f.begin = 1.5;
  f.rate = 72;
  f.latency = 0.03;
  f.noise = 1e-3;
  f.seed = 1 + (uint64_t)(1000 * speed);
  finger = f;
  return n;
}

static void reach(const ethd_config *config, double speed, double slant) {
  ethd_device_def def = {.settings = config->settings,
                         .setting_count = config->setting_count,
                         .folder = config->folder,
                         .file = config->path,
                         .is_virtual = 1,
                         .space = &config->space};
  const ethd_driver *const drivers[] = {&hand, NULL};
  ethd_device *device;
  ethd_space *space;
  ethd_loop *loop;
  ethd_space_row row;
  ethd_vec3 plate, v, at, at_v;
  const int64_t period = (int64_t)rint(1e9 * config->space.period);
  int64_t clock = -period;
  need(ethd_device_open(config->device, drivers, &def, &device, message));
  need(ethd_space_create(&config->space, &space, NULL));
  ethd_loop_def with = ethd_loop_default();
  with.device = device, with.space = space, with.period = config->space.period, with.clock = &clock;
  with.surfaces = near_solids, with.surfaces_of = config->solids;
  need(ethd_loop_create(&with, &loop, NULL));
  need(ethd_device_start(device));
  plate_of(device, &plate, &v);
  const ethd_vec3 n = put_finger(config, plate, speed, slant), wall = finger.meet;
  need(ethd_loop_start(loop, NULL));
  for (double t = 0; t < 4; t = 1e-9 * (double)(clock + period)) {
    ethd_loop_tick(loop);
    need(ethd_loop_take_space(loop, &row));
    if (row.trace.fault || !row.armed) {
      printf("%s at %.3f s\n", ethd_fault_sentence((ethd_fault)row.trace.fault), t);
      break;
    }
    plate_of(device, &plate, &v);
    ethd__arm_finger_true(&finger, 1e-9 * (double)(clock + period), &at, &at_v);
    if (ethd_vec3_dot(n, ethd_vec3_sub(plate, at)) > config->space.finger_radius) continue;
    printf("%.2f m/s at %.2f rad: %.3f mm beyond the wall, plate %.2f mm/s\n", speed, slant,
           1e3 * (ethd_vec3_dot(n, ethd_vec3_sub(plate, wall)) - config->space.finger_radius),
           1e3 * ethd_vec3_dot(n, v));
    break;
  }
  ethd_loop_destroy(loop);
  ethd_space_destroy(space);
  ethd_device_close(device);
}

int main(int argc, char **argv) {
  ethd_config *config;
  if (argc != 2) return 2;
  need(ethd_config_load(argv[1], &config, message));
  for (int i = 0; i < 5; i++) reach(config, 0.3 + 0.1 * i, 0.15 * i);
  ethd_config_free(config);
  return 0;
}
