#include "screen/hand.h"

#include <math.h>
#include <stdlib.h>

#define SHARE 0.4 /* of the way to the pointer at each sample */

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

void ethd__hand_lead(ethd__hand *h, double t, ethd_vec x) {
  size_t until = (size_t)(t / ETHD_HAND_STEP) + ETHD_HAND_LEAD + 1;
  for (; h->written < until && h->written < h->count; h->written++) {
    h->smooth = ethd_vec_add(h->smooth, ethd_vec_scale(SHARE, ethd_vec_sub(x, h->smooth)));
    h->samples[h->written].x = h->smooth.x;
    h->samples[h->written].y = h->smooth.y;
  }
  for (size_t i = h->written; i < h->count && i < h->written + ETHD_HAND_LEAD; i++) {
    h->samples[i].x = h->smooth.x;
    h->samples[i].y = h->smooth.y;
  }
}
