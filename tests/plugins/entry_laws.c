/* Says that it has a law, and has no list of them. */
#define ENTRY_LAWS (sizeof laws ? NULL : laws)
#include "broken.h"
