#include "proximity_ring/board_clock.h"

#define DRIFT_MAX 0.05 /* ceramic resonators are good to 0.005; a broken one is followed up to here */
#define SPAN_MIN 0.3   /* s that points must span before their slope is used */
#define PERIOD_US (1e6 / ETHD__FRAME_RATE)
#define TOLERANCE_US 100 /* between a frame's time and its sequence, as times are whole us */
#define LATE_MAX 150     /* periods that board 0 may lose at once */
#define EARLY_MAX 0.005  /* s below a settled envelope: a frame that comes earlier shows a jump of the clock */
#define SETTLED 4        /* blocks after which the envelope is settled */

/* ---- order of frames ---- */

/* Returns whether the times of two frames fit their sequence. While board 0 is late, t_us goes on and seq doesn't; the
   frame whose flag says so may itself be lost. */
static bool follows(uint16_t seq, uint32_t t_us, const ethd__ring_frame *next) {
  double steps = (uint16_t)(next->seq - seq), passed = (uint32_t)(next->t_us - t_us);
  double extra = passed - steps * PERIOD_US;
  if (steps == 0 || extra < -TOLERANCE_US) return false;
  if (extra <= TOLERANCE_US) return true;
  bool may_be_late = steps > 1 || (next->flags & ETHD__FRAME_LATE);
  double periods = extra / PERIOD_US, whole = (double)(int64_t)(periods + 0.5), rest = periods - whole;
  return may_be_late && whole <= LATE_MAX && rest * rest * PERIOD_US * PERIOD_US <= TOLERANCE_US * TOLERANCE_US;
}

static bool is_reset(const ethd__ring_frame *frame) {
  return (frame->flags & ETHD__FRAME_FIRST) && frame->seq == 0 && frame->t_us < 1000000;
}

/* ---- envelope ---- */

static double above(const ethd__board_clock *c, ethd__clock_point p) { return p.y - (c->offset + c->drift * p.x); }

/* Returns a positive number when c lies to the left of the line from a to b; b is then a corner of the lower hull. */
static double turn(ethd__clock_point a, ethd__clock_point b, ethd__clock_point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Replaces the last blocks' points, oldest first, by their lower hull; returns the number of its corners. */
static uint32_t hull(const ethd__board_clock *c, ethd__clock_point out[ETHD__CLOCK_BLOCKS], double *mean) {
  uint32_t count = c->blocks < ETHD__CLOCK_BLOCKS ? c->blocks : ETHD__CLOCK_BLOCKS, n = 0;
  *mean = 0;
  for (uint32_t i = 0; i < count; i++) {
    ethd__clock_point p = c->points[(c->blocks - count + i) % ETHD__CLOCK_BLOCKS];
    while (n >= 2 && turn(out[n - 2], out[n - 1], p) <= 0) n--;
    out[n++] = p;
    *mean += p.x / count;
  }
  return n;
}

static double slope(const ethd__clock_point *corners, uint32_t n, double mean) {
  uint32_t i = 1;
  while (i + 1 < n && corners[i].x < mean) i++;
  double s = (corners[i].y - corners[i - 1].y) / (corners[i].x - corners[i - 1].x);
  return s > DRIFT_MAX ? DRIFT_MAX : s < -DRIFT_MAX ? -DRIFT_MAX : s;
}

static void fit(ethd__board_clock *c) {
  ethd__clock_point corners[ETHD__CLOCK_BLOCKS];
  double mean;
  uint32_t n = hull(c, corners, &mean);
  if (n >= 2 && corners[n - 1].x - corners[0].x >= SPAN_MIN) c->drift = slope(corners, n, mean);
  for (uint32_t i = 0; i < n; i++) {
    double y = above(c, corners[i]);
    if (i == 0 || y < 0) c->offset += y;
  }
}

static void collect(ethd__board_clock *c, ethd__clock_point p) {
  if (c->in_block == 0 || above(c, p) < above(c, c->block)) c->block = p;
  if (++c->in_block == ETHD__CLOCK_BLOCK) {
    c->points[c->blocks++ % ETHD__CLOCK_BLOCKS] = c->block;
    c->in_block = 0;
    fit(c);
  }
  double y = above(c, p);
  if (y < 0) c->offset += y;
}

/* ---- frames ---- */

static void begin(ethd__board_clock *c, const ethd__ring_frame *frame, int64_t arrival_ns) {
  c->base_ns = arrival_ns;
  c->board_us = 0;
  c->offset = 0;
  c->in_block = c->blocks = 0;
  c->started = true;
  c->doubtful = false;
  c->t_us = frame->t_us;
}

static ethd__clock_point place(const ethd__board_clock *c, const ethd__ring_frame *frame, int64_t arrival_ns) {
  int64_t board_us = c->board_us + (uint32_t)(frame->t_us - c->t_us);
  return (ethd__clock_point){1e-6 * (double)board_us, 1e-9 * (double)(arrival_ns - c->base_ns - 1000 * board_us)};
}

static void accept(ethd__board_clock *c, const ethd__ring_frame *frame, int64_t arrival_ns, int64_t *t_ns) {
  ethd__clock_point p = place(c, frame, arrival_ns);
  c->board_us += (uint32_t)(frame->t_us - c->t_us);
  c->t_us = frame->t_us;
  c->seq = frame->seq;
  c->doubtful = false;
  collect(c, p);
  double floor_ns = 1e9 * (c->offset + c->drift * p.x - c->delay);
  *t_ns = c->base_ns + 1000 * c->board_us + (int64_t)floor_ns;
}

static bool in_step(const ethd__board_clock *c, const ethd__ring_frame *frame, int64_t arrival_ns) {
  if (!follows(c->seq, c->t_us, frame)) return false;
  return c->blocks < SETTLED || above(c, place(c, frame, arrival_ns)) > -EARLY_MAX;
}

ethd__clock_verdict ethd__board_clock_step(ethd__board_clock *c, const ethd__ring_frame *frame, int64_t arrival_ns,
                                           int64_t *t_ns) {
  ethd__clock_verdict verdict = c->doubtful ? ETHD__CLOCK_RETURNED : ETHD__CLOCK_GOOD;
  if (c->started && (is_reset(frame) || !in_step(c, frame, arrival_ns))) {
    if (!is_reset(frame) && !(c->doubtful && follows(c->doubt.seq, c->doubt.t_us, frame))) {
      c->doubt = *frame;
      c->doubtful = true;
      c->doubts++;
      return ETHD__CLOCK_DOUBTFUL;
    }
    c->started = false;
    c->jumps++;
    verdict = ETHD__CLOCK_JUMPED;
  }
  if (!c->started) begin(c, frame, arrival_ns);
  accept(c, frame, arrival_ns, t_ns);
  return verdict;
}

void ethd__board_clock_restart(ethd__board_clock *c) { c->started = c->doubtful = false; }
