/* A wall: the controller without any device, tick by tick.

     cc wall.c $(pkg-config --cflags --libs ethd) -o wall && ./wall */
#include <ethd/ethd.h>
#include <stdio.h>

int main(void) {
  const char wall[] = "halfplane -1 0 -0.238"; /* everything left of x = 0.238 m */
  ethd_setup setup = ethd_setup_default();
  ethd_scene *scene;
  ethd_control *control;
  ethd_command command;
  ethd_trace trace;
  if (ethd_scene_parse(wall, sizeof wall - 1, &scene, NULL) < 0) return 1;
  setup.scene = scene;
  if (ethd_control_create(&setup, &control, NULL) < 0) return 1;
  for (int tick = 0; tick < 80; tick++) { /* ring and finger move into the wall at 0.2 m/s */
    ethd_vec ring = {0.2524 - 0.0002 * tick, 0.25};
    ethd_sense sense = {.have = ETHD_HAVE_FINGER, .finger = {ring.x - 0.001, ring.y}, .finger_v = {-0.2, 0}};
    if (ethd_arm_angles(&setup.arm, ring, -1, sense.q) < 0) return 1;
    if (ethd_control_step(control, &sense, &command, &trace) < 0) return 1;
    printf("%7.4f m to the wall: brakes with %5.2f N, pushes with %5.2f N, torque %6.3f Nm\n", trace.d_re, trace.fd[0],
           trace.fe[0], command.torque[0]);
  }
  ethd_control_destroy(control);
  ethd_scene_destroy(scene);
}
