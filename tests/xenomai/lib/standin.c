/* Stand-in for a core of Xenomai: as hostile as the real one to whoever forgets to initialise it, and a thread
   that asks to be told of a switch to secondary mode is told of one. It has no name that the real one hasn't, see
   cobalt.symbols. XENO_STANDIN_AHEAD: s: lead of the core's clock, as under the I-pipe of Xenomai 3.1. */
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PTHREAD_WARNSW 0x4000

static int initialised;

void xenomai_init(int *argcp, char *const **argvp);
int pthread_setmode_np(int clear, int set, int *before);
int __cobalt_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *), void *arg);
int __cobalt_pthread_join(pthread_t thread, void **value);
int __cobalt_clock_gettime(clockid_t clock, struct timespec *now);
int __cobalt_clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left);

void xenomai_init(int *argcp, char *const **argvp) {
  const char *core = getenv("XENO_STANDIN_CORE");
  bool is_mercury = core && !strcmp(core, "mercury");
  if (*argcp < 1 || !(*argvp)[0] || (*argvp)[*argcp] || initialised) abort();
  /* the one option that Mercury has, without which it locks all memory, or ends the process where it may not */
  if (is_mercury && *argcp == 1) exit(1);
  if (*argcp > 1 && (!is_mercury || *argcp > 2 || strcmp((*argvp)[1], "--no-mlock") != 0)) abort();
  initialised = 1;
  if (getenv("XENO_STANDIN_SAYS")) fprintf(stderr, "stand-in: initialised\n");
}

int pthread_setmode_np(int clear, int set, int *before) {
  (void)before;
  if (clear == 0 && set == PTHREAD_WARNSW) pthread_kill(pthread_self(), SIGXCPU);
  return 0;
}

int __cobalt_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *), void *arg) {
  return initialised ? pthread_create(thread, attr, start, arg) : ENOSYS;
}

int __cobalt_pthread_join(pthread_t thread, void **value) { return pthread_join(thread, value); }

int __cobalt_clock_gettime(clockid_t clock, struct timespec *now) {
  const char *ahead = getenv("XENO_STANDIN_AHEAD");
  if (!initialised) abort();
  int failure = clock_gettime(clock, now);
  now->tv_sec += ahead ? atoi(ahead) : 0;
  return failure;
}

int __cobalt_clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left) {
  return initialised ? clock_nanosleep(clock, flags, until, left) : ENOSYS;
}
