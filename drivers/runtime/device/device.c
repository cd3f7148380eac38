#include "device/device.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "add_sense.h"
#include "settings/config_parts.h"

void ethd__device_foreign(ethd_device *d, uint32_t i, const char *doing) {
  if (!d->at[i].is_foreign || !ethd__foreign_code) return;
  if (doing) snprintf(d->doing, sizeof d->doing, "%s of the driver %s", doing, d->at[i].driver->id);
  ethd__foreign_code(doing ? d->doing : NULL, d->hang_time);
}

/* ---- [rt] ---- */

static ethd_status worse(ethd_status a, ethd_status b) {
  if (a < 0 || b < 0) return a < b ? a : b;
  return a ? a : b;
}

static ethd_status read_all(const ethd_device *d, int64_t now_ns, ethd_sense *out) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->read) status = worse(status, d->at[i].driver->read(d->at[i].state, now_ns, out));
  return status;
}

ethd_status ethd_device_read(ethd_device *d, int64_t now_ns, ethd_sense *out) ETHD_RT {
  ethd__inject_sense own;
  if (!d->inject) return read_all(d, now_ns, out);
  ethd_status status = ethd__inject_before(d->inject, now_ns, &own);
  if (!status) status = read_all(d, now_ns, &own.plane);
  if (status >= 0) ethd__sense_add(&own.plane, ethd__inject_after(d->inject, status, &own), out);
  return status;
}

ethd_status ethd_device_write(ethd_device *d, int64_t now_ns, const ethd_command *command) ETHD_RT {
  ethd__inject_order own = {.plane = *command};
  ethd_status status = d->inject ? ethd__inject_command(d->inject, &own) : ETHD_OK;
  if (status) return status < 0 ? status : ETHD_OK; /* positive: it is dropped */
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->write) status = worse(status, d->at[i].driver->write(d->at[i].state, now_ns, &own.plane));
  return status;
}

static ethd_status read_all_space(const ethd_device *d, int64_t now_ns, ethd_space_sense *out) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->read_space) status = worse(status, d->at[i].driver->read_space(d->at[i].state, now_ns, out));
  return status;
}

ethd_status ethd_device_read_space(ethd_device *d, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  ethd__inject_sense own;
  if (!d->inject) return read_all_space(d, now_ns, out);
  ethd_status status = ethd__inject_before(d->inject, now_ns, &own);
  if (!status) status = read_all_space(d, now_ns, &own.space);
  if (status >= 0) ethd__space_add(&own.space, ethd__inject_after(d->inject, status, &own), out);
  return status;
}

ethd_status ethd_device_write_space(ethd_device *d, int64_t now_ns, const ethd_space_command *command) ETHD_RT {
  ethd__inject_order own = {.space = *command};
  ethd_status status = d->inject ? ethd__inject_command(d->inject, &own) : ETHD_OK;
  if (status) return status < 0 ? status : ETHD_OK; /* positive: it is dropped */
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->write_space)
      status = worse(status, d->at[i].driver->write_space(d->at[i].state, now_ns, &own.space));
  return status;
}

ethd_ability ethd_device_able(const ethd_device *d, const double n[3]) ETHD_RT {
  const double nan = (double)NAN;
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->able) return d->at[i].driver->able(d->at[i].state, n);
  return (ethd_ability){nan, nan, nan, nan, nan, nan};
}

int32_t ethd_device_in_space(const ethd_device *d) ETHD_RT { return d->in_space; }

static bool takes_commands(const ethd_device *d, uint32_t i) {
  const ethd_driver *driver = d->at[i].driver;
  return d->in_space ? !!driver->write_space : !!driver->write;
}

ethd_safe_state ethd_device_safe_is(const ethd_device *d) ETHD_RT {
  uint32_t i = 0;
  while (i < d->count && !takes_commands(d, i)) i++;
  return i < d->count ? d->at[i].driver->safe_is : ETHD_SAFE_NO_TORQUE;
}

void ethd_device_safe(ethd_device *d) ETHD_RT {
  for (uint32_t i = 0; i < d->count; i++)
    if (d->at[i].driver->safe) d->at[i].driver->safe(d->at[i].state);
}

/* ---- a child made by fork ---- */

/* The parent process still uses the lines, the sockets and the guardian's page. A driver call in the child would change
   them for the parent. */
static bool is_forked(const ethd_device *d) { return d->process != getpid(); }

/* ---- I/O ---- */

uint32_t ethd_device_units(const ethd_device *d) {
  uint32_t sum = 0;
  for (uint32_t i = 0; i < d->count; i++) sum += d->at[i].units;
  return sum;
}

ethd_status ethd_device_service(ethd_device *d, uint32_t unit, int64_t now_ns) {
  if (is_forked(d)) return ETHD_E_DEVICE;
  ethd_status status = d->inject ? ethd__inject_service(d->inject, now_ns) : ETHD_OK;
  if (status) return status;
  for (uint32_t i = 0; i < d->count; i++) {
    uint32_t own = d->at[i].units;
    if (unit < own) return d->at[i].driver->service(d->at[i].state, unit, now_ns);
    unit -= own;
  }
  return ETHD_E_ARGUMENT;
}

/* ---- [main] ---- */

static ethd_status start_one(ethd_device *d, uint32_t i) {
  if (!d->at[i].driver->start) return ETHD_OK;
  ethd__device_foreign(d, i, "start");
  ethd_status status = d->at[i].driver->start(d->at[i].state);
  ethd__device_foreign(d, i, NULL);
  return status;
}

static ethd_status stop_one(ethd_device *d, uint32_t i) {
  const ethd_driver *driver = d->at[i].driver;
  ethd_status status = ETHD_OK;
  ethd__device_foreign(d, i, "stop");
  if (driver->stop)
    status = driver->stop(d->at[i].state);
  else if (driver->safe)
    driver->safe(d->at[i].state);
  ethd__device_foreign(d, i, NULL);
  return status;
}

/* Returns the i-th driver to start, from 0, which is the i-th from the end to stop. Drivers that take commands start
   last: an enabled drive must not wait for a slow driver. */
static uint32_t turn(const ethd_device *d, uint32_t i) {
  uint32_t order[ETHD_DRIVERS_MAX] = {0}, n = 0;
  for (uint32_t k = 0; k < d->count; k++)
    if (!takes_commands(d, k)) order[n++] = k;
  for (uint32_t k = 0; k < d->count; k++)
    if (takes_commands(d, k)) order[n++] = k;
  return order[i];
}

/* A device that is only prepared can't start. */
ethd_status ethd_device_start(ethd_device *d) {
  if (is_forked(d) || d->only_prepares) return ETHD_E_DEVICE;
  if (d->inject && ethd__inject_start(d->inject)) return ETHD_E_DEVICE;
  for (uint32_t i = 0; i < d->count; i++) {
    ethd_status status = start_one(d, turn(d, i));
    if (!status) continue;
    if (status > 0) (void)!stop_one(d, turn(d, i));
    while (i--) (void)!stop_one(d, turn(d, i));
    return status > 0 ? ETHD_E_DEVICE : status;
  }
  return ETHD_OK;
}

ethd_status ethd_device_stop(ethd_device *d) {
  ethd_status status = ETHD_OK;
  if (is_forked(d)) return ETHD_E_DEVICE;
  for (uint32_t i = d->count; i--;) status = worse(status, stop_one(d, turn(d, i)));
  return status;
}

void ethd_device_close(ethd_device *d) {
  if (!d) return;
  for (uint32_t i = is_forked(d) ? 0 : d->count; i--;)
    if (d->at[i].state) d->at[i].driver->close(d->at[i].state);
  ethd__inject_free(d->inject);
  free(d);
}

ethd_limits ethd_device_limits(const ethd_device *d) {
  ethd_limits most = ethd_limits_none();
  for (uint32_t i = 0; i < d->count; i++) {
    if (!d->at[i].driver->limits) continue;
    ethd_limits own = d->at[i].driver->limits(d->at[i].state);
    most = ethd_limits_narrower(&most, &own);
  }
  return most;
}

uint32_t ethd_device_figures(const ethd_device *d, ethd_figure *out, uint32_t max) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < d->count; i++) {
    if (!d->at[i].driver->figures) continue;
    uint32_t own = d->at[i].driver->figures(d->at[i].state, out + n, max - n);
    n += own < max - n ? own : max - n;
  }
  if (d->inject && n < max) out[n++] = ethd__inject_figure(d->inject);
  return n;
}

/* Describes the state after `safe`; NULL for the usual one, no torque in the plane. */
static const char *safe_remark(const ethd_device *d) {
  switch (ethd_device_safe_is(d)) {
  case ETHD_SAFE_NO_SPEED: return "safe is zero speed: the drives hold their positions with full force";
  case ETHD_SAFE_BRAKES: return "safe is closed brakes: a caught finger stays caught until they open";
  default: return d->in_space ? "safe is zero torque: an arm without counterweights falls" : NULL;
  }
}

const char *ethd_device_remark(const ethd_device *d, uint32_t i) {
  const char *own = NULL;
  if (d->inject && !i--) return "faults are injected: don't trust this run";
  if (safe_remark(d) && !i--) return safe_remark(d);
  for (uint32_t k = 0; k < d->count && !own; k++) {
    if (!d->at[k].driver->remark) continue;
    uint32_t n = 0;
    while (n < ETHD_REMARKS_MAX && d->at[k].driver->remark(d->at[k].state, n)) n++;
    if (i < n) own = d->at[k].driver->remark(d->at[k].state, i);
    i -= i < n ? i : n;
  }
  return own;
}

void ethd_device_clear(ethd_device *d) {
  for (uint32_t i = 0; i < d->count && !is_forked(d); i++)
    if (d->at[i].driver->clear) d->at[i].driver->clear(d->at[i].state);
}

ethd_status ethd_device_home(ethd_device *d, const double q[2]) {
  ethd_status status = ETHD_E_ARGUMENT; /* no driver has a home */
  if (is_forked(d)) return ETHD_E_DEVICE;
  for (uint32_t i = 0; i < d->count; i++) {
    if (!d->at[i].driver->home) continue;
    status = d->at[i].driver->home(d->at[i].state, q);
    if (status) return status;
  }
  return status;
}

const char *ethd_device_why(const ethd_device *d) {
  const char *says = NULL;
  for (uint32_t i = 0; i < d->count && !(says && says[0]); i++)
    if (d->at[i].driver->why) says = d->at[i].driver->why(d->at[i].state);
  return says ? says : "";
}

/* Later drivers fill the numbers that earlier ones don't know. */
ethd_dynamics ethd_device_dynamics(const ethd_device *d) {
  ethd_dynamics all = ethd_dynamics_unknown();
  for (uint32_t i = 0; i < d->count; i++) {
    if (!d->at[i].driver->dynamics) continue;
    ethd_dynamics own = d->at[i].driver->dynamics(d->at[i].state);
    all = ethd_dynamics_known(&all, &own);
  }
  return all;
}
