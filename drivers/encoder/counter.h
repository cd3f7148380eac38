/* Two encoders behind the kernel's counters (linux/counter.h), one for each joint.

     /sys/bus/counter/devices/counterN/countM/count      the count, read in each call of service
                                              /ceiling   where it wraps to 0; set if it is 0
                                              /function  "quadrature x4": set, and read back
                                              /enable    1: set, and read back
     /dev/counterN   events with the kernel's time stamps: index marks; each edge, if speeds come from edges

       [device]
       driver = servo, counter          the later driver's angles are used
       counter.device = /dev/counter0
       counter.ratio = 12

   This driver was never run on hardware: no available kernel had a counter. It was tested with a replacement of the
   system calls below. A thread reads the kernel's counter, which may be slow; the loop never does. */
#ifndef ETHD__ENCODER_COUNTER_H
#define ETHD__ENCODER_COUNTER_H

#include <stdbool.h>
#include <sys/types.h>

#include "encoder/unwrap.h"
#include "ethd/driver.h"

#define ETHD_COUNTER_TEXT_MAX 96 /* bytes of a path or a function's name, the closing 0 included */

/* The system calls with the kernel's conventions: failures are -1 and errno. */
typedef struct ethd__counter_calls {
  int (*open)(const char *path, int flags);
  int (*close)(int fd);
  int (*ioctl)(int fd, unsigned long request, void *argument);
  ssize_t (*read)(int fd, void *to, size_t size);      /* of the device: whole events */
  ssize_t (*read_text)(int fd, char *to, size_t size); /* of an attribute: from its beginning */
  ssize_t (*write_text)(int fd, const char *from, size_t size);
  void (*pause)(int64_t ns);
} ethd__counter_calls;

extern const ethd__counter_calls ethd__counter_kernel;
extern const ethd__counter_calls *ethd__counter_calls_now; /* used at the opening of a device; tests set their own */

enum {
  ETHD__COUNTER_COUNTS_PER_TURN,
  ETHD__COUNTER_RATIO,
  ETHD__COUNTER_SIGN1,
  ETHD__COUNTER_SIGN2,
  ETHD__COUNTER_OFFSET1,
  ETHD__COUNTER_OFFSET2,
  ETHD__COUNTER_WIDTH,
  ETHD__COUNTER_HOME,
  ETHD__COUNTER_HOME_TIME,
  ETHD__COUNTER_STAMPS,
  ETHD__COUNTER_SPEED_MAX,
  ETHD__COUNTER_FREEZE_TORQUE,
  ETHD__COUNTER_FREEZE_TIME,
  ETHD__COUNTER_REVERSE_TORQUE,
  ETHD__COUNTER_REVERSE_TIME,
  ETHD__COUNTER_INERTIA,
  ETHD__COUNTER_PARAMS
};

extern const ethd_param ethd__counter_params[ETHD__COUNTER_PARAMS];
extern const char *const ethd__counter_keys[]; /* ends with NULL */

/* The driver's settings. */
typedef struct ethd__counter_settings {
  double p[ETHD__COUNTER_PARAMS];
  char device[2][ETHD_COUNTER_TEXT_MAX]; /* of joint 1 and 2 */
  char function[ETHD_COUNTER_TEXT_MAX];
  uint8_t count[2], channel[2]; /* number of the count; of its index event */
} ethd__counter_settings;

ETHD_MUST_CHECK ethd_status ethd__counter_settings_read(const ethd_device_def *def, ethd__counter_settings *out,
                                                        char message[ETHD_MESSAGE_MAX]);

/* One count of a kernel's counter. */
typedef struct ethd__kernel_count {
  int device, count; /* descriptors; two counts may share a device */
  bool shared;
  uint64_t ceiling;
} ethd__kernel_count;

/* Opens joint j's count; `other` is that of the joint before, or NULL. *out is closed on failure. */
ETHD_MUST_CHECK ethd_status ethd__kernel_count_open(const ethd__counter_calls *calls,
                                                    const ethd__counter_settings *settings, int j,
                                                    const ethd__kernel_count *other, ethd__kernel_count *out,
                                                    char message[ETHD_MESSAGE_MAX]);
void ethd__kernel_count_close(const ethd__counter_calls *calls, ethd__kernel_count *count);

/* Reads the count; -1: it can't be read. */
int ethd__kernel_count_read(const ethd__counter_calls *calls, const ethd__kernel_count *count, uint64_t *raw);

/* Requests the events of joint j's device. If both joints share a device, one request serves both. */
ETHD_MUST_CHECK ethd_status ethd__kernel_count_watch(const ethd__counter_calls *calls,
                                                     const ethd__counter_settings *settings, int j,
                                                     const ethd__kernel_count *counts, char message[ETHD_MESSAGE_MAX]);

#endif
