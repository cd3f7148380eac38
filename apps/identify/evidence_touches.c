/* Finds where in a recording a finger that was away touches the ring. */
#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "identify/evidence.h"

#define BEFORE ETHD__TOUCH_BEFORE /* s before the first reading that is near, which show the finger's path, */
#define AFTER ETHD__TOUCH_AFTER   /* and s from it on, in which the finger presses and bounces */

static bool is_whole(const ethd__evidence *e, const ethd_trace *rows, const unsigned char *good, size_t from,
                     size_t to) {
  for (size_t i = from; i < to; i++)
    if (!good[i] || (i > from && !ethd__evidence_follows(e, &rows[i]))) return false;
  return true;
}

static void add(ethd__evidence *e, const ethd_setup *setup, size_t first, int count) {
  size_t delivery = e->delivery_count;
  while (delivery > 0 && e->deliveries[delivery - 1].recording == e->recording_count - 1 &&
         e->deliveries[delivery - 1].tick >= first)
    delivery--;
  ethd__onset *longer = realloc(e->onsets, (e->onset_count + 1) * sizeof *longer);
  if (!longer) ethd__fail_memory();
  e->onsets = longer;
  e->onsets[e->onset_count++] = (ethd__onset){
      first, first - ETHD__BACK, count, e->recording_count - 1, delivery, setup->ring_radius - setup->finger_radius};
}

void ethd__evidence_touches(ethd__evidence *e, const ethd_setup *setup, const ethd_trace *rows, size_t count,
                            const unsigned char *good, size_t base) {
  size_t before = (size_t)rint(BEFORE / e->period), after = (size_t)rint(AFTER / e->period), free_since = 0;
  for (size_t i = 1; i < count; i++) {
    if (rows[i].sense.time_ns <= rows[i - 1].sense.time_ns) free_since = i;
    if (!ethd__evidence_is_near(setup, &rows[i])) continue;
    size_t from = i - (i > before ? before : i);
    bool comes = from >= free_since + ETHD__BACK;
    free_since = i + 1;
    if (!comes || i + after > count || !is_whole(e, rows, good, from - ETHD__BACK, i + after)) continue;
    add(e, setup, base + from, (int)(before + after));
  }
}
