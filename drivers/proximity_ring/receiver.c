#include "proximity_ring/receiver.h"

#include "clock.h"

static bool receive(ethd__receiver *r, const ethd__ring_frame *frame, int64_t arrival_ns, ethd__ring_reading *out) {
  int64_t t_ns;
  ethd__clock_verdict verdict = ethd__board_clock_step(&r->clock, frame, arrival_ns, &t_ns);
  r->counts.board_clock += verdict == ETHD__CLOCK_DOUBTFUL || verdict == ETHD__CLOCK_JUMPED;
  if (verdict == ETHD__CLOCK_DOUBTFUL) return false;
  bool good = ethd__plausible_step(&r->plausible, &r->calibration, frame, out->rays);
  r->counts.frame_lost += !good || frame->lost;
  if (!good) return false;
  out->sample_ns = r->last_ns = ethd__clock_after(r->last_ns, t_ns + 1000 * ETHD__MIDDLE_US);
  out->out = r->plausible.out;
  ethd__drift_step(&r->drift, &r->calibration, frame, out->rays);
  out->has_drift = r->drift.is_off;
  r->counts.sensor += out->out != 0;
  r->counts.readings++;
  return true;
}

/* A corrupt frame counts as lost at once, before the gap in the sequence shows it. */
static void count_corrupt(ethd__receiver *r) {
  r->counts.frame_lost += r->decoder.counters.corrupt != r->corrupt;
  r->corrupt = r->decoder.counters.corrupt;
}

bool ethd__receiver_next(ethd__receiver *r, const uint8_t **at, const uint8_t *end, int64_t arrival_ns,
                         ethd__ring_reading *out) {
  ethd__ring_frame frame;
  while (ethd__decoder_next(&r->decoder, at, end, &frame)) {
    count_corrupt(r);
    if (receive(r, &frame, arrival_ns, out)) return true;
  }
  count_corrupt(r);
  return false;
}

void ethd__receiver_restart(ethd__receiver *r) {
  ethd__decoder_restart(&r->decoder);
  ethd__board_clock_restart(&r->clock);
  r->plausible.started = false;
  r->last_ns = 0;
}
