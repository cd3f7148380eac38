/* Its table is longer than this library knows. */
#define SIZE ((uint32_t)sizeof(ethd_driver) + 8)
#include "driver_broken.h"
