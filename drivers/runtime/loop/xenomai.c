/* Xenomai 3: started by a call on the main thread. On Cobalt a signal reports that a thread left primary mode; its
   handler only counts. */
#include <math.h>

#include "loop/loop.h"

#if defined(__COBALT__) || defined(__MERCURY__)
#include <signal.h>
#include <xenomai/init.h>

/* Xenomai gets its own argv, because its options are not the program's. Mercury would end the process if memory can't
   be locked; the loop locks it itself, and reports a failure. */
static void initialise(void) {
  static char name[] = "ethd";
#if defined(__MERCURY__)
  static char no_mlock[] = "--no-mlock";
  static char *words[] = {name, no_mlock, NULL};
#else
  static char *words[] = {name, NULL};
#endif
  static int done;
  char *const *argv = words;
  int argc = sizeof words / sizeof *words - 1;
  if (!done) xenomai_init(&argc, &argv);
  done = 1;
}
#endif

#if defined(__COBALT__)
#include <stdlib.h>
#include <unistd.h>

#include "clock.h"

#define APART \
  10000000 /* ns: two readings of one clock around one of the other lie closer than this, unless the machine stalls */
#define LOOKS 10

static atomic_ulong relaxes;

static void count(int signal) {
  (void)signal;
  atomic_fetch_add_explicit(&relaxes, 1, memory_order_relaxed);
}

static int64_t core_now(void) {
  struct timespec t;
  __RT(clock_gettime)(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Drivers' threads stamp by Linux's clock, and the loop ticks by the core's. On Dovetail these are one clock, on the
   I-pipe of Xenomai up to 3.1 they aren't. Returns the lead of the core's clock, ns; 0: they are one. */
static int64_t clocks_apart(void) {
  int64_t ahead = 0;
  for (int i = 0; i < LOOKS; i++) {
    int64_t before = ethd__clock_now(), core = core_now(), after = ethd__clock_now();
    if (core >= before - APART && core <= after + APART) return 0;
    ahead = core - before;
  }
  return ahead;
}

/* xenomai_init ends the process on a kernel without Cobalt, so the kernel is checked first. */
ethd_status ethd__xenomai_begin(ethd_error *error) {
  const char *given = getenv("ETHD_XENOMAI_VERSION_FILE");
  if (access(given ? given : "/proc/xenomai/version", R_OK) != 0)
    return ethd__loop_refuse(error, ETHD_E_DEVICE, "xenomai", NAN, NAN, NAN);
  struct sigaction action = {.sa_handler = count};
  sigemptyset(&action.sa_mask);
  initialise();
  int64_t ahead = clocks_apart();
  if (ahead) return ethd__loop_refuse(error, ETHD_E_DEVICE, "clock", 1e-9 * (double)ahead, NAN, NAN);
  if (sigaction(SIGDEBUG, &action, NULL)) return ethd__loop_refuse(error, ETHD_E_DEVICE, "thread", NAN, NAN, NAN);
  return ETHD_OK;
}

void ethd__xenomai_watch(void) { (void)!pthread_setmode_np(0, PTHREAD_WARNSW, NULL); }
uint64_t ethd__xenomai_relaxes(void) { return atomic_load_explicit(&relaxes, memory_order_relaxed); }

#else

ethd_status ethd__xenomai_begin(ethd_error *error) {
  (void)error;
#if defined(__MERCURY__)
  initialise();
#endif
  return ETHD_OK;
}
void ethd__xenomai_watch(void) {}
uint64_t ethd__xenomai_relaxes(void) { return 0; }

#endif
