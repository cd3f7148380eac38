#include "identify/share.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#include "cli/cli.h"

#define MOST 16

typedef struct pile {
  void (*work)(void *, size_t);
  void *data;
  size_t count;
  atomic_size_t next; /* first index that no thread has taken */
} pile;

static void work_off(pile *p) {
  for (size_t i; (i = atomic_fetch_add(&p->next, 1)) < p->count;) p->work(p->data, i);
}

static void *run(void *pile_) {
  ethd__flush_denormals();
  work_off(pile_);
  return NULL;
}

void ethd__share(void (*work)(void *, size_t), void *data, size_t count) {
  pile all = {work, data, count, 0};
  pthread_t threads[MOST];
  size_t started = 0;
  long processors = sysconf(_SC_NPROCESSORS_ONLN);
  size_t most = processors < 1 ? 1 : processors > MOST ? MOST : (size_t)processors;
  while (started + 1 < most && !pthread_create(&threads[started], NULL, run, &all)) started++;
  work_off(&all);
  while (started) pthread_join(threads[--started], NULL);
}
