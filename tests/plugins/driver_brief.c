/* A brief that would steer a terminal. */
#define BRIEF "\033[2Jgone"
#include "driver_broken.h"
