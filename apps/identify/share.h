/* Spreads work over as many threads as there are processors. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_SHARE_H
#define ETHD__APPS_IDENTIFY_SHARE_H

#include <stddef.h>

/* Calls work(data, i) for each i from 0 to count - 1, in parallel and in any order, and returns when all are done. No
   call may read what another one writes, so that the result doesn't depend on how many there are. */
void ethd__share(void (*work)(void *data, size_t i), void *data, size_t count);

#endif
