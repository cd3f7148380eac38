/* The input of a replay: a CSV of joint angles and the finger, or the ring's distances. */
#ifndef ETHD__APPS_TRACE_IN_TRACE_IN_H
#define ETHD__APPS_TRACE_IN_TRACE_IN_H

#include "text/csv.h"

typedef struct ethd__trace_in {
  ethd_csv csv;
  int t, q[2], dq[2], finger[4]; /* columns; dq -1: not given */
  int t_ring, rays[ETHD_RAYS];
  bool ring; /* the finger comes from frames of the ring */
} ethd__trace_in;

/* Reads and checks everything: columns that must be there, times that must rise, numbers that must be
   finite. */
ETHD_MUST_CHECK ethd_status ethd__trace_in_read(const char *path, ethd__trace_in *out, char message[ETHD_MESSAGE_MAX]);

/* Returns row `row` as the controller's input. */
ethd_sense ethd__trace_in_sense(const ethd__trace_in *in, size_t row);

void ethd__trace_in_free(ethd__trace_in *in);

#endif
