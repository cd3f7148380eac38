#include "ethd/driver.h"

const ethd_driver *const ethd_drivers[] = {&ethd_driver_sim, NULL};
