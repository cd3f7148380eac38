/* An end effector in space follows a finger towards a mesh from a file and stands at its surface.
     cc mesh.c -o mesh $(pkg-config --cflags --libs ethd assimp) -lembree4 -lm && ./mesh FILE      (Debian 12: -lembree3) */
#include "mesh.h"

int main(int argc, char **argv) {
  mesh world;
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_space *space;
  ethd_vec3 at = {-0.3, 0, 0}, v = {0, 0, 0};
  setup.radius = 0.068, setup.acceleration = 10; /* a finger of 8 mm, 60 mm before the plate's face */
  if (argc != 2 || !load(argv[1], &world) || ethd_space_create(&setup, &space, NULL)) return 1;
  for (int tick = 0; tick < 1500; tick++) {
    ethd_space_sense sense = {.time_ns = 1000000LL * tick, .have = ETHD_SPACE_HAVE_FINGER};
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_surface near[16];
    const uint32_t count = surfaces_near(&world, at, 0.15, near, 16);
    ethd_vec3_put(at, sense.x), ethd_vec3_put(v, sense.v);
    ethd_vec3_put((ethd_vec3){-0.3 + 0.3e-3 * tick, 0, 0}, sense.finger);
    ethd_vec3_put((ethd_vec3){0.3, 0, 0}, sense.finger_v);
    if (ethd_space_step(space, &sense, near, count, &command, &trace) < 0) return 1;
    v = ethd_vec3_of(command.value);
    at = ethd_vec3_add(at, ethd_vec3_scale(setup.period, v));
    if (tick % 25 == 24)
      printf("%9.6f %9.6f %9.6f m: %8.5f m to the surface, %6.3f m/s\n", at.x, at.y, at.z, trace.d_re, trace.v_n);
  }
  ethd_space_destroy(space);
  rtcReleaseScene(world.scene), rtcReleaseDevice(world.device);
  aiReleaseImport(world.file);
}
