/* The entry under another name. */
#define ENTRY my_plugin
#include "broken.h"
