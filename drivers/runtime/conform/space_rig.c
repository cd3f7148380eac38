#include "conform/space_rig.h"

#include <math.h>
#include <string.h>

#include "clock.h"

#define RAMP 1.0 /* m/s^2, N/ms: growth of a command if the setup has no limit */

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

static void time_call(ethd__space_rig *s, int64_t begin) {
  const int64_t took = ethd__clock_now() - begin;
  s->calls++;
  s->slow += took > s->r.period / 2;
  if (took > s->longest) s->longest = took;
}

static void note_sample(ethd__space_rig *s, const ethd_space_sense *now) {
  ethd__conform_rig *r = &s->r;
  const int64_t latest = r->def->device->is_virtual ? r->now : ethd__clock_now();
  r->finite &= is_finite(now->x) && is_finite(now->v);
  r->backwards += r->samples && now->time_ns < s->sense.time_ns;
  r->ahead += now->time_ns > latest;
  const ethd_vec3 took = now->have & ETHD_SPACE_HAVE_COMMANDED ? ethd_vec3_of(now->commanded) : s->written;
  s->way = ethd_vec3_add(s->way, ethd_vec3_scale(1e-9 * (double)r->period, took));
  r->samples++;
  s->sense = *now;
}

/* One period: I/O, read, and write, unless `command` is NULL. */
static void tick_space(ethd__space_rig *s, const ethd_vec3 *command) {
  ethd__conform_rig *r = &s->r;
  ethd_space_sense now = {0};
  ethd_space_command c = {.normal = {0, 0, 1}, .kind = r->def->device->space->kind};
  if (ethd__conform_stopped(r->def)) {
    ethd_device_safe(r->device);
    return;
  }
  ethd__conform_rig_await(r);
  for (uint32_t u = 0, n = ethd_device_units(r->device); u < n && r->def->device->is_virtual; u++)
    (void)!ethd_device_service(r->device, u, r->now);
  int64_t begin = ethd__clock_now();
  const ethd_status status = ethd_device_read_space(r->device, r->now, &now);
  time_call(s, begin);
  r->failed += status < 0;
  s->stale += status > 0;
  if (status == ETHD_OK) note_sample(s, &now);
  if (!command) return;
  if (s->sense.have & ETHD_SPACE_HAVE_NORMAL) memcpy(c.normal, s->sense.normal, sizeof c.normal); /* no rotation */
  ethd_vec3_put(*command, c.value);
  s->written = *command;
  begin = ethd__clock_now();
  r->failed += ethd_device_write_space(r->device, r->now, &c) < 0;
  time_call(s, begin);
}

void ethd__space_rig_run(ethd__space_rig *s, double seconds, ethd_vec3 to) {
  const ethd_space_setup *setup = s->r.def->device->space;
  const double rate = setup->kind == ETHD_SPACE_VELOCITY ? setup->acceleration : setup->force_rate;
  const double period = 1e-9 * (double)s->r.period, most = (isfinite(rate) ? rate : RAMP) * period;
  for (int k = 0, n = (int)ceil(seconds / period); k < n;) {
    const ethd_vec3 left = ethd_vec3_sub(to, s->written);
    const double length = ethd_vec3_norm(left);
    const ethd_vec3 next = length > most ? ethd_vec3_add(s->written, ethd_vec3_scale(most / length, left)) : to;
    tick_space(s, &next);
    k += length <= most || ethd__conform_stopped(s->r.def);
  }
}

bool ethd__space_rig_begin(const ethd_conform_def *def, ethd__space_rig *s, ethd_conform_answer *a) {
  memset(s, 0, sizeof *s);
  return ethd__conform_rig_begin(def, &s->r, a);
}

double ethd__space_rig_moved(ethd__space_rig *s, ethd_vec3 along, bool write, double seconds) {
  const ethd_vec3 from = ethd_vec3_of(s->sense.x), held = s->written;
  for (int k = 0, n = (int)ceil(seconds * 1e9 / (double)s->r.period); k < n; k++) tick_space(s, write ? &held : NULL);
  return ethd_vec3_dot(along, ethd_vec3_sub(ethd_vec3_of(s->sense.x), from));
}
