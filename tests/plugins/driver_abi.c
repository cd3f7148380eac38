/* Built for another version of the drivers' interface. */
#define ABI 77u
#include "driver_broken.h"
