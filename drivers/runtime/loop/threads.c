/* The loop's threads: its own, and one for each unit of the device's blocking I/O. */
#include <errno.h>
#include <math.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "clock.h"
#include "denormals.h"
#include "loop/loop.h"

#define SERVICE_STACK ((size_t)256 << 10)
#define PAUSE 1000000 /* ns between two checks of whether the loop has released the device */
#define PATIENCE 1000 /* checks at most */

static void pause_a_little(void) {
  struct timespec t = {.tv_nsec = PAUSE};
  nanosleep(&t, NULL);
}

/* ---- bodies of the threads ---- */

static void *run_control(void *loop) {
  ethd_loop *l = loop;
  (void)ethd__denormals_flush();
  /* an ordinary thread's timers may otherwise come 50 us late; a real-time one's don't */
  prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
  ethd__xenomai_watch();
  atomic_store_explicit(&l->failed, ethd__loop_cycle(l), memory_order_relaxed);
  atomic_store_explicit(&l->ended, 1, memory_order_release);
  return NULL;
}

static void *run_unit(void *unit_) {
  const ethd__unit *unit = unit_;
  ethd_loop *l = unit->loop;
  (void)ethd__denormals_flush(); /* not the application's traps, which a thread inherits */
  while (!atomic_load_explicit(&l->stop, memory_order_relaxed)) {
    ethd_status status = ethd_device_service(l->def.device, unit->number, ethd__clock_now());
    if (status < 0) __atomic_fetch_add(&l->stats.service_failures, 1, __ATOMIC_RELAXED);
    if (status) pause_a_little();
  }
  return NULL;
}

/* ---- starting ---- */

static int create_control(ethd_loop *l, int policy) {
  pthread_attr_t attr;
  struct sched_param param = {.sched_priority = policy == SCHED_FIFO ? l->def.priority : 0};
  cpu_set_t one;
  CPU_ZERO(&one);
  pthread_attr_init(&attr);
  pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attr, policy);
  pthread_attr_setschedparam(&attr, &param);
  int failure = pthread_attr_setstack(&attr, l->stack, l->def.stack);
  if (l->cpu >= 0) {
    CPU_SET((unsigned)l->cpu, &one);
    pthread_attr_setaffinity_np(&attr, sizeof one, &one);
  }
  if (!failure) failure = __RT(pthread_create)(&l->control, &attr, run_control, l);
  pthread_attr_destroy(&attr);
  return failure;
}

static int start_control(ethd_loop *l) {
  int failure = create_control(l, SCHED_FIFO);
  if (failure != EPERM) return failure;
  l->shortfalls |= ETHD_SHORT_FIFO;
  return l->def.require_rt ? EPERM : create_control(l, SCHED_OTHER);
}

/* Creates a thread with this policy and priority. */
static int create(pthread_t *thread, int policy, int priority, void *(*run)(void *), void *of) {
  pthread_attr_t attr;
  struct sched_param param = {.sched_priority = policy == SCHED_FIFO ? priority : 0};
  pthread_attr_init(&attr);
  pthread_attr_setstacksize(&attr, SERVICE_STACK);
  pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attr, policy);
  pthread_attr_setschedparam(&attr, &param);
  int failure = pthread_create(thread, &attr, run, of);
  pthread_attr_destroy(&attr);
  return failure;
}

/* An I/O thread's priority is below the loop's, so that no exchange delays a tick, and above all ordinary threads, so
   that they don't delay an exchange. */
static int start_unit(ethd_loop *l, ethd__unit *unit) {
  int priority = l->def.priority > ETHD_IO_BELOW ? l->def.priority - ETHD_IO_BELOW : 1;
  int failure = create(&unit->thread, SCHED_FIFO, priority, run_unit, unit);
  if (failure != EPERM) return failure;
  l->shortfalls |= ETHD_SHORT_IO;
  return l->def.require_rt ? EPERM : create(&unit->thread, SCHED_OTHER, 0, run_unit, unit);
}

static int start_units(ethd_loop *l) {
  int failure = 0;
  for (uint32_t i = 0, n = ethd__loop_units(l); !failure && i < n; i++) {
    l->unit[i] = (ethd__unit){.loop = l, .number = i};
    failure = start_unit(l, &l->unit[i]);
    if (!failure) l->units++;
  }
  return failure;
}

/* The watching thread's priority is above the loop's, if the machine allows it. */
static int start_watch(ethd_loop *l) {
  int failure = create(&l->watch, SCHED_FIFO, l->def.priority < 99 ? l->def.priority + 1 : 99, ethd__loop_watch, l);
  if (failure == EPERM) failure = create(&l->watch, SCHED_OTHER, 0, ethd__loop_watch, l);
  l->has_watch = !failure;
  return failure;
}

/* Signals belong to the application, so these threads block all but the one by which Cobalt reports a switch of
   mode. */
static int start_threads(ethd_loop *l) {
  sigset_t all, before;
  sigfillset(&all);
#if defined(__COBALT__)
  sigdelset(&all, SIGDEBUG);
#endif
  pthread_sigmask(SIG_SETMASK, &all, &before);
  int failure = start_units(l);
  if (!failure) failure = start_control(l);
  if (!failure) l->has_control = 1;
  if (!failure) failure = start_watch(l);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return failure;
}

static void arm(ethd_loop *l) {
  int64_t now = ethd__loop_now(l);
  l->ahead = ethd__loop_boot(l) - now;
  l->missed = l->step = l->stale = l->ramp = l->bucket = l->late = l->slept = l->beat_at = 0;
  l->dry = 1;
  l->tail.marks |= ETHD_ROW_STARTED;
  l->front->start(l);
  atomic_store_explicit(&l->armed, 1, memory_order_relaxed);
}

static ethd_status give_up(ethd_loop *l, ethd_error *error, const char *name, double found) {
  ethd_loop_stop(l);
  (void)!ethd_loop_join(l);
  return ethd__loop_refuse(error, ETHD_E_DEVICE, name, found, NAN, NAN);
}

ethd_status ethd_loop_start(ethd_loop *l, ethd_error *error) {
  if (l->started) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "loop", NAN, NAN, NAN);
  if (l->def.clock) {
    l->started = true;
    l->due = *l->def.clock + l->period;
    arm(l);
    return ETHD_OK;
  }
  l->started = true;
  if (l->def.require_rt && l->shortfalls) return give_up(l, error, "require_rt", l->shortfalls);
  arm(l);
  l->process = getpid();
  int failure = start_threads(l);
  if (l->def.require_rt && l->shortfalls) return give_up(l, error, "require_rt", l->shortfalls);
  return failure ? give_up(l, error, "thread", failure) : ETHD_OK;
}

/* ---- while it runs ---- */

/* The loop releases the device between two ticks; then [main] owns device and controller. */
static bool take_over(ethd_loop *l) {
  int asked = ETHD__LOOP_ASKED;
  if (!l->has_control || ethd_loop_ended(l)) return l->def.clock != NULL;
  atomic_store_explicit(&l->mode, ETHD__LOOP_ASKED, memory_order_release);
  for (int i = 0; i < PATIENCE; i++) {
    if (atomic_load_explicit(&l->mode, memory_order_acquire) == ETHD__LOOP_PARKED) return true;
    pause_a_little();
  }
  return !atomic_compare_exchange_strong(&l->mode, &asked, ETHD__LOOP_RUNS);
}

ethd_status ethd_loop_enable(ethd_loop *l) {
  if (!take_over(l)) return ETHD_STATUS_BUSY;
  ethd_status status = ethd_device_start(l->def.device);
  if (!status) {
    ethd_counters counters;
    l->front->counters(l, &counters);
    for (int i = 0; i < ETHD_FAULT_COUNT; i++) l->faults[i] += counters.faults[i];
    l->front->restart(l);
    arm(l);
  } else {
    ethd_loop_disarm(l); /* the device's state is unknown */
  }
  atomic_store_explicit(&l->mode, ETHD__LOOP_RUNS, memory_order_release);
  return status;
}

static bool are_angles(const double q[2]) {
  return fabs(q[0]) <= ETHD_SENSE_ANGLE_MAX && fabs(q[1]) <= ETHD_SENSE_ANGLE_MAX;
}

ethd_status ethd_loop_home(ethd_loop *l, const double *q) {
  if (q && !are_angles(q)) return ETHD_E_RANGE;
  if (ethd_loop_armed(l) || !take_over(l)) return ETHD_STATUS_BUSY;
  ethd_status status = ethd_device_home(l->def.device, q);
  if (!status && !l->front->has_fault(l)) l->front->restart(l);
  atomic_store_explicit(&l->mode, ETHD__LOOP_RUNS, memory_order_release);
  return status;
}

/* Abandons the thread, unless its step ends first; the first of the two, the thread or [main], gets the device. */
static ethd_status give_up_thread(ethd_loop *l) {
  int64_t step = atomic_load_explicit(&l->stepping, memory_order_acquire);
  bool taken = step > 0 && atomic_compare_exchange_strong(&l->stepping, &step, ETHD__LOOP_LEFT);
  return taken ? ETHD_E_LAW : ETHD_E_DEVICE;
}

/* A hanging thread can't be ended: it is abandoned, with all memory that it may use. */
static void join_control(ethd_loop *l) {
  while (l->has_watch && !ethd_loop_ended(l) && !ethd_loop_hangs(l, NULL)) pause_a_little();
  if (l->has_watch && !ethd_loop_ended(l)) {
    atomic_store_explicit(&l->left, give_up_thread(l), memory_order_relaxed);
    pthread_detach(l->control);
  } else {
    __RT(pthread_join)(l->control, NULL);
  }
  l->has_control = 0;
}

/* Frees a loop in a forked child: memory and descriptors, without a call to the device. */
static void drop(ethd_loop *l) {
  l->has_control = l->has_watch = l->locked = false;
  l->units = 0;
  if (l->stack) munmap(l->stack, l->def.stack);
  l->stack = NULL;
  ethd__loop_release_machine(l);
}

ethd_status ethd_loop_join(ethd_loop *l) {
  if (ethd__loop_is_forked(l)) return drop(l), ETHD_E_ARGUMENT;
  if (l->def.clock && !ethd_loop_ended(l)) {
    ethd__loop_rest(l);
    atomic_store_explicit(&l->ended, 1, memory_order_release);
  }
  if (l->has_control) join_control(l);
  ethd_status left = (ethd_status)atomic_load_explicit(&l->left, memory_order_relaxed);
  if (l->has_watch) pthread_join(l->watch, NULL);
  l->has_watch = 0;
  for (; l->units; l->units--) pthread_join(l->unit[l->units - 1].thread, NULL);
  if (l->stack && !left) munmap(l->stack, l->def.stack);
  l->stack = NULL;
  ethd__loop_release_machine(l);
  if (left) return left;
  return atomic_load_explicit(&l->failed, memory_order_relaxed) ? ETHD_E_DEVICE : ETHD_OK;
}
