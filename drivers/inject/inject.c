#include "inject/inject.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "add_sense.h"
#include "inject/values.h"

#define COMMANDS_MAX 1024 /* commands that a delay may hold back; a power of two */
#define READINGS_MAX 64   /* readings that wait */

typedef struct stamped {
  int64_t t;
  ethd_command command;
} stamped;

typedef struct held_reading {
  int64_t due;
  ethd_sense sense;
} held_reading;

struct ethd__inject {
  ethd__script script;
  int64_t start_ns; /* of the first sample */
  int64_t now;      /* ns since then */
  int32_t started;  /* like start_ns above: written by [rt], read by I/O threads */
  uint64_t done;    /* how many faults were injected */
  uint64_t commands, readings;
  ethd_sense last; /* reading */
  held_reading held[READINGS_MAX];
  stamped written[COMMANDS_MAX];
};

ethd__inject *ethd__inject_create(const ethd__script *script) {
  ethd__inject *in = calloc(1, sizeof *in);
  if (in) in->script = *script;
  return in;
}

void ethd__inject_free(ethd__inject *in) {
  if (!in) return;
  ethd__script_free(&in->script);
  free(in);
}

/* ---- what is due ---- */

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

static void hold_reading(ethd__inject *in, double delay, const ethd_sense *s) {
  held_reading *r = &in->held[in->readings++ % READINGS_MAX];
  r->due = in->now + (int64_t)rint(1e9 * delay);
  r->sense = *s;
}

/* Takes the newest sample that is due; it and all older ones leave the queue. */
static void release_readings(ethd__inject *in, ethd_sense *s) {
  for (uint64_t back = 0; back < READINGS_MAX && back < in->readings; back++) {
    held_reading *r = &in->held[(in->readings - 1 - back) % READINGS_MAX];
    if (r->due > in->now) continue;
    if (!(s->have & ETHD__READING)) ethd__sense_put_reading(&r->sense, s);
    for (; back < READINGS_MAX && back < in->readings; back++)
      in->held[(in->readings - 1 - back) % READINGS_MAX].due = INT64_MAX;
  }
}

static void spoil_reading(ethd__inject *in, ethd_sense *s) {
  const ethd__injection *i = s->have & ETHD__READING ? reading_fault(in) : NULL;
  if (i && i->kind == ETHD__INJECT_FREEZE) {
    int64_t stamp = s->sample_ns;
    if (in->last.have & ETHD__READING) ethd__sense_put_reading(&in->last, s);
    s->sample_ns = stamp;
  } else if (i) {
    if (i->kind == ETHD__INJECT_DELAY) hold_reading(in, i->by, s);
    s->have &= ~ETHD__READING;
  }
  release_readings(in, s);
  if (s->have & ETHD__READING) in->last = *s;
}

static void raise_faults(ethd__inject *in, ethd_sense *s) {
  uint32_t at = 0;
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_FAULT, &at));) {
    int64_t bit = ETHD_FAULT_BIT(i->first + 1);
    s->faults |= bit;
    if (i->kind == ETHD__INJECT_GRAVE) s->grave |= bit;
  }
}

ethd_status ethd__inject_before(ethd__inject *in, int64_t now_ns, ethd_sense *out) ETHD_RT {
  if (!in->started) in->start_ns = now_ns;
  __atomic_store_n(&in->started, 1, __ATOMIC_RELEASE);
  in->now = now_ns - in->start_ns;
  if (is_told(in, ETHD__INJECT_READ, ETHD__INJECT_FAIL)) return ETHD_E_DEVICE;
  memset(out, 0, sizeof *out);
  raise_faults(in, out);
  return is_told(in, ETHD__INJECT_READ, ETHD__INJECT_STALE) ? ETHD_STATUS_STALE : ETHD_OK;
}

void ethd__inject_after(ethd__inject *in, ethd_status status, ethd_sense *s, ethd_sense *out) ETHD_RT {
  for (uint32_t i = 0; i < in->script.count; i++)
    in->done += ethd__inject_values(&in->script.at[i], in->now, !status, s);
  spoil_reading(in, s);
  ethd__sense_add(s, !status || s->faults || s->grave, out);
}

/* ---- commands ---- */

/* Returns the newest command that is `delay` old. */
static ethd_command delayed(const ethd__inject *in, double delay) {
  int64_t until = in->now - (int64_t)rint(1e9 * delay);
  for (uint64_t back = 0; back < COMMANDS_MAX && back < in->commands; back++) {
    const stamped *w = &in->written[(in->commands - 1 - back) % COMMANDS_MAX];
    if (w->t <= until) return w->command;
  }
  return (ethd_command){.safe = 0};
}

ethd_status ethd__inject_command(ethd__inject *in, ethd_command *command) ETHD_RT {
  const ethd_command asked = *command;
  uint32_t at = 0;
  in->written[in->commands++ % COMMANDS_MAX] = (stamped){in->now, asked};
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_WRITE, &at));) {
    if (i->kind == ETHD__INJECT_FAIL) return ETHD_E_DEVICE;
    if (i->kind == ETHD__INJECT_DROP) return ETHD_STATUS_EMPTY;
    if (i->kind == ETHD__INJECT_DELAY) *command = delayed(in, i->by);
    if (i->kind == ETHD__INJECT_SCALE)
      for (int j = 0; j < 2; j++) command->torque[j] *= i->by;
  }
  return ETHD_OK;
}

/* ---- the other calls ---- */

ethd_status ethd__inject_start(ethd__inject *in) {
  in->started = 0;
  in->now = 0;
  in->commands = in->readings = 0;
  in->last.have = 0;
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
