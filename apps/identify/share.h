/* Work over many like things, on as many threads as there are processors. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_SHARE_H
#define ETHD_APPS_IDENTIFY_SHARE_H

#include <stddef.h>

/* Calls work(data, begin, end) for parts that make up 0 to count, at once, and returns when all are done. What one part
   writes no other reads, so the result doesn't depend on how many there are. */
void ethd__share(void (*work)(void *data, size_t begin, size_t end), void *data, size_t count);

#endif
