#include "finger/inbox.h"

#include <string.h>

#include "clock.h"

ethd_status ethd__inbox_open(ethd__inbox *in, double rate) {
  pthread_mutex_init(&in->lock, NULL);
  in->gap_ns = (int64_t)(1.5e9 / rate);
  return ethd_cell_create(sizeof in->newest, &in->cell, NULL);
}

void ethd__inbox_close(ethd__inbox *in) {
  ethd_cell_destroy(in->cell);
  pthread_mutex_destroy(&in->lock);
}

void ethd__inbox_put(ethd__inbox *in) { ethd_cell_put(in->cell, &in->newest); }

void ethd__inbox_stamp(ethd__inbox *in, int64_t sample_ns, int64_t arrival_ns) {
  ethd__sighting *s = &in->newest;
  s->sample_ns = ethd__clock_after(s->sample_ns, sample_ns);
  s->arrival_ns = arrival_ns;
}

void ethd__inbox_judge(ethd__inbox *in, bool is_good) {
  ethd__sighting *s = &in->newest;
  s->readings += is_good;
  s->refused += !is_good;
  s->refused_in_a_row = is_good ? 0 : s->refused_in_a_row + 1;
}

static int64_t rows_of(const ethd__inbox *in, int64_t now_ns) {
  const ethd__sighting *s = &in->taken;
  int64_t rows = 0;
  if (s->lost != in->lost || (s->readings && now_ns - s->arrival_ns > in->gap_ns))
    rows |= ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST);
  if (s->jumps != in->jumps) rows |= ETHD_FAULT_BIT(ETHD_FAULT_BOARD_CLOCK);
  if (s->refused_in_a_row >= ETHD__REFUSED_MAX) rows |= ETHD_FAULT_BIT(ETHD_FAULT_SENSOR);
  return rows;
}

/* Reads the newest reading and adds its rows; returns whether it is new at this tick. */
static bool take(ethd__inbox *in, int64_t now_ns, int64_t *faults) {
  const ethd__sighting *s = &in->taken;
  (void)!ethd_cell_take(in->cell, &in->taken);
  *faults |= rows_of(in, now_ns);
  in->lost = s->lost;
  in->jumps = s->jumps;
  if (s->readings == in->read || s->sample_ns > now_ns) return false;
  in->read = s->readings;
  return true;
}

void ethd__inbox_read(ethd__inbox *in, int64_t now_ns, ethd_sense *out) {
  const ethd__sighting *s = &in->taken;
  if (!take(in, now_ns, &out->faults)) return;
  out->have |= s->have;
  out->sample_ns = s->sample_ns;
  ethd_vec_put((ethd_vec){s->centre.x, s->centre.y}, out->centre);
  out->finger_noise = s->noise;
}

void ethd__inbox_read_space(ethd__inbox *in, int64_t now_ns, ethd_space_sense *out) {
  const ethd__sighting *s = &in->taken;
  if (!take(in, now_ns, &out->faults)) return;
  out->have |= ETHD_SPACE_HAVE_READING | (s->v_noise > 0 ? ETHD_SPACE_HAVE_READING_V : 0);
  out->sample_ns = s->sample_ns;
  ethd_vec3_put(s->centre, out->reading);
  ethd_vec3_put(s->v, out->reading_v);
  out->reading_noise = s->noise;
  out->reading_v_noise = s->v_noise;
}

uint32_t ethd__inbox_figures(ethd__inbox *in, ethd_figure *out, uint32_t max) {
  pthread_mutex_lock(&in->lock);
  const ethd__sighting s = in->newest;
  pthread_mutex_unlock(&in->lock);
  const ethd_figure all[] = {{"finger readings", "1", (double)s.readings},
                             {"finger readings lost", "1", (double)s.lost},
                             {"finger readings refused", "1", (double)s.refused},
                             {"finger clock jumps", "1", (double)s.jumps}};
  uint32_t n = sizeof all / sizeof *all;
  if (n > max) n = max;
  memcpy(out, all, n * sizeof *out);
  return n;
}
