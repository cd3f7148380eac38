/* No id at all. */
#define ID NULL
#include "driver_broken.h"
