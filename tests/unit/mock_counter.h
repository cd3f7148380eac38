/* Two counts of a kernel's counter, without the kernel: stands in for the driver's system calls. Its attributes are
   those of the kernel's Documentation/ABI/testing/sysfs-bus-counter; which of them a driver has, and what they say when
   it is loaded, is taken from the sources in drivers/counter. */
#ifndef ETHD_TESTS_MOCK_COUNTER_H
#define ETHD_TESTS_MOCK_COUNTER_H

#include <linux/counter.h>

#include "encoder/counter.h"

#define MOCK_EVENTS 1024

/* A call that fails: its paths' ending (NULL: none), the number of calls that succeed before, the errno. */
typedef struct mock_failure {
  const char *path;
  int after, reason;
} mock_failure;

typedef struct mock_counter {
  mock_failure open, read, write;
  int ioctl_reason; /* errno of enabling events; 0: it goes well */
  uint64_t count[2];
  char ceiling[2][32];          /* empty: the attribute doesn't exist; "0": the counter stays at 0 */
  char function[32];            /* empty: it can't say yet (EINVAL) */
  int fixed;                    /* 1: the function can only be read */
  int has_enable, on[2];        /* a counter that is off keeps its count */
  int stays_off;                /* 1: takes `enable`, and stays off */
  int ceiling_fixed;            /* 1: takes a ceiling, and keeps the old one */
  int deaf;                     /* 1: takes a function, and keeps the old one */
  int gone;                     /* 1: every read fails */
  int refuse_event;             /* this event can't be watched; -1: all can */
  void (*on_pause)(int64_t ns); /* NULL: nothing happens meanwhile */
  struct counter_event events[MOCK_EVENTS];
  uint32_t waiting;
  struct counter_watch watches[8];
  uint32_t watch_count;
  int enabled, open_files, pauses;
  char opened[16][160]; /* paths by descriptor, "" closed */
} mock_counter;

extern mock_counter counter_mock;

/* As intel-qep: 32 bits, quadrature x4, off; opening a device anew takes its calls from here. */
void mock_counter_install(void);

/* As the named driver of the kernel leaves a counter when it is loaded. */
void mock_counter_load(const char *driver);

/* An event as it would come from the kernel. */
void mock_counter_event(uint8_t kind, int joint, uint64_t value, int64_t time_ns);

#endif
