/* Its table ends before the first version's last field. */
#define SIZE 16u
#include "driver_broken.h"
