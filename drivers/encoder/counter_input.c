#include "encoder/counter_input.h"

#include <errno.h>
#include <linux/counter.h>

#define EVENTS 64    /* events that one call reads at most */
#define CALLS_MAX 64 /* calls for one sample at most; further events wait for the next sample */

/* ---- opening ---- */

ethd_status ethd__counter_input_open(const ethd__counter_settings *settings, ethd__counter_input *in,
                                     char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  in->calls = ethd__counter_calls_now;
  in->settings = settings;
  for (int j = 0; j < 2; j++) in->counts[j] = (ethd__kernel_count){.device = -1, .count = -1};
  for (int j = 0; j < 2 && !status; j++)
    status = ethd__kernel_count_open(in->calls, settings, j, j ? &in->counts[0] : NULL, &in->counts[j], message);
  for (int j = 0; j < 2 && !status; j++) status = ethd__kernel_count_watch(in->calls, settings, j, in->counts, message);
  return status;
}

void ethd__counter_input_close(ethd__counter_input *in) {
  if (!in->calls) return;
  for (int j = 2; j--;) ethd__kernel_count_close(in->calls, &in->counts[j]);
  in->calls = NULL;
}

/* ---- events ---- */

static void raise_by_one(uint64_t *count) { __atomic_store_n(count, *count + 1, __ATOMIC_RELAXED); }

static int joint_of(const ethd__counter_input *in, int device, const struct counter_event *e) {
  for (int j = 0; j < 2; j++)
    if (in->counts[j].device == device && e->watch.component.parent == in->settings->count[j]) return j;
  return -1;
}

static void take_event(ethd__counter_input *in, int device, const struct counter_event *e) {
  int j = joint_of(in, device, e);
  raise_by_one(&in->events);
  if (j < 0 || e->status) {
    raise_by_one(&in->bad_events);
  } else if (e->watch.event == COUNTER_EVENT_INDEX) {
    in->latest.index[j] = e->value;
    in->latest.marks[j]++;
  } else if (e->watch.event == COUNTER_EVENT_CHANGE_OF_STATE) {
    in->latest.edge_ns[j] = (int64_t)e->timestamp;
    in->latest.raw[j] = e->value;
  }
}

/* Reads all events that wait; -1 when the device is gone. */
static int take_events(ethd__counter_input *in, int j) {
  struct counter_event events[EVENTS];
  if (in->counts[j].shared) return 0;
  for (int call = 0; call < CALLS_MAX; call++) {
    ssize_t n = in->calls->read(in->counts[j].device, events, sizeof events);
    if (n < 0 && errno != EAGAIN && errno != EINTR && errno != ENODATA) return -1;
    if (n <= 0) return 0;
    for (size_t i = 0; i < (size_t)n / sizeof *events; i++) take_event(in, in->counts[j].device, &events[i]);
    if ((size_t)n < sizeof events) return 0;
  }
  return 0;
}

/* ---- counts ---- */

/* Takes the count. If its edges are known, its value is that at the last edge, so that instant and value belong
   together. */
static int take_count(ethd__counter_input *in, int j) {
  uint64_t raw;
  if (in->settings->p[ETHD__COUNTER_STAMPS] != 0 && in->latest.edge_ns[j]) return 0;
  if (ethd__kernel_count_read(in->calls, &in->counts[j], &raw)) return -1;
  in->latest.raw[j] = raw;
  return 0;
}

ethd_status ethd__counter_sample(ethd__counter_input *in, int64_t now_ns) {
  int bad = 0;
  in->latest.time_ns = now_ns;
  for (int j = 0; j < 2; j++) {
    bad |= take_events(in, j); /* this may bring the edge that take_count asks for */
    bad |= take_count(in, j);
  }
  if (!bad) return ETHD_OK;
  raise_by_one(&in->failures);
  return ETHD_E_DEVICE;
}
