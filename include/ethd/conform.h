/* Does a driver keep its contract? A device is asked questions through its own functions, and gives one answer to each.
   Links from libethd-drivers and libethd.

   The device is opened, started, stopped and closed many times, and with `torque` it moves: keep clear of it, leave its
   ring empty and put its arm in the middle of its room. Its I/O is done as the loop does it: by a thread for each unit,
   or with each tick of a virtual clock. A push that moves the angle by too few of its steps, or that something stops,
   answers nothing: that question then counts as not asked. All [main]. */
#ifndef ETHD_CONFORM_H
#define ETHD_CONFORM_H

#include "ethd/control.h"
#include "ethd/driver.h"

ETHD_BEGIN_DECLS

typedef enum ethd_verdict {
  ETHD_VERDICT_KEPT = 0,
  ETHD_VERDICT_BROKEN = 1,
  ETHD_VERDICT_AT_RISK = 2,  /* allowed, but people should know */
  ETHD_VERDICT_NOT_ASKED = 3 /* `found` says why */
} ethd_verdict;

typedef struct ethd_conform_answer {
  const char *question; /* "safe", "sign", ... */
  ethd_verdict verdict;
  char found[160]; /* one line */
} ethd_conform_answer;

#define ETHD_QUESTIONS 11

typedef struct ethd_conform_def {
  const char *ids;                /* as for ethd_device_open */
  const ethd_driver *const *from; /* as for ethd_device_open */
  const ethd_device_def *device;
  double torque;            /* Nm on each joint in turn, for the longer of 0.15 s and 24 spacings of samples;
                    0, or not finite: nothing may move */
  const volatile int *stop; /* once it isn't 0, as a handler of signals makes it, the device is made safe and closed,
                                     and what is left isn't asked; NULL: all is asked */
} ethd_conform_def;

/* Asks all questions. ETHD_OK: nothing is broken; ETHD_E_DEVICE: something is; ETHD_E_UNFINISHED: it was stopped. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_conform(const ethd_conform_def *def,
                                                  ethd_conform_answer answers[ETHD_QUESTIONS]);

#define ETHD_SPACE_QUESTIONS 7

/* Asks a device in space (def->device->space), which is pushed by `torque`, m/s or N as its setup says, and by no more
   than the setup's limit. Returns as ethd_conform does (ETHD_E_...). [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_conform_space(const ethd_conform_def *def,
                                                        ethd_conform_answer answers[ETHD_SPACE_QUESTIONS]);

ETHD_END_DECLS

#endif
