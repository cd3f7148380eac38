/* Ends the program that loads it, as if all were done. */
#include <ethd/plugin.h>
#include <stdlib.h>
__attribute__((constructor)) static void leave(void) { exit(0); }
#include "broken.h"
