/* An end effector in space, under velocity commands: it follows a finger at 0.4 m/s and stands in the wall when the finger
   comes. An arm would carry out `command`, and say where it was told to be.
     cc space.c -o space $(pkg-config --cflags --libs ethd) && ./space */
#include <ethd/ethd.h>
#include <stdio.h>

int main(void) {
  const char wall[] = "halfspace 0.6 0 0.8 0.5"; /* everything beyond the plane 0.6 x + 0.8 z = 0.5 m */
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_solids *solids;
  ethd_space *space;
  ethd_space_command command = {0};
  ethd_space_trace trace;
  ethd_vec3 at = {0, 0, 0};
  setup.radius = 0.068; /* of a ring, 60 mm around a finger of 8 mm */
  setup.acceleration = 10;
  setup.ability.delay = 0.008;
  if (ethd_solids_parse(wall, sizeof wall - 1, &solids, NULL) < 0) return 1;
  if (ethd_space_create(&setup, &space, NULL) < 0) return 1;
  for (int tick = 0; tick < 1250; tick++) {
    ethd_space_sense sense = {.time_ns = 1000000LL * tick, .have = ETHD_SPACE_HAVE_FINGER, .finger_v = {0.24, 0, 0.32}};
    ethd_surface near[8];
    size_t count = ethd_solids_surfaces(solids, NULL, at, 1, near, 8);
    ethd_vec3_put(at, sense.x);
    ethd_vec3_put(ethd_vec3_of(command.value), sense.v);
    ethd_vec3_put((ethd_vec3){0.24e-3 * tick, 0, 0.32e-3 * tick}, sense.finger);
    if (ethd_space_step(space, &sense, near, (uint32_t)count, &command, &trace) < 0) return 1;
    at = ethd_vec3_add(at, ethd_vec3_scale(setup.period, ethd_vec3_of(command.value)));
    if (tick % 25 == 24) printf("%7.4f m to the wall: %6.3f m/s, state %d\n", trace.d_re, trace.v_n, (int)trace.state);
  }
  ethd_space_destroy(space);
  ethd_solids_destroy(solids);
}
