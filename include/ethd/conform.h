/* Does a driver keep its contract? Each question tests a device through its own functions and gets one answer.
   Links from libethd-drivers and libethd.

   The device is opened, started, stopped and closed many times, and with `torque` it moves: keep clear of it, leave its
   ring empty and put its arm in the middle of its workspace. Its I/O runs as under the loop: in a thread for each unit,
   or with each tick of a virtual clock. If a push moves the angle by too few encoder steps, or an obstacle stops it,
   the question counts as not asked. All [main]. */
#ifndef ETHD_CONFORM_H
#define ETHD_CONFORM_H

#include "ethd/control.h"
#include "ethd/driver.h"

ETHD_BEGIN_DECLS

typedef enum ethd_verdict {
  ETHD_VERDICT_KEPT = 0,
  ETHD_VERDICT_BROKEN = 1,
  ETHD_VERDICT_AT_RISK = 2,  /* allowed, but the user should know */
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
  const volatile int *stop; /* when a signal handler sets it, the device is made safe and closed, and the remaining
                                     questions aren't asked; NULL: all are asked */
} ethd_conform_def;

/* Asks all questions. ETHD_OK: no answer is BROKEN; ETHD_E_DEVICE: one is; ETHD_E_UNFINISHED: it was stopped. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_conform(const ethd_conform_def *def,
                                                  ethd_conform_answer answers[ETHD_QUESTIONS]);

#define ETHD_SPACE_QUESTIONS 8

/* Asks a device in space (def->device->space). It is pushed by `torque`, m/s or N by the setup's kind, and by no more
   than the setup's limit. Returns as ethd_conform does (ETHD_E_...). [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_conform_space(const ethd_conform_def *def,
                                                        ethd_conform_answer answers[ETHD_SPACE_QUESTIONS]);

ETHD_END_DECLS

#endif
