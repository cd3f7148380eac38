/* Records taps of an effector in space in a room of solids, with swaps between them: space_tap CONFIG FOLDER. The finger
   goes to and fro; the effector is where it was told to be. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "denormals.h"
#include "ethd/record.h"

#define TICKS 4000

static char message[ETHD_MESSAGE_MAX];

static void need(ethd_status status) {
  if (status == ETHD_OK) return;
  fprintf(stderr, "space_tap: %s: %s\n", ethd_status_sentence(status), message);
  _Exit(1);
}

int main(int argc, char **argv) {
  ethd_config *config;
  ethd_recording *recording;
  ethd_space *space;
  ethd_error error;
  if (argc != 3) return 2;
  (void)ethd__denormals_flush();
  need(ethd_config_load(argv[1], &config, message));
  need(ethd_recording_create(argv[2], config, true, &recording, message));
  ethd_space_setup setup = config->space;
  need(ethd_space_create(&setup, &space, &error));
  ethd_vec3 at = {0.3, 0, 0.3}, v = {0, 0, 0};
  for (int64_t tick = 0; tick < TICKS; tick++) {
    const double t = (double)tick * setup.period;
    ethd_space_sense sense = {.time_ns = tick * (int64_t)(1e9 * setup.period), .have = ETHD_SPACE_HAVE_FINGER};
    ethd_surface near[8];
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_event event;
    if (tick == TICKS / 2) {
      need(ethd_recording_event(recording, "set", "transition.effort 0.7"));
      need(ethd_config_space_set(config, "transition.effort", "0.7", &setup, message));
      need(ethd_space_post(space, &setup, &error));
    }
    const size_t count = ethd_solids_surfaces(config->solids, NULL, at, 0.5, near, 8);
    ethd_vec3_put(at, sense.x);
    ethd_vec3_put(v, sense.v);
    ethd_vec3_put((ethd_vec3){0.3 + 0.2 * sin(3 * t), 0.1 * t, 0.25 + 0.1 * cos(5 * t)}, sense.finger);
    ethd_vec3_put((ethd_vec3){0.6 * cos(3 * t), 0.1, -0.5 * sin(5 * t)}, sense.finger_v);
    memset(&trace, 0, sizeof trace);
    (void)ethd_space_step(space, &sense, near, (uint32_t)count, &command, &trace);
    while (ethd_space_poll(space, &event) == ETHD_OK) continue;
    need(ethd_recording_tick_space(recording, &trace));
    v = ethd_vec3_of(command.value);
    at = ethd_vec3_add(at, ethd_vec3_scale(setup.period, v));
  }
  need(ethd_recording_close(recording, message));
  ethd_space_destroy(space);
  ethd_config_free(config);
  return 0;
}
