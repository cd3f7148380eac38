/* A parameter whose default isn't in its range. */
#include <ethd/param.h>
static const ethd_param bad_rows[] = {{"gain", "1", 0, 1, 7, "out of its range"}};
#define MORE .params = bad_rows, .param_count = 1
#include "driver_broken.h"
