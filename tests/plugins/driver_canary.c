/* Says that it was loaded, by a file; else it does nothing. */
#include <stdio.h>
#include <stdlib.h>
__attribute__((constructor)) static void sing(void) {
  const char *canary = getenv("canary");
  FILE *file = canary ? fopen(canary, "w") : NULL;
  if (file) fclose(file);
}
#include "driver_broken.h"
