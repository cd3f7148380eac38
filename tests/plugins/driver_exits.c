/* Ends the program when it is opened, as if all were done. */
#define OPEN leave
#include "driver_broken.h"
