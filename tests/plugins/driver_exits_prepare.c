/* Ends the program when it is asked what it knows before it is opened. */
#define MORE .prepare = leave
#include "driver_broken.h"
