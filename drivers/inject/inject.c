#include "inject/inject.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "add_sense.h"
#include "inject/values.h"

#define COMMANDS_MAX 1024 /* commands in a delay at most; a power of two */
#define READINGS_MAX 64   /* readings that wait */

typedef struct stamped {
  int64_t t;
  ethd__inject_order command;
} stamped;

typedef struct held_reading {
  int64_t due;
  ethd__inject_sense sense;
} held_reading;

/* ---- readings and commands of the two fronts ---- */

typedef struct inject_front {
  int64_t reading; /* bits of `have` */
  size_t sense;    /* bytes */
  double *(*numbers)(ethd__inject_channel channel, bool is_new, ethd__inject_sense *sense)ETHD_RT;
  void (*put)(const ethd__inject_sense *from, ethd__inject_sense *to) ETHD_RT;
  int64_t *(*stamp)(ethd__inject_sense *sense)ETHD_RT;
  void (*scale)(ethd__inject_order *command, double by) ETHD_RT;
} inject_front;

static void put_plane(const ethd__inject_sense *from, ethd__inject_sense *to) ETHD_RT {
  ethd__sense_put_reading(&from->plane, &to->plane);
}
static void put_space(const ethd__inject_sense *from, ethd__inject_sense *to) ETHD_RT {
  ethd__space_put_reading(&from->space, &to->space);
}
static int64_t *stamp_plane(ethd__inject_sense *s) ETHD_RT { return &s->plane.sample_ns; }
static int64_t *stamp_space(ethd__inject_sense *s) ETHD_RT { return &s->space.sample_ns; }
static void scale_plane(ethd__inject_order *c, double by) ETHD_RT {
  for (int i = 0; i < 2; i++) c->plane.torque[i] *= by;
}
static void scale_space(ethd__inject_order *c, double by) ETHD_RT {
  for (int i = 0; i < 3; i++) c->space.value[i] *= by;
}

static const inject_front plane = {ETHD__READING, sizeof(ethd_sense), ethd__inject_plane_numbers,
                                   put_plane,     stamp_plane,        scale_plane};
static const inject_front space = {
    ETHD__SPACE_READING, sizeof(ethd_space_sense), ethd__inject_space_numbers, put_space, stamp_space, scale_space};

struct ethd__inject {
  const inject_front *front;
  ethd__script script;
  int64_t start_ns; /* of the first sample */
  int64_t now;      /* ns since then */
  int32_t started;  /* like start_ns above: written by [rt], read by I/O threads */
  uint64_t done;    /* how many faults were injected */
  uint64_t commands, readings;
  ethd__inject_sense last; /* reading */
  held_reading held[READINGS_MAX];
  stamped written[COMMANDS_MAX];
};

ethd__inject *ethd__inject_create(const ethd__script *script, bool in_space) {
  ethd__inject *in = calloc(1, sizeof *in);
  if (in) in->script = *script;
  if (in) in->front = in_space ? &space : &plane;
  return in;
}

void ethd__inject_free(ethd__inject *in) {
  if (!in) return;
  ethd__script_free(&in->script);
  free(in);
}

/* ---- due injections ---- */

static bool is_due(const ethd__injection *i, int64_t t) { return t >= i->from_ns && t < i->until_ns; }

/* Returns the channel's next due injection from `at` on; NULL when none is left. */
static ethd__injection *next_due(ethd__inject *in, ethd__inject_channel channel, uint32_t *at) {
  while (*at < in->script.count) {
    ethd__injection *i = &in->script.at[(*at)++];
    if (i->channel != channel || !is_due(i, in->now)) continue;
    in->done++;
    return i;
  }
  return NULL;
}

static bool is_told(ethd__inject *in, ethd__inject_channel channel, ethd__inject_kind kind) {
  uint32_t at = 0;
  for (const ethd__injection *i; (i = next_due(in, channel, &at));)
    if (i->kind == kind) return true;
  return false;
}

/* ---- samples ---- */

static const ethd__injection *reading_fault(ethd__inject *in) {
  uint32_t at = 0;
  return next_due(in, ETHD__INJECT_READING, &at);
}

static void hold_reading(ethd__inject *in, double delay, const ethd__inject_sense *s) {
  held_reading *r = &in->held[in->readings++ % READINGS_MAX];
  r->due = in->now + (int64_t)rint(1e9 * delay);
  r->sense = *s;
}

/* Gives the newest sample that is due, and removes it and all older ones from the queue. */
static void release_readings(ethd__inject *in, ethd__inject_sense *s) {
  for (uint64_t back = 0; back < READINGS_MAX && back < in->readings; back++) {
    held_reading *r = &in->held[(in->readings - 1 - back) % READINGS_MAX];
    if (r->due > in->now) continue;
    if (!(s->plane.have & in->front->reading)) in->front->put(&r->sense, s);
    for (; back < READINGS_MAX && back < in->readings; back++)
      in->held[(in->readings - 1 - back) % READINGS_MAX].due = INT64_MAX;
  }
}

static void spoil_reading(ethd__inject *in, ethd__inject_sense *s) {
  const int64_t bits = in->front->reading;
  const ethd__injection *i = s->plane.have & bits ? reading_fault(in) : NULL;
  if (i && i->kind == ETHD__INJECT_FREEZE) {
    int64_t stamp = *in->front->stamp(s);
    if (in->last.plane.have & bits) in->front->put(&in->last, s);
    *in->front->stamp(s) = stamp;
  } else if (i) {
    if (i->kind == ETHD__INJECT_DELAY) hold_reading(in, i->by, s);
    s->plane.have &= ~bits;
  }
  release_readings(in, s);
  if (s->plane.have & bits) in->last = *s;
}

static void raise_faults(ethd__inject *in, ethd__inject_sense *s) {
  uint32_t at = 0;
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_FAULT, &at));) {
    int64_t bit = ETHD_FAULT_BIT(i->first + 1);
    s->plane.faults |= bit;
    if (i->kind == ETHD__INJECT_GRAVE) s->plane.grave |= bit;
  }
}

ethd_status ethd__inject_before(ethd__inject *in, int64_t now_ns, ethd__inject_sense *out) ETHD_RT {
  if (!in->started) in->start_ns = now_ns;
  __atomic_store_n(&in->started, 1, __ATOMIC_RELEASE);
  in->now = now_ns - in->start_ns;
  if (is_told(in, ETHD__INJECT_READ, ETHD__INJECT_FAIL)) return ETHD_E_DEVICE;
  memset(out, 0, in->front->sense);
  raise_faults(in, out);
  return is_told(in, ETHD__INJECT_READ, ETHD__INJECT_STALE) ? ETHD_STATUS_STALE : ETHD_OK;
}

bool ethd__inject_after(ethd__inject *in, ethd_status status, ethd__inject_sense *s) ETHD_RT {
  for (uint32_t k = 0; k < in->script.count; k++) {
    ethd__injection *i = &in->script.at[k];
    in->done +=
        ethd__inject_values(i, in->now, status ? NULL : &s->plane.time_ns, in->front->numbers(i->channel, !status, s));
  }
  spoil_reading(in, s);
  return !status || s->plane.faults || s->plane.grave;
}

/* ---- commands ---- */

/* Returns the newest command that is at least `delay` old; before there is one, 0 times the present one. */
static ethd__inject_order delayed(const ethd__inject *in, double delay, const ethd__inject_order *asked) {
  ethd__inject_order nothing = *asked;
  int64_t until = in->now - (int64_t)rint(1e9 * delay);
  for (uint64_t back = 0; back < COMMANDS_MAX && back < in->commands; back++) {
    const stamped *w = &in->written[(in->commands - 1 - back) % COMMANDS_MAX];
    if (w->t <= until) return w->command;
  }
  in->front->scale(&nothing, 0);
  return nothing;
}

ethd_status ethd__inject_command(ethd__inject *in, ethd__inject_order *command) ETHD_RT {
  const ethd__inject_order asked = *command;
  uint32_t at = 0;
  in->written[in->commands++ % COMMANDS_MAX] = (stamped){in->now, asked};
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_WRITE, &at));) {
    if (i->kind == ETHD__INJECT_FAIL) return ETHD_E_DEVICE;
    if (i->kind == ETHD__INJECT_DROP) return ETHD_STATUS_EMPTY;
    if (i->kind == ETHD__INJECT_DELAY) *command = delayed(in, i->by, &asked);
    if (i->kind == ETHD__INJECT_SCALE) in->front->scale(command, i->by);
  }
  return ETHD_OK;
}

/* ---- the other calls ---- */

ethd_status ethd__inject_start(ethd__inject *in) {
  in->started = 0;
  in->now = 0;
  in->commands = in->readings = 0;
  in->last.plane.have = 0;
  for (uint32_t i = 0; i < in->script.count; i++) in->script.at[i].begun = false;
  return is_told(in, ETHD__INJECT_START, ETHD__INJECT_FAIL) ? ETHD_E_DEVICE : ETHD_OK;
}

ethd_status ethd__inject_service(const ethd__inject *in, int64_t now_ns) {
  int64_t t = __atomic_load_n(&in->started, __ATOMIC_ACQUIRE) ? now_ns - in->start_ns : 0;
  for (uint32_t i = 0; i < in->script.count; i++)
    if (in->script.at[i].channel == ETHD__INJECT_SERVICE && is_due(&in->script.at[i], t))
      return in->script.at[i].kind == ETHD__INJECT_FAIL ? ETHD_E_DEVICE : ETHD_STATUS_EMPTY;
  return ETHD_OK;
}

ethd_figure ethd__inject_figure(const ethd__inject *in) {
  return (ethd_figure){"injected faults", "1", (double)in->done};
}
