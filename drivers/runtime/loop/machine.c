/* A realtime thread's requests to the machine, and the messages about refusals. */
#include <dlfcn.h>
#include <fcntl.h>
#include <math.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "locked_memory.h"
#include "loop/loop.h"

static const struct {
  const char *sentence, *mend;
} words[ETHD_SHORT_COUNT] = {
    {"no real-time priority: the loop waits behind every other program",
     "put \"@realtime - rtprio 95\" into /etc/security/limits.d/ethd.conf, join the group realtime and log in "
     "again; or: setcap cap_sys_nice+ep PROGRAM"},
    {"memory isn't locked: a page fault may stall a tick",
     "put \"@realtime - memlock unlimited\" into /etc/security/limits.d/ethd.conf, join the group realtime "
     "and log in again; or: setcap cap_ipc_lock+ep PROGRAM"},
    {"the loop isn't bound to the processor that was asked for",
     "choose a processor that exists and is allowed (taskset -p $$); isolate it with isolcpus=N on the kernel's "
     "command line"},
    {"deep sleep of the processor isn't prevented: wake-ups come late",
     "let the group open it: KERNEL==\"cpu_dma_latency\", GROUP=\"realtime\", MODE=\"0660\" in "
     "/etc/udev/rules.d/99-ethd.rules"},
    {"the kernel isn't a realtime one: latencies have no bound",
     "boot a kernel with PREEMPT_RT (Debian: linux-image-rt-amd64), or Xenomai"},
    {"no real-time priority for the device's I/O: two busy programs are enough to make its feedback too old",
     "as for the loop: \"@realtime - rtprio 95\" in /etc/security/limits.d/ethd.conf, or setcap cap_sys_nice+ep "
     "PROGRAM"},
};

static int place(int32_t bit) {
  for (int i = 0; i < ETHD_SHORT_COUNT; i++)
    if (bit == 1 << i) return i;
  return -1;
}

const char *ethd_shortfall_sentence(int32_t bit) {
  return place(bit) < 0 ? "an unknown shortfall" : words[place(bit)].sentence;
}

const char *ethd_shortfall_mend(int32_t bit) { return place(bit) < 0 ? "" : words[place(bit)].mend; }

ethd_status ethd__loop_refuse(ethd_error *error, ethd_status status, const char *name, double found, double min,
                              double max) {
  if (!error) return status;
  *error = (ethd_error){.status = status, .found = found, .min = min, .max = max};
  size_t n = strnlen(name, sizeof error->name - 1);
  memcpy(error->name, name, n);
  return status;
}

/* ---- requests ---- */

static int first_line(const char *path, char *out, int size) {
  FILE *file = fopen(path, "re");
  bool good = file && fgets(out, size, file);
  if (file) fclose(file);
  return good;
}

static bool kernel_is_realtime(void) {
#if defined(__COBALT__)
  return true;
#else
  char line[16];
  struct utsname name;
  if (first_line("/sys/kernel/realtime", line, sizeof line) && line[0] == '1') return true;
  return uname(&name) == 0 && strstr(name.version, "PREEMPT_RT");
#endif
}

/* Returns the highest isolated processor, which is 6 in "2-3,6"; -1: there is none. */
static int highest_isolated(void) {
  char line[256];
  int highest = ETHD_CPU_NONE, number = 0;
  if (!first_line("/sys/devices/system/cpu/isolated", line, sizeof line)) return ETHD_CPU_NONE;
  for (const char *p = line; sscanf(p, "%d", &number) == 1; p++) {
    if (number > highest) highest = number;
    p += strcspn(p, "-,");
    if (!*p) break;
  }
  return highest;
}

/* The calling thread tries the processor for the loop, and returns to its own. */
static bool may_run_on(int cpu) {
  cpu_set_t before, one;
  CPU_ZERO(&one);
  CPU_SET((unsigned)cpu, &one);
  if (sched_getaffinity(0, sizeof before, &before) != 0) return false;
  if (sched_setaffinity(0, sizeof one, &one) != 0) return false;
  return sched_setaffinity(0, sizeof before, &before) == 0;
}

static bool hold_dma_latency(ethd_loop *l) {
  l->dma_latency = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  return l->dma_latency >= 0 &&
         write(l->dma_latency, &l->def.dma_latency, sizeof l->def.dma_latency) == sizeof l->def.dma_latency;
}

/* Returns the used bytes of a thread's stack before it runs: its thread-local memory, some kB, but 800 kB under
   ThreadSanitizer. A function of glibc without a declaration gives it. */
static size_t threads_own(void) {
  size_t (*least)(const pthread_attr_t *) = NULL;
  void *found = dlsym(RTLD_DEFAULT, "__pthread_get_minstack");
  pthread_attr_t attr;
  memcpy(&least, &found, sizeof least);
  pthread_attr_init(&attr);
  const size_t bytes = least ? least(&attr) : 0;
  pthread_attr_destroy(&attr);
  return (bytes + 4095) / 4096 * 4096;
}

/* Touch the whole stack before the first tick, so that no tick takes a page fault; its lowest page is a guard page. */
static void *make_stack(size_t size) {
  void *stack = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK | MAP_POPULATE, -1, 0);
  if (stack == MAP_FAILED) return NULL;
  (void)!mprotect(stack, 4096, PROT_NONE);
  return stack;
}

static int32_t ask(ethd_loop *l) {
  int32_t bits = 0;
  l->cpu = l->def.cpu == ETHD_CPU_AUTO ? highest_isolated() : l->def.cpu;
  if (l->cpu >= 0 && !may_run_on(l->cpu)) {
    bits |= ETHD_SHORT_AFFINITY;
    l->cpu = ETHD_CPU_NONE;
  }
  l->locked = ethd__memory_lock();
  if (!l->locked) bits |= ETHD_SHORT_MLOCK;
  if (l->def.dma_latency >= 0 && !hold_dma_latency(l)) bits |= ETHD_SHORT_DMA_LATENCY;
  if (!kernel_is_realtime()) bits |= ETHD_SHORT_PREEMPT;
  return bits;
}

ethd_status ethd__loop_ask_machine(ethd_loop *l, ethd_error *error) {
  ethd_status status = ethd__xenomai_begin(error);
  if (status) return status;
  l->shortfalls = ask(l);
  l->def.stack += threads_own();
  l->stack = make_stack(l->def.stack);
  return l->stack ? ETHD_OK : ethd__loop_refuse(error, ETHD_E_MEMORY, "stack", NAN, NAN, NAN);
}

void ethd__loop_release_machine(ethd_loop *l) {
  if (l->dma_latency >= 0) close(l->dma_latency);
  if (l->locked) munlockall();
  l->dma_latency = -1;
  l->locked = 0;
}
