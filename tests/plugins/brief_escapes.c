/* Its brief would clear a terminal. */
#define BRIEF "\033[2Jgone"
#include "broken.h"
