/* Its open never returns. */
#define OPEN hang
#include "driver_broken.h"
