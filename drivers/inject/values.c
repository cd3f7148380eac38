#include "inject/values.h"

#include <math.h>

double *ethd__inject_plane_numbers(ethd__inject_channel channel, bool is_new, ethd__inject_sense *sense) {
  ethd_sense *s = &sense->plane;
  switch (channel) {
  case ETHD__INJECT_Q: return is_new ? s->q : NULL;
  case ETHD__INJECT_DQ: return is_new && (s->have & ETHD_HAVE_DQ) ? s->dq : NULL;
  case ETHD__INJECT_CENTRE: return s->have & ETHD_HAVE_CENTRE ? s->centre : NULL;
  case ETHD__INJECT_FINGER: return s->have & ETHD_HAVE_FINGER ? s->finger : NULL;
  case ETHD__INJECT_RING: return s->have & ETHD_HAVE_RING ? s->ring : NULL;
  case ETHD__INJECT_RAY: return s->have & ETHD_HAVE_RAYS ? s->rays : NULL;
  default: return NULL;
  }
}

double *ethd__inject_space_numbers(ethd__inject_channel channel, bool is_new, ethd__inject_sense *sense) {
  ethd_space_sense *s = &sense->space;
  switch (channel) {
  case ETHD__INJECT_X: return is_new ? s->x : NULL;
  case ETHD__INJECT_V: return is_new ? s->v : NULL;
  case ETHD__INJECT_CENTRE: return s->have & ETHD_SPACE_HAVE_READING ? s->reading : NULL;
  case ETHD__INJECT_FINGER: return s->have & ETHD_SPACE_HAVE_FINGER ? s->finger : NULL;
  default: return NULL;
  }
}

/* Deterministic noise in [-1, 1) for one channel of one line at one instant. */
static double draw(int line, uint32_t i, int64_t t) {
  uint64_t z = ((uint64_t)line << 40) + ((uint64_t)i << 56) + (uint64_t)t;
  z = (z + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return (double)((z ^ z >> 31) >> 11) * 0x1p-52 - 1;
}

static double spoilt(const ethd__injection *in, uint32_t i, int64_t t, double value) {
  switch (in->kind) {
  case ETHD__INJECT_FREEZE: return in->held[i];
  case ETHD__INJECT_OFFSET: return value + in->by;
  case ETHD__INJECT_REVERSE: return in->held[i] - (value - in->held[i]);
  case ETHD__INJECT_SCALE: return value * in->by;
  case ETHD__INJECT_NOISE: return value + in->by * draw(in->line, i, t);
  case ETHD__INJECT_SET_TO: return in->by;
  case ETHD__INJECT_NAN: return (double)NAN;
  default: return value;
  }
}

static bool shift_time(ethd__injection *in, int64_t *time_ns) {
  if (!in->begun) in->held[0] = (double)*time_ns;
  in->begun = true;
  *time_ns = in->kind == ETHD__INJECT_FREEZE ? (int64_t)in->held[0] : *time_ns + (int64_t)rint(1e9 * in->by);
  return true;
}

bool ethd__inject_values(ethd__injection *in, int64_t t, int64_t *time_ns, double *at) {
  if (t < in->from_ns || t >= in->until_ns) {
    in->begun = false;
    return false;
  }
  if (in->channel == ETHD__INJECT_TIME) return time_ns ? shift_time(in, time_ns) : false;
  if (!at) return false;
  for (uint32_t i = 0; i < in->count; i++) {
    double *value = at + in->first + i;
    if (!in->begun) in->held[i] = *value;
    *value = spoilt(in, i, t, *value);
  }
  in->begun = true;
  return true;
}
