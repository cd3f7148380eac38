/* Its brief has a second line. */
#define BRIEF "one\nethd-laws: all is well"
#include "broken.h"
