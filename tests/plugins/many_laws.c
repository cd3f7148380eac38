/* More laws than may be. */
#define LAWS 65
#include "broken.h"
