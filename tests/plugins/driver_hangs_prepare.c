/* Its prepare, which a check calls without touching the device, never returns. */
#define MORE .prepare = hang
#include "driver_broken.h"
