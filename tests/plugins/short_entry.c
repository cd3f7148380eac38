/* An entry that ends before its count. */
#define ENTRY_SIZE ((uint32_t)(ETHD_PLUGIN_MIN - 1))
#include "broken.h"
