/* Memory that a block owns. */
#ifndef ETHD__TEXT_FREED_H
#define ETHD__TEXT_FREED_H

#include <stdlib.h>
#include <string.h>

static inline void ethd__free(const void *variable) {
  void *memory;
  memcpy(&memory, variable, sizeof memory);
  free(memory);
}

/* Before the declaration of pointers: what they point to, or NULL, is freed where their block ends. [main] */
#define ETHD__FREED __attribute__((cleanup(ethd__free)))

#endif
