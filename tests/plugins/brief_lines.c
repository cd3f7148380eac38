/* Its brief has a second line. */
#define BRIEF "one\nethd-check: all is well"
#include "broken.h"
