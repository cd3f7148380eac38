#include "screen/hand.h"

#include <math.h>
#include <stdlib.h>

#define SHARE 0.35   /* of the distance to the pointer at each sample */
#define RESTED 0.025 /* s without an event: the pointer stood still */

ethd_status ethd__hand_create(ethd__hand *h, ethd_vec x, double seconds) {
  *h = (ethd__hand){.count = (size_t)ceil(seconds / ETHD_HAND_STEP) + ETHD_HAND_LEAD + 1, .smooth = x};
  h->samples = malloc(h->count * sizeof *h->samples);
  if (!h->samples) return ETHD_E_MEMORY;
  for (size_t i = 0; i < h->count; i++) h->samples[i] = (ethd_path_sample){ETHD_HAND_STEP * (double)i, x.x, x.y};
  h->written = ETHD_HAND_LEAD;
  return ETHD_OK;
}

void ethd__hand_free(ethd__hand *h) {
  free(h->samples);
  *h = (ethd__hand){0};
}

ethd_path ethd__hand_path(const ethd__hand *h) { return (ethd_path){.samples = h->samples, .sample_count = h->count}; }

void ethd__hand_move(ethd__hand *h, double t, ethd_vec x) {
  h->event[h->events++ % ETHD_HAND_EVENTS] = (ethd__hand_event){t, x};
}

/* The pointer's position at t: interpolated linearly between the events around t; a resting pointer began to move
   shortly before its next event. */
static ethd_vec pointer_at(const ethd__hand *h, double t) {
  size_t oldest = h->events > ETHD_HAND_EVENTS ? h->events - ETHD_HAND_EVENTS : 0, i = h->events;
  while (i > oldest && h->event[(i - 1) % ETHD_HAND_EVENTS].t > t) i--;
  const ethd__hand_event *before = &h->event[(i - 1) % ETHD_HAND_EVENTS], *after = &h->event[i % ETHD_HAND_EVENTS];
  if (i == oldest) return h->events ? h->event[i % ETHD_HAND_EVENTS].x : h->smooth;
  if (i == h->events) return before->x;
  double from = fmax(before->t, after->t - RESTED);
  if (t <= from) return before->x;
  return ethd_vec_add(before->x, ethd_vec_scale((t - from) / (after->t - from), ethd_vec_sub(after->x, before->x)));
}

void ethd__hand_lead(ethd__hand *h, double t) {
  size_t until = (size_t)(t / ETHD_HAND_STEP) + ETHD_HAND_LEAD + 1;
  for (; h->written < until && h->written < h->count; h->written++) {
    ethd_vec x = pointer_at(h, ETHD_HAND_STEP * ((double)h->written - ETHD_HAND_LEAD) - ETHD_HAND_DELAY);
    h->smooth = ethd_vec_add(h->smooth, ethd_vec_scale(SHARE, ethd_vec_sub(x, h->smooth)));
    h->samples[h->written].x = h->smooth.x;
    h->samples[h->written].y = h->smooth.y;
  }
  for (size_t i = h->written; i < h->count && i < h->written + ETHD_HAND_LEAD; i++) {
    h->samples[i].x = h->smooth.x;
    h->samples[i].y = h->smooth.y;
  }
}
