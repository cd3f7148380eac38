/* Nothing opens it. */
#define OPEN NULL
#include "driver_broken.h"
