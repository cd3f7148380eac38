/* Memory that no page fault can delay. [main] */
#ifndef ETHD__LOCKED_MEMORY_H
#define ETHD__LOCKED_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/mman.h>

#define ETHD__LOCKED_ROOM ((size_t)256 << 20) /* bytes: threads' stacks, recordings, scenes of the time to come */

/* Locks all memory of the process, now and in future; munlockall undoes it. Returns false if nothing is locked: it
   isn't allowed, or the user's limit leaves too little room for what is still to come, so that a later allocation would
   fail for no reason that anybody could see. */
static inline bool ethd__memory_lock(void) {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) return false;
  /* This mapping has no pages; it is only counted against the limit. */
  void *room = mmap(NULL, ETHD__LOCKED_ROOM, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return munlockall(), false;
  munmap(room, ETHD__LOCKED_ROOM);
  return true;
}

#endif
