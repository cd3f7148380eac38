#include "cli/writer.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define STACK ((size_t)128 << 10)
#define PIECE 4096    /* bytes that a pipe takes at once when poll calls it ready */
#define LOOK 1000000  /* ns between two checks in ethd__writer_end */
#define UNREAD 300    /* checks in a row at which the descriptor isn't writable: then it gives up */
#define PATIENCE 5000 /* checks at most */

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Waits for text and returns how much of it lies in one piece. */
static size_t await(ethd__writer *w) {
  pthread_mutex_lock(&w->lock);
  while (!w->length) pthread_cond_wait(&w->filled, &w->lock);
  size_t n = least(least(w->length, ETHD__WRITER_ROOM - w->begin), PIECE);
  pthread_mutex_unlock(&w->lock);
  return n;
}

static void wrote(ethd__writer *w, size_t n, int failure) {
  pthread_mutex_lock(&w->lock);
  w->failure = failure;
  w->begin = (w->begin + n) % ETHD__WRITER_ROOM;
  w->length = failure ? 0 : w->length - n;
  pthread_mutex_unlock(&w->lock);
}

static void *run(void *writer) {
  ethd__writer *w = writer;
  for (;;) {
    size_t n = await(w);
    ssize_t done = write(w->fd, w->at + w->begin, n);
    struct pollfd ready = {.fd = w->fd, .events = POLLOUT};
    if (done >= 0)
      wrote(w, (size_t)done, 0);
    else if (errno == EAGAIN) /* another process made the descriptor, which it shares, non-blocking */
      (void)!poll(&ready, 1, -1);
    else if (errno != EINTR)
      wrote(w, 0, errno);
  }
  return NULL;
}

bool ethd__writer_start(ethd__writer *w, int fd) {
  pthread_attr_t attr;
  sigset_t all, before;
  memset(w, 0, sizeof *w);
  w->fd = fd;
  pthread_mutex_init(&w->lock, NULL);
  pthread_cond_init(&w->filled, NULL);
  pthread_attr_init(&attr);
  pthread_attr_setstacksize(&attr, STACK);
  pthread_attr_setdetachstate(&attr, PTHREAD_CREATE_DETACHED);
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  bool good = pthread_create(&w->thread, &attr, run, w) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  pthread_attr_destroy(&attr);
  return good;
}

void ethd__writer_put(ethd__writer *w, const char *text, size_t length) {
  pthread_mutex_lock(&w->lock);
  if (length > ETHD__WRITER_ROOM - w->length) {
    w->dropped += length;
  } else if (!w->failure) {
    size_t end = (w->begin + w->length) % ETHD__WRITER_ROOM, first = least(length, ETHD__WRITER_ROOM - end);
    memcpy(w->at + end, text, first);
    memcpy(w->at, text + first, length - first);
    w->length += length;
    pthread_cond_signal(&w->filled);
  }
  pthread_mutex_unlock(&w->lock);
}

static size_t waiting(ethd__writer *w) {
  pthread_mutex_lock(&w->lock);
  size_t n = w->length;
  pthread_mutex_unlock(&w->lock);
  return n;
}

void ethd__writer_end(ethd__writer *w) {
  const struct timespec look = {.tv_nsec = LOOK};
  for (int unread = 0, looks = 0; !w->given_up && waiting(w) && unread < UNREAD && looks < PATIENCE; looks++) {
    struct pollfd ready = {.fd = w->fd, .events = POLLOUT};
    unread = poll(&ready, 1, 0) == 1 ? 0 : unread + 1;
    nanosleep(&look, NULL);
  }
  pthread_mutex_lock(&w->lock);
  if (!w->given_up) w->dropped += w->length;
  w->given_up |= w->length > 0;
  pthread_mutex_unlock(&w->lock);
}
