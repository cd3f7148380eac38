/* Nothing offered. */
#define LAWS 0
#include "broken.h"
