#include <stddef.h>

#include "control/setup.h"

#define AT(member) (uint32_t)offsetof(ethd_setup, member)

const ethd__setup_field ethd__setup_fields[ETHD__SETUP_FIELDS] = {
    {{"arm",
      {"mechanism", "parallel|serial", 0, 1, ETHD_ARM_PARALLEL,
       "parallel: q2 is measured from the base frame; serial: from link 1"},
      1},
     AT(arm.mechanism)},
    {{"arm", {"link1", "m", ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX, 0.25, "length from the base to the elbow"}, 1},
     AT(arm.link1)},
    {{"arm",
      {"link2", "m", ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX, 0.25, "length from the elbow to the ring's centre"},
      1},
     AT(arm.link2)},
    {{"arm",
      {"mass_x", "kg", 1e-9, 1e6, (double)NAN, "effective mass of joint 1 at the ring; not given: not known"},
      1},
     AT(dynamics.mass[0])},
    {{"arm",
      {"mass_y", "kg", 1e-9, 1e6, (double)NAN, "effective mass of joint 2 at the ring; not given: not known"},
      1},
     AT(dynamics.mass[1])},
    {{"arm", {"friction", "N", 0, 1e6, (double)NAN, "Coulomb friction of each joint, at the ring"}, 1},
     AT(dynamics.friction)},
    {{"arm", {"viscous", "Ns/m", 0, 1e6, (double)NAN, "viscous friction of each joint, at the ring"}, 1},
     AT(dynamics.viscous)},
    {{"arm", {"delay", "s", 0, 0.1, (double)NAN, "time from a joint sample to its torque"}, 1}, AT(dynamics.delay)},
    {{"loop", {"period", "s", 1e-5, 0.1, 0.001, "time between two ticks, T"}, 1}, AT(period)},
    {{"ring", {"radius", "m", 1e-4, 1, 0.012, "inner radius of the ring, R_r"}, 1}, AT(ring_radius)},
    {{"finger", {"radius", "m", 1e-4, 1, 0.0075, "radius of the finger, R_f"}, 1}, AT(finger_radius)},
    {{"finger", {"radius_max", "m", 1e-5, 1, 0.0095, "largest radius of a finger, R_f,max"}, 1}, AT(finger_radius_max)},
    {{"finger_fit", {"lag", "s", -0.01, 0.01, 0, "a time in s for each of the 16 rays"}, ETHD_RAYS}, AT(ray_lag)},
    {{"transition", {"swap_time", "s", 0, 1, 0.020, "time over which a change of laws fades"}, 1}, AT(swap_time)},
    {{"transition", {"v_hysteresis", "m/s", 0, 1, 0, "leaving begins at v < -v_hysteresis, entering at v > it"}, 1},
     AT(v_hysteresis)},
};

double ethd__setup_field_get(const void *setup, const ethd__setup_field *field, uint32_t index) {
  if (field->offset == AT(arm.mechanism)) return ((const ethd_setup *)setup)->arm.mechanism;
  return ((const double *)(const void *)((const char *)setup + field->offset))[index];
}

void ethd__setup_field_set(void *setup, const ethd__setup_field *field, uint32_t index, double value) {
  if (field->offset == AT(arm.mechanism))
    ((ethd_setup *)setup)->arm.mechanism = (ethd_mechanism)value;
  else
    ((double *)(void *)((char *)setup + field->offset))[index] = value;
}
