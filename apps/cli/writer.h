/* A thread that writes a program's output. A slow or absent reader blocks only this thread. A text that doesn't fit
   into the buffer is dropped, and its bytes are counted. */
#ifndef ETHD__APPS_CLI_WRITER_H
#define ETHD__APPS_CLI_WRITER_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ETHD__WRITER_ROOM ((size_t)1 << 18) /* bytes of waiting text */

typedef struct ethd__writer {
  int fd;
  pthread_t thread;
  pthread_mutex_t lock;
  pthread_cond_t filled;
  size_t begin, length; /* a ring of waiting text; only the thread moves begin */
  int failure;          /* errno of a write that failed, after which nothing is written; 0: none */
  uint64_t dropped;     /* bytes */
  bool given_up;        /* the wait for the end timed out */
  char at[ETHD__WRITER_ROOM];
} ethd__writer;

/* Starts the thread for a descriptor without changing its flags. Returns false without a thread. [main] */
bool ethd__writer_start(ethd__writer *writer, int fd);

/* Queues the text, or drops all of it. Never waits for a reader. [any] */
void ethd__writer_put(ethd__writer *writer, const char *text, size_t length);

/* Waits until all is written, as long as the reader reads; after 0.3 s without a read the rest counts as dropped.
   The thread goes on until the process ends. [main] */
void ethd__writer_end(ethd__writer *writer);

#endif
