/* An id that could be a path or a second key. */
#define ID "../broken driver"
#include "driver_broken.h"
