/* A version that would clear the terminal. */
#define ENTRY_VERSION "1\033[2J"
#include "broken.h"
