#include "ethd/driver.h"

const ethd_driver *const ethd_drivers[] = {&ethd_driver_sim,     &ethd_driver_replay, &ethd_driver_arm,
                                           &ethd_driver_counter, &ethd_driver_servo,  &ethd_driver_ring,
                                           &ethd_driver_zones,   &ethd_driver_nail,   &ethd_driver_camera,
                                           &ethd_driver_excite,  &ethd_driver_hello,  NULL};
