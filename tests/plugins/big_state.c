/* One byte of state too many. */
#define STATE (ETHD_STATE_MAX + 1)
#include "broken.h"
