/* Xenomai 3: started by hand, on the main thread. On Cobalt a thread that leaves primary mode is told so by
   a signal, which only counts. */
#include "loop/loop.h"

#if defined(__COBALT__) || defined(__MERCURY__)
#include <signal.h>
#include <xenomai/init.h>

/* With an argv of our own: Xenomai's options are not the program's. */
static int initialise(void) {
  static char name[] = "ethd";
  static char *words[] = {name, NULL};
  static int done;
  char *const *argv = words;
  int argc = 1;
  if (done) return 0;
  xenomai_init(&argc, &argv);
  done = 1;
  return 0;
}
#endif

#if defined(__COBALT__)
#include <stdlib.h>
#include <unistd.h>

static atomic_ulong relaxes;

static void count(int signal) {
  (void)signal;
  atomic_fetch_add_explicit(&relaxes, 1, memory_order_relaxed);
}

/* xenomai_init ends the process on a kernel without Cobalt, so the kernel is checked first. */
int ethd__xenomai_begin(void) {
  const char *given = getenv("ETHD_XENOMAI_VERSION_FILE");
  if (access(given ? given : "/proc/xenomai/version", R_OK) != 0) return -1;
  struct sigaction action = {.sa_handler = count};
  sigemptyset(&action.sa_mask);
  int failure = initialise();
  if (!failure) failure = sigaction(SIGDEBUG, &action, NULL);
  return failure;
}

void ethd__xenomai_watch(void) { (void)!pthread_setmode_np(0, PTHREAD_WARNSW, NULL); }
uint64_t ethd__xenomai_relaxes(void) { return atomic_load_explicit(&relaxes, memory_order_relaxed); }

#else

#if defined(__MERCURY__)
int ethd__xenomai_begin(void) { return initialise(); }
#else
int ethd__xenomai_begin(void) { return 0; }
#endif
void ethd__xenomai_watch(void) {}
uint64_t ethd__xenomai_relaxes(void) { return 0; }

#endif
