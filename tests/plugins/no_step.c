/* A law without a step. */
#define STEP NULL
#include "broken.h"
