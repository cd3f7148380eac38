#include "inject/inject.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "add_sense.h"
#include "inject/values.h"

#define COMMANDS_MAX 1024 /* commands that a delay may hold back; a power of two */
#define READINGS_MAX 64   /* readings, likewise */

typedef struct stamped {
  int64_t t;
  ethd_command command;
} stamped;

typedef struct held_reading {
  int64_t due;
  ethd_sense sense;
} held_reading;

typedef struct inject {
  const ethd_driver *driver;
  void *device;
  ethd__script script;
  int64_t start_ns; /* of the first sample */
  int64_t now;      /* ns since then */
  int32_t started;  /* like start_ns above: written by [rt], read by I/O threads */
  uint64_t done;    /* how many faults were injected */
  uint64_t commands, readings;
  ethd_sense last; /* reading */
  held_reading held[READINGS_MAX];
  stamped written[COMMANDS_MAX];
} inject;

ethd_status ethd__inject_around(const ethd_driver *driver, void *device, ethd__script *script, void **out) {
  inject *in = calloc(1, sizeof *in);
  *out = in;
  if (!in) {
    driver->close(device);
    ethd__script_free(script);
    return ETHD_E_MEMORY;
  }
  in->driver = driver;
  in->device = device;
  in->script = *script;
  *script = (ethd__script){.count = 0};
  return ETHD_OK;
}

/* ---- what is due ---- */

static bool is_due(const ethd__injection *i, int64_t t) { return t >= i->from_ns && t < i->until_ns; }

/* Returns the channel's next due injection from `at` on; NULL when none is left. */
static ethd__injection *next_due(inject *in, ethd__inject_channel channel, uint32_t *at) {
  while (*at < in->script.count) {
    ethd__injection *i = &in->script.at[(*at)++];
    if (i->channel != channel || !is_due(i, in->now)) continue;
    in->done++;
    return i;
  }
  return NULL;
}

static bool is_told(inject *in, ethd__inject_channel channel, ethd__inject_kind kind) {
  uint32_t at = 0;
  for (const ethd__injection *i; (i = next_due(in, channel, &at));)
    if (i->kind == kind) return true;
  return false;
}

/* ---- samples ---- */

static const ethd__injection *reading_fault(inject *in) {
  uint32_t at = 0;
  return next_due(in, ETHD__INJECT_READING, &at);
}

static void hold_reading(inject *in, double delay, const ethd_sense *s) {
  held_reading *r = &in->held[in->readings++ % READINGS_MAX];
  r->due = in->now + (int64_t)rint(1e9 * delay);
  r->sense = *s;
}

/* Takes the newest sample that is due; it and all older ones leave the queue. */
static void release_readings(inject *in, ethd_sense *s) {
  for (uint64_t back = 0; back < READINGS_MAX && back < in->readings; back++) {
    held_reading *r = &in->held[(in->readings - 1 - back) % READINGS_MAX];
    if (r->due > in->now) continue;
    if (!(s->have & ETHD__READING)) ethd__sense_put_reading(&r->sense, s);
    for (; back < READINGS_MAX && back < in->readings; back++)
      in->held[(in->readings - 1 - back) % READINGS_MAX].due = INT64_MAX;
  }
}

static void spoil_reading(inject *in, ethd_sense *s) {
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

static void raise_faults(inject *in, ethd_sense *s) {
  uint32_t at = 0;
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_FAULT, &at));) {
    int64_t bit = ETHD_FAULT_BIT(i->first + 1);
    s->faults |= bit;
    if (i->kind == ETHD__INJECT_GRAVE) s->grave |= bit;
  }
}

static ethd_status inject_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  inject *in = device;
  ethd_sense s;
  if (!in->started) in->start_ns = now_ns;
  __atomic_store_n(&in->started, 1, __ATOMIC_RELEASE);
  in->now = now_ns - in->start_ns;
  if (is_told(in, ETHD__INJECT_READ, ETHD__INJECT_FAIL)) return ETHD_E_DEVICE;
  memset(&s, 0, sizeof s);
  raise_faults(in, &s);
  int stale = is_told(in, ETHD__INJECT_READ, ETHD__INJECT_STALE);
  ethd_status status = stale ? ETHD_STATUS_STALE : in->driver->read(in->device, now_ns, &s);
  if (status < 0) return status;
  for (uint32_t i = 0; i < in->script.count; i++)
    in->done += ethd__inject_values(&in->script.at[i], in->now, !status, &s);
  spoil_reading(in, &s);
  ethd__sense_add(&s, !status || s.faults || s.grave, out);
  return status;
}

/* ---- commands ---- */

/* Returns the newest command that is `delay` old. */
static ethd_command delayed(const inject *in, double delay) {
  int64_t until = in->now - (int64_t)rint(1e9 * delay);
  for (uint64_t back = 0; back < COMMANDS_MAX && back < in->commands; back++) {
    const stamped *w = &in->written[(in->commands - 1 - back) % COMMANDS_MAX];
    if (w->t <= until) return w->command;
  }
  return (ethd_command){.safe = 0};
}

static ethd_status inject_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  inject *in = device;
  ethd_command c = *command;
  uint32_t at = 0;
  in->written[in->commands++ % COMMANDS_MAX] = (stamped){in->now, *command};
  for (const ethd__injection *i; (i = next_due(in, ETHD__INJECT_WRITE, &at));) {
    if (i->kind == ETHD__INJECT_FAIL) return ETHD_E_DEVICE;
    if (i->kind == ETHD__INJECT_DROP) return ETHD_OK;
    if (i->kind == ETHD__INJECT_DELAY) c = delayed(in, i->by);
    if (i->kind == ETHD__INJECT_SCALE)
      for (int j = 0; j < 2; j++) c.torque[j] *= i->by;
  }
  return in->driver->write(in->device, now_ns, &c);
}

static void inject_safe(void *device) ETHD_RT {
  inject *in = device;
  in->driver->safe(in->device);
}

/* ---- the other calls ---- */

static ethd_status inject_start(void *device) {
  inject *in = device;
  in->started = 0;
  in->now = 0;
  in->commands = in->readings = 0;
  in->last.have = 0;
  for (uint32_t i = 0; i < in->script.count; i++) in->script.at[i].begun = false;
  if (is_told(in, ETHD__INJECT_START, ETHD__INJECT_FAIL)) return ETHD_E_DEVICE;
  return in->driver->start(in->device);
}

static ethd_status inject_service(void *device, uint32_t unit, int64_t now_ns) {
  inject *in = device;
  int64_t t = __atomic_load_n(&in->started, __ATOMIC_ACQUIRE) ? now_ns - in->start_ns : 0;
  for (uint32_t i = 0; i < in->script.count; i++)
    if (in->script.at[i].channel == ETHD__INJECT_SERVICE && is_due(&in->script.at[i], t))
      return in->script.at[i].kind == ETHD__INJECT_FAIL ? ETHD_E_DEVICE : ETHD_STATUS_EMPTY;
  return in->driver->service(in->device, unit, now_ns);
}

static ethd_status inject_stop(void *device) {
  inject *in = device;
  return in->driver->stop(in->device);
}

static void inject_close(void *device) {
  inject *in = device;
  if (!in) return;
  in->driver->close(in->device);
  ethd__script_free(&in->script);
  free(in);
}

static uint32_t inject_units(const void *device) {
  const inject *in = device;
  return in->driver->units(in->device);
}

static ethd_limits inject_limits(const void *device) {
  const inject *in = device;
  return in->driver->limits(in->device);
}

static uint32_t inject_figures(const void *device, ethd_figure *out, uint32_t max) {
  const inject *in = device;
  uint32_t n = in->driver->figures(in->device, out, max);
  if (n < max) out[n++] = (ethd_figure){"injected faults", "1", (double)in->done};
  return n;
}

/* The first remark says that this device does wrong by a script; the wrapped device's own follow. */
static const char *inject_remark(const void *device, uint32_t i) {
  const inject *in = device;
  if (i == 0) return "faults are injected: this is no run to trust";
  return in->driver->remark(in->device, i - 1);
}

static void inject_clear(void *device) {
  inject *in = device;
  in->driver->clear(in->device);
}

static ethd_status inject_home(void *device, const double q[2]) {
  inject *in = device;
  return in->driver->home(in->device, q);
}

static const char *inject_why(const void *device) {
  const inject *in = device;
  return in->driver->why(in->device);
}

static ethd_dynamics inject_dynamics(const void *device) {
  const inject *in = device;
  return in->driver->dynamics(in->device);
}

const ethd_driver ethd__driver_inject = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "inject",
    .brief = "does wrong by a script what another device does right",
    .start = inject_start,
    .read = inject_read,
    .write = inject_write,
    .units = inject_units,
    .service = inject_service,
    .safe = inject_safe,
    .stop = inject_stop,
    .close = inject_close,
    .limits = inject_limits,
    .figures = inject_figures,
    .remark = inject_remark,
    .clear = inject_clear,
    .home = inject_home,
    .why = inject_why,
    .dynamics = inject_dynamics,
};
