/* A recording for a replaying device: the samples, their torques, and the device's limits. */
#ifndef ETHD__TAPE_TAPE_H
#define ETHD__TAPE_TAPE_H

#include "ethd/record.h"

typedef struct ethd__tape {
  ethd_trace *rows;
  size_t count;
  size_t changed;   /* the first row after a command that changed the setup or state; count: there was none */
  char change[128]; /* that command in the form of events.csv: "transition smooth" */
  ethd_limits limits;
  ethd_dynamics dynamics;
} ethd__tape;

/* Loads a folder that a run has recorded. On failure *out is empty and message holds one line. [main] */
ETHD_MUST_CHECK ethd_status ethd__tape_load(const char *folder, ethd__tape *out, char message[ETHD_MESSAGE_MAX]);
void ethd__tape_free(ethd__tape *tape);

#endif
