/* The same law twice. */
#define LAWS 2
#include "broken.h"
