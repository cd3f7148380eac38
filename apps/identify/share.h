/* Spreads work over as many threads as there are processors. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_SHARE_H
#define ETHD__APPS_IDENTIFY_SHARE_H

#include <stddef.h>

/* Calls work(data, begin, end) in parallel for parts that make up 0 to count, and returns when all are done. No part
   may read what another one writes, so that the result doesn't depend on how many there are. */
void ethd__share(void (*work)(void *data, size_t begin, size_t end), void *data, size_t count);

#endif
