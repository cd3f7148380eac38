/* Nameless. */
#define ENTRY_ID NULL
#include "broken.h"
