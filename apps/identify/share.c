#include "identify/share.h"

#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

#include "cli/cli.h"

#define MOST 16

typedef struct portion {
  void (*work)(void *, size_t, size_t);
  void *data;
  size_t begin, end;
} portion;

static void *run(void *part_) {
  const portion *p = part_;
  ethd__flush_denormals();
  p->work(p->data, p->begin, p->end);
  return NULL;
}

void ethd__share(void (*work)(void *, size_t, size_t), void *data, size_t count) {
  pthread_t threads[MOST];
  portion parts[MOST];
  bool started[MOST] = {false};
  long processors = sysconf(_SC_NPROCESSORS_ONLN);
  size_t n = processors < 1 ? 1 : processors > MOST ? MOST : (size_t)processors;
  for (size_t i = 0; i < n; i++) {
    parts[i] = (portion){work, data, i * count / n, (i + 1) * count / n};
    started[i] = i > 0 && !pthread_create(&threads[i], NULL, run, &parts[i]);
  }
  for (size_t i = 0; i < n; i++) {
    if (started[i])
      pthread_join(threads[i], NULL);
    else
      work(data, parts[i].begin, parts[i].end);
  }
}
