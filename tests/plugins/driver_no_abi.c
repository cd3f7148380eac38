/* A table whose abi nobody has set. */
#define ABI 0u
#include "driver_broken.h"
