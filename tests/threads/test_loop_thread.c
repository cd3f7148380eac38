/* The loop with threads: under a filter of system calls it needs nothing but to sleep; enabling takes the device
   over between two ticks; it ends when told. No wall-clock bound is asserted. */
#include <errno.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "ethd/loop.h"
#include "unit/device_of.h"
#include "unit/rig.h"
#include "unit/suite.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

/* ---- a device that puts its own thread under the filter ---- */

typedef struct device {
  int filter, calls; /* at the first read; a forbidden call at the 50th */
  long filtered;     /* what the filter's installation returned */
  int inside;        /* reads and writes now; never while start runs */
  atomic_int reads, starts, overlaps;
  atomic_int services, policy, priority; /* of the I/O thread */
  double nan_at;                         /* read at which q isn't a number, 0: never */
  ethd_sense sense;
} device;

#define ALLOW(number) \
  BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)(number), 0, 1), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)

/* Sleep, the clock and futex; what a thread does as it ends. */
static long forbid_the_rest(void) {
  struct sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
      ALLOW(SYS_clock_nanosleep),
      ALLOW(SYS_clock_gettime),
      ALLOW(SYS_futex),
      ALLOW(SYS_rt_sigreturn),
      ALLOW(SYS_rt_sigprocmask),
      ALLOW(SYS_madvise),
      ALLOW(SYS_exit),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  struct sock_fprog program = {sizeof filter / sizeof *filter, filter};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) return -1;
  return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program);
}

static ethd_status dev_start(void *device_) {
  device *d = device_;
  if (d->inside) atomic_fetch_add(&d->overlaps, 1);
  d->inside++;
  atomic_fetch_add(&d->starts, 1);
  d->inside--;
  return ETHD_OK;
}

static ethd_status dev_read(void *device_, int64_t now, ethd_sense *out) ETHD_RT {
  device *d = device_;
  int n = atomic_fetch_add(&d->reads, 1) + 1;
  d->inside++;
  if (n == 1 && d->filter) d->filtered = forbid_the_rest();
  if (n == 50 && d->calls) (void)!getppid();
  *out = d->sense;
  out->time_ns = now;
  if (d->nan_at > 0 && n == (int)d->nan_at) out->q[0] = (double)NAN;
  return ETHD_OK;
}

static ethd_status dev_write(void *device_, int64_t now, const ethd_command *command) ETHD_RT {
  (void)now, (void)command;
  ((device *)device_)->inside--;
  return ETHD_OK;
}

static uint32_t dev_units(const void *d) { return (void)d, 1; }

static ethd_status dev_service(void *d, uint32_t unit, int64_t now) {
  struct timespec t = {.tv_nsec = 1000000};
  (void)unit, (void)now;
  struct sched_param param;
  int policy;
  if (!pthread_getschedparam(pthread_self(), &policy, &param)) {
    atomic_store(&((device *)d)->policy, policy);
    atomic_store(&((device *)d)->priority, param.sched_priority);
  }
  atomic_fetch_add(&((device *)d)->services, 1);
  nanosleep(&t, NULL);
  return ETHD_OK;
}

static pid_t opened_by; /* the process that has the device */
static void dev_safe(void *d) ETHD_RT {
  (void)d;
  if (opened_by && opened_by != getpid()) _exit(9);
}
static ethd_status dev_stop(void *d) { return (void)d, ETHD_OK; }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "test",
                                   .brief = "test",
                                   .start = dev_start,
                                   .read = dev_read,
                                   .write = dev_write,
                                   .units = dev_units,
                                   .service = dev_service,
                                   .safe = dev_safe,
                                   .stop = dev_stop};

static rig r;
static device d;
static ethd_loop *loop;

static void open_loop(double early_wake) {
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(0.001, -0.01, 0.001);
  d.sense = rig_sense(&r.setup.arm, &m);
  ethd_loop_def def = ethd_loop_default();
  static ethd_device of_it;
  device_of(&of_it, &driver, &d);
  def.device = &of_it;
  def.control = r.control;
  def.early_wake = early_wake;
  if (SANITIZED) def.stack = (size_t)4 << 20; /* sanitizers keep their own things there */
  ck_assert_int_eq(ethd_loop_create(&def, &loop, NULL), ETHD_OK);
}

static void await_reads(int n) {
  struct timespec t = {.tv_nsec = 1000000};
  while (atomic_load(&d.reads) < n) nanosleep(&t, NULL);
}

static void close_loop(void) {
  ethd_loop_stop(loop);
  ck_assert_int_eq(ethd_loop_join(loop), ETHD_OK);
  ck_assert_int_eq(ethd_loop_ended(loop), 1);
  ethd_loop_destroy(loop);
  rig_close(&r);
}

static void run_filtered(int calls, double early_wake) {
  d.filter = !SANITIZED;
  d.calls = calls && !SANITIZED;
  open_loop(early_wake);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  await_reads(200);
  ck_assert_int_eq(d.filtered, 0);
  close_loop();
}

TEST(test_no_call_but_the_sleep) { run_filtered(0, 0); }

TEST(test_no_call_with_early_wake) { run_filtered(0, 1e-4); }

/* The filter bites. */
TEST_SIGNAL(test_a_call_is_fatal, 0, 1, SANITIZED ? 0 : 31 /* SIGSYS */) { run_filtered(1, 0); }

TEST(test_enable_between_ticks) {
  d.nan_at = 20;
  open_loop(0);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  await_reads(40);
  ck_assert_int_eq(ethd_loop_armed(loop), 0);
  ck_assert_int_eq(ethd_loop_enable(loop), ETHD_OK);
  await_reads(80);
  ck_assert_int_eq(ethd_loop_armed(loop), 1);
  for (int i = 0; i < 20; i++) ck_assert_int_eq(ethd_loop_enable(loop), ETHD_OK);
  ck_assert_int_eq(atomic_load(&d.starts), 21);
  ck_assert_int_eq(atomic_load(&d.overlaps), 0);
  ck_assert_int_gt(atomic_load(&d.services), 0);
  close_loop();
}

/* Rows come in order, and statistics can be read, while it runs. */
TEST(test_rows_while_running) {
  static ethd_loop_stats s;
  ethd_loop_row row;
  int64_t next = 0;
  open_loop(0);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  while (next < 200) {
    struct timespec t = {.tv_nsec = 1000000};
    while (ethd_loop_take(loop, &row) == ETHD_OK) ck_assert_int_eq(row.trace.tick, next++);
    ethd_loop_read(loop, &s);
    nanosleep(&t, NULL);
  }
  close_loop();
}

/* All memory is locked, and so is there, before anybody can enable the device: a large program takes long for it. */
TEST_LOOP(test_locked_before_the_device_starts, 0, !SANITIZED) {
  enum { PAGES = 2048 };
  static unsigned char there[PAGES];
  size_t page = (size_t)sysconf(_SC_PAGESIZE), missing = 0;
  void *room = mmap(NULL, PAGES * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ck_assert(room != MAP_FAILED);
  open_loop(0);
  ck_assert_int_eq(mincore(room, PAGES * page, there), 0);
  for (int i = 0; i < PAGES; i++) missing += !(there[i] & 1);
  if (!(ethd_loop_shortfalls(loop) & ETHD_SHORT_MLOCK)) ck_assert_uint_eq(missing, 0);
  ethd_loop_destroy(loop);
  rig_close(&r);
  ck_assert_int_eq(munmap(room, PAGES * page), 0);
}

/* I/O runs below the loop and over everything ordinary, or it is said that it doesn't. */
TEST(test_io_priority) {
  open_loop(0);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  for (int i = 0; i < 2000 && !atomic_load(&d.services); i++) {
    struct timespec t = {.tv_nsec = 1000000};
    nanosleep(&t, NULL);
  }
  ck_assert_int_gt(atomic_load(&d.services), 0);
  if (ethd_loop_shortfalls(loop) & ETHD_SHORT_IO) {
    ck_assert_int_eq(atomic_load(&d.policy), SCHED_OTHER);
    ck_assert_int_ne(ethd_loop_shortfalls(loop) & ETHD_SHORT_FIFO, 0);
  } else {
    ck_assert_int_eq(atomic_load(&d.policy), SCHED_FIFO);
    ck_assert_int_eq(atomic_load(&d.priority), ethd_loop_default().priority - ETHD_IO_BELOW);
  }
  close_loop();
}

static void *nothing(void *self) { return self; }

/* The loop runs where the user may lock little more memory than there is; returns what went wrong, 0: nothing. */
static int run_with_little_memory(void) {
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (!file || fscanf(file, "%ld", &pages) != 1) return 1;
  fclose(file);
  rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + ((rlim_t)4 << 20);
  struct rlimit limit;
  if (getrlimit(RLIMIT_MEMLOCK, &limit)) return 2;
  if (limit.rlim_max > most) limit.rlim_max = most; /* it may be less, and then not everybody may raise it */
  limit.rlim_cur = limit.rlim_max;
  if (setrlimit(RLIMIT_MEMLOCK, &limit) || (getuid() == 0 && setuid(65534))) return 2;
  open_loop(0);
  if (ethd_loop_start(loop, NULL) != ETHD_OK) return 3;
  pthread_t thread;
  if (pthread_create(&thread, NULL, nothing, NULL) || pthread_join(thread, NULL)) return 4;
  void *room = malloc((size_t)64 << 20);
  if (!room) return 5;
  free(room);
  if (!(ethd_loop_shortfalls(loop) & ETHD_SHORT_MLOCK)) return 6;
  close_loop();
  return 0;
}

/* Debian lets everybody lock 8 MB: enough to be granted at first, too little for the stacks of threads that follow. */
TEST_LOOP(test_little_memory_to_lock, 0, !SANITIZED) {
  int status;
  pid_t child = fork();
  if (child == 0) _exit(run_with_little_memory());
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert(WIFEXITED(status));
  ck_assert_int_eq(WEXITSTATUS(status), 0);
}

/* A machine without PREEMPT_RT or rights is refused, with all its reasons; nothing ran. */
TEST(test_require_rt) {
  rig_begin(&r, RIG_WALL, NULL);
  ethd_loop_def def = ethd_loop_default();
  ethd_error error;
  static ethd_device of_it;
  device_of(&of_it, &driver, &d);
  def.device = &of_it;
  def.control = r.control;
  def.require_rt = 1;
  def.cpu = 1023;
  ck_assert_int_eq(ethd_loop_create(&def, &loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(loop, &error), ETHD_E_DEVICE);
  ck_assert_str_eq(error.name, "require_rt");
  ck_assert_int_ne(ethd_loop_shortfalls(loop) & ETHD_SHORT_AFFINITY, 0);
  ck_assert_int_eq(atomic_load(&d.reads), 0);
  ethd_loop_destroy(loop);
  rig_close(&r);
}

/* Returns 0 if the child's copy of a running loop goes without its threads and without the device. */
static int in_a_child(void) {
  ethd_loop_row row;
  alarm(20);
  if (ethd_loop_armed(loop) || !ethd_loop_ended(loop) || ethd_loop_hangs(loop, NULL)) return 1;
  if (ethd_loop_enable(loop) != ETHD_STATUS_BUSY || ethd_loop_home(loop, NULL) == ETHD_OK) return 2;
  while (ethd_loop_take(loop, &row) == ETHD_OK) continue;
  const int starts = atomic_load(&d.starts);
  ethd_loop_stop(loop);
  if (ethd_loop_join(loop) != ETHD_E_ARGUMENT || atomic_load(&d.starts) != starts) return 3;
  ethd_loop_destroy(loop);
  rig_close(&r);
  return 0;
}

TEST(test_forked) {
  int status;
  opened_by = getpid();
  open_loop(0);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  await_reads(20);
  pid_t child = fork();
  if (child == 0) _exit(in_a_child());
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "the child ends with status %#x", (unsigned)status);
  ck_assert_int_eq(ethd_loop_armed(loop), 1);
  const int reads = atomic_load(&d.reads);
  await_reads(reads + 20);
  close_loop();
  opened_by = 0;
}
