/* A simulated cap over a fingertip: 32 rays, with noise, show where the finger is; a sphere is fitted to them; an arm that
   is 8 ms late brings the cap, which stands in an oblique wall when the finger comes. At the end the finger leaves over
   the rim, and the cap stops.
     cc cap.c -o cap $(pkg-config --cflags --libs ethd) -lm && ./cap */
#include <ethd/ethd.h>
#include <math.h>
#include <stdio.h>

#define R_R 0.020 /* m: inner radius of the cap, and of the finger */
#define R_F 0.008
#define LATE 8 /* ticks of 1 ms */

/* Returns a number of sd 1 (the sum of twelve uniform ones), the same in every run. */
static double noise(void) {
  static uint32_t seed = 1;
  double sum = -6;
  for (int i = 0; i < 12; i++) sum += (seed = 1664525 * seed + 1013904223) / 4294967296.0;
  return sum;
}

/* A half sphere, open against the axis, here z: rays from its inside to its centre. */
static ethd_cap half_sphere(void) {
  const int rings[] = {1, 5, 11, 15};
  ethd_cap cap = {.finger_radius = R_F, .reach = 0.05, .gate = 1e-3, .rim = {0, 0, -0.004}, .out = {0, 0, -1}};
  for (int ring = 0; ring < 4; ring++)
    for (int i = 0; i < rings[ring]; i++) {
      const double polar = 0.5 * ring, turn = 6.283185307179586 * i / rings[ring];
      const ethd_vec3 up = {sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)};
      cap.rays[cap.count++] = (ethd_cap_ray){ethd_vec3_scale(R_R, up), ethd_vec3_scale(-1, up)};
    }
  return cap;
}

/* Goes to the wall at 0.25 m/s, rests there, and from 1.3 s on leaves the cap. */
static ethd_vec3 finger_at(double t) {
  const double way = fmin(0.25 * t, 0.244), back = 10 * pow(fmax(t - 1.3, 0), 2);
  return (ethd_vec3){0.4 * way, 0, 0.9165 * way - back};
}

int main(void) {
  const char wall[] = "halfspace 0.28 0 0.96 0.25"; /* everything beyond the plane 0.28 x + 0.96 z = 0.25 m */
  const ethd_vec3 n = {0.28, 0, 0.96};
  const ethd_cap cap = half_sphere();
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_solids *solids;
  ethd_space *space;
  ethd_vec3 at[LATE + 1] = {{0, 0, 0}}, v = {0, 0, 0}; /* commanded places, the newest first */
  setup.effector = ETHD_EFFECTOR_CAP;
  setup.radius = R_R;
  setup.finger_radius = setup.finger_radius_max = R_F;
  setup.acceleration = 20;
  setup.ability.delay = 0.001 * LATE;
  if (ethd_cap_check(&cap, NULL) < 0 || ethd_solids_parse(wall, sizeof wall - 1, &solids, NULL) < 0) return 1;
  if (ethd_space_create(&setup, &space, NULL) < 0) return 1;
  for (int tick = 0; tick < 1500; tick++) {
    const ethd_vec3 real = at[LATE], finger = finger_at(0.001 * tick);
    ethd_space_sense sense = {.time_ns = 1000000LL * tick, .have = ETHD_SPACE_HAVE_NORMAL, .normal = {0, 0, 1}};
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_surface near[8];
    ethd_cap_finger found;
    double r[ETHD_CAP_RAYS_MAX];
    const size_t count = ethd_solids_surfaces(solids, NULL, at[0], 1, near, 8);
    ethd_cap_rays(&cap, ethd_vec3_sub(finger, real), R_F, r);
    for (uint32_t k = 0; k < cap.count; k++) r[k] += 5e-5 * noise();
    if (ethd_cap_step(&cap, r, &found) == ETHD_OK) {
      sense.have |= ETHD_SPACE_HAVE_READING;
      sense.sample_ns = sense.time_ns;
      ethd_vec3_put(ethd_vec3_add(real, found.centre), sense.reading);
      if (found.gone) sense.faults = ETHD_FAULT_BIT(ETHD_FAULT_FINGER_OUT);
    }
    ethd_vec3_put(at[0], sense.x);
    ethd_vec3_put(v, sense.v);
    (void)!ethd_space_step(space, &sense, near, (uint32_t)count, &command, &trace);
    v = ethd_vec3_of(command.value);
    for (int i = LATE; i > 0; i--) at[i] = at[i - 1];
    at[0] = ethd_vec3_add(at[0], ethd_vec3_scale(0.001, v));
    if (tick % 50 == 49)
      printf("%4d ms: cap %8.4f m from the wall, finger %7.4f m from its inside; state %d, %s\n", tick + 1,
             0.25 - ethd_vec3_dot(n, real) - R_R, R_R - R_F - ethd_vec3_norm(ethd_vec3_sub(finger, real)),
             (int)trace.state, ethd_fault_sentence((ethd_fault)trace.fault));
  }
  ethd_space_destroy(space);
  ethd_solids_destroy(solids);
}
