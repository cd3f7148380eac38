/* The kernel's counters of two joints, read by the I/O thread: events in their order, and present counts.

     index event   -> index, marks      edge event -> edge_ns, raw      count's attribute -> raw      */
#ifndef ETHD__ENCODER_COUNTER_INPUT_H
#define ETHD__ENCODER_COUNTER_INPUT_H

#include "encoder/counter.h"

/* The counters' state at an instant. */
typedef struct ethd__counter_snapshot {
  int64_t time_ns, edge_ns[2];         /* edge: when the count last changed; 0: not known yet */
  uint64_t raw[2], index[2], marks[2]; /* index: the count at the last mark; marks: their number so far */
} ethd__counter_snapshot;

typedef struct ethd__counter_input {
  const ethd__counter_calls *calls;
  const ethd__counter_settings *settings;
  ethd__kernel_count counts[2];
  ethd__counter_snapshot latest;
  uint64_t events, bad_events, failures; /* numbers so far; other threads may read them */
} ethd__counter_input;

/* Opens and watches both joints' counts; `settings` must outlive *out. The caller closes it, also after a failure.
   [main] */
ETHD_MUST_CHECK ethd_status ethd__counter_input_open(const ethd__counter_settings *settings, ethd__counter_input *out,
                                                     char message[ETHD_MESSAGE_MAX]);
void ethd__counter_input_close(ethd__counter_input *in);

/* Updates in->latest at `now_ns`; ETHD_E_DEVICE: a device is gone, or can't be read. */
ETHD_MUST_CHECK ethd_status ethd__counter_sample(ethd__counter_input *in, int64_t now_ns);

#endif
