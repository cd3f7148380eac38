/* A default that its own row forbids. */
#include <ethd/param.h>
static const ethd_param params[] = {{"gain", "1", 0, 1, 2, "more than it may be"}};
#define PARAMS params
#define PARAM_COUNT 1
#include "broken.h"
