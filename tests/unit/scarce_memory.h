/* Memory that runs out, and blocks that are counted, by standing in the way of the C library: included by the one
   source of a program that wants it. A program may define SCARCE_MEMORY_SEES(function), which comes first in each of
   them. Where SCARCE_MEMORY_SKIPPED is defined, a sanitizer has an allocator of its own. */
#ifndef ETHD_TESTS_SCARCE_MEMORY_H
#define ETHD_TESTS_SCARCE_MEMORY_H

#include <errno.h>
#include <malloc.h>
#include <stdlib.h>

#include "ethd/base.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__SANITIZE_UNDEFINED__) || \
    !defined(__GLIBC__)
#define SCARCE_MEMORY_SKIPPED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define SCARCE_MEMORY_SKIPPED 1
#endif
#endif

#ifndef SCARCE_MEMORY_SKIPPED

#ifndef SCARCE_MEMORY_SEES
#define SCARCE_MEMORY_SEES(function) (void)0
#endif

static volatile long allowed = -1; /* allocations until all fail; < 0: none does */
static volatile int live;          /* blocks held, counted while `counting` */
static volatile int counting;

static int refused(void) {
  if (allowed < 0) return 0;
  if (allowed > 0) {
    allowed--;
    return 0;
  }
  errno = ENOMEM;
  return 1;
}

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

#define HAND_OUT(call)           \
  SCARCE_MEMORY_SEES(__func__);  \
  if (refused()) return NULL;    \
  void *block = (call);          \
  if (counting && block) live++; \
  return block

ETHD_API void *malloc(size_t n) { HAND_OUT(__libc_malloc(n)); }
ETHD_API void *calloc(size_t n, size_t m) { HAND_OUT(__libc_calloc(n, m)); }
ETHD_API void *aligned_alloc(size_t a, size_t n) { HAND_OUT(__libc_memalign(a, n)); }
ETHD_API void *memalign(size_t a, size_t n) { HAND_OUT(__libc_memalign(a, n)); }

ETHD_API void *realloc(void *p, size_t n) {
  SCARCE_MEMORY_SEES("realloc");
  if (refused()) return NULL;
  if (counting && !p) live++;
  return __libc_realloc(p, n);
}

ETHD_API void free(void *p) {
  SCARCE_MEMORY_SEES("free");
  if (counting && p) live--;
  __libc_free(p);
}

#endif

#endif
