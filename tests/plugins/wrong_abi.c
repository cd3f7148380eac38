/* Built for an ABI that doesn't exist yet. */
#define ABI (ETHD_ABI + 1)
#include "broken.h"
