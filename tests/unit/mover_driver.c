#include "unit/mover_driver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

mover_device mover_device_at(ethd_vec3 at, int late) {
  mover_device d = {.at = at, .late = late, .period = 1e-3, .finger_at = at, .speed = INFINITY, .travel = INFINITY};
  d.fail_read = d.fail_write = d.stale_from = d.stale_until = -1;
  for (int i = 0; i <= LATE_MAX; i++) d.past[i] = at;
  return d;
}

static ethd_status mover_device_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  (void)message;
  mover_device *d = *out = malloc(sizeof *d);
  if (!d) return ETHD_E_MEMORY;
  *d = mover_device_at((ethd_vec3){0, 0, 0}, 0);
  d->period = def->space->period;
  return ETHD_OK;
}

static ethd_status mover_device_start(void *device) {
  mover_device *d = device;
  d->starts++;
  d->is_safe = d->cut = false;
  d->v = (ethd_vec3){0, 0, 0};
  return ETHD_OK;
}

static ethd_status mover_device_read(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  mover_device *d = device;
  const int n = d->reads++;
  out->faults |= d->faults;
  if (n == d->fail_read) return ETHD_E_DEVICE;
  if (n >= d->stale_from && n < d->stale_until) return ETHD_STATUS_STALE;
  out->time_ns = now_ns;
  out->have |= ETHD_SPACE_HAVE_FINGER | (d->cut ? ETHD_SPACE_HAVE_COMMANDED : 0);
  ethd_vec3_put(d->at, out->x);
  ethd_vec3_put(d->v, out->v);
  ethd_vec3_put(ethd_vec3_add(d->finger_at, ethd_vec3_scale(1e-9 * (double)now_ns, d->finger_v)), out->finger);
  ethd_vec3_put(d->finger_v, out->finger_v);
  if (d->cut) ethd_vec3_put(d->v, out->commanded);
  return ETHD_OK;
}

static ethd_status mover_device_write(void *device, int64_t now_ns, const ethd_space_command *command) ETHD_RT {
  mover_device *d = device;
  (void)now_ns;
  d->written[d->writes % MOVES_MAX] = *command;
  if (d->writes++ == d->fail_write) return ETHD_E_DEVICE;
  d->v = d->is_safe ? (ethd_vec3){0, 0, 0} : ethd_vec3_of(command->value);
  const double speed = ethd_vec3_norm(d->v);
  d->cut = speed > d->speed;
  if (d->cut) d->v = ethd_vec3_scale(d->speed / speed, d->v);
  const ethd_vec3 to = ethd_vec3_add(d->at, ethd_vec3_scale(d->period, d->v));
  if (fmax(fabs(to.x), fmax(fabs(to.y), fabs(to.z))) > d->travel) {
    d->v = (ethd_vec3){0, 0, 0};
    d->cut = true;
  }
  d->at = ethd_vec3_add(d->at, ethd_vec3_scale(d->period, d->v));
  memmove(d->past + 1, d->past, sizeof d->past - sizeof *d->past);
  d->past[0] = d->at;
  return ETHD_OK;
}

static void mover_device_safe(void *device) ETHD_RT {
  mover_device *d = device;
  d->safes++;
  d->is_safe = true;
}

const ethd_driver mover_driver = {.size = sizeof mover_driver,
                                  .abi = ETHD_DRIVER_ABI,
                                  .id = "mover",
                                  .brief = "an effector in space",
                                  .open = mover_device_open,
                                  .start = mover_device_start,
                                  .safe = mover_device_safe,
                                  .close = free,
                                  .read_space = mover_device_read,
                                  .write_space = mover_device_write,
                                  .safe_is = ETHD_SAFE_NO_SPEED};

uint32_t walls_near(void *walls_, const ethd_space_sense *sense, ethd_surface out[ETHD_SURFACES_MAX]) ETHD_RT {
  walls *w = walls_;
  w->asked++;
  for (uint32_t i = 0; i < w->count; i++) out[i] = wall_at(ethd_vec3_of(sense->x), w->n[i], w->c[i], (int32_t)i);
  return w->count;
}
