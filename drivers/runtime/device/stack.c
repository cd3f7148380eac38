#include "device/stack.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "settings/config_parts.h"

void ethd__stack_foreign(ethd__stack *s, uint32_t i, const char *doing) {
  if (!s->at[i].is_foreign || !ethd__foreign_code) return;
  if (doing) snprintf(s->doing, sizeof s->doing, "%s of the driver %s", doing, s->at[i].driver->id);
  ethd__foreign_code(doing ? s->doing : NULL, s->hang_time);
}

/* ---- [rt] ---- */

static ethd_status worse(ethd_status a, ethd_status b) {
  if (a < 0 || b < 0) return a < b ? a : b;
  return a ? a : b;
}

static ethd_status read_all(void *stack, int64_t now_ns, ethd_sense *out) ETHD_RT {
  const ethd__stack *s = stack;
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < s->count; i++)
    if (s->at[i].driver->read) status = worse(status, s->at[i].driver->read(s->at[i].device, now_ns, out));
  return status;
}

static ethd_status write_all(void *stack, int64_t now_ns, const ethd_command *command) ETHD_RT {
  const ethd__stack *s = stack;
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < s->count; i++)
    if (s->at[i].driver->write) status = worse(status, s->at[i].driver->write(s->at[i].device, now_ns, command));
  return status;
}

static void safe_all(void *stack) ETHD_RT {
  const ethd__stack *s = stack;
  for (uint32_t i = 0; i < s->count; i++)
    if (s->at[i].driver->safe) s->at[i].driver->safe(s->at[i].device);
}

/* ---- a child made by fork ---- */

/* The parent process still uses the lines, the sockets and the guardian's page. A driver that is called in the child
   would change them for the parent. */
static bool is_forked(const ethd__stack *s) { return s->process != getpid(); }

/* ---- I/O ---- */

static uint32_t units(const void *stack) {
  const ethd__stack *s = stack;
  uint32_t sum = 0;
  for (uint32_t i = 0; i < s->count; i++) sum += s->at[i].units;
  return sum;
}

static ethd_status service(void *stack, uint32_t unit, int64_t now_ns) {
  const ethd__stack *s = stack;
  if (is_forked(s)) return ETHD_E_DEVICE;
  for (uint32_t i = 0; i < s->count; i++) {
    uint32_t own = s->at[i].units;
    if (unit < own) return s->at[i].driver->service(s->at[i].device, unit, now_ns);
    unit -= own;
  }
  return ETHD_E_ARGUMENT;
}

/* ---- [main] ---- */

static ethd_status start_one(ethd__stack *s, uint32_t i) {
  if (!s->at[i].driver->start) return ETHD_OK;
  ethd__stack_foreign(s, i, "start");
  ethd_status status = s->at[i].driver->start(s->at[i].device);
  ethd__stack_foreign(s, i, NULL);
  return status;
}

static ethd_status stop_one(ethd__stack *s, uint32_t i) {
  const ethd_driver *driver = s->at[i].driver;
  ethd_status status = ETHD_OK;
  ethd__stack_foreign(s, i, "stop");
  if (driver->stop)
    status = driver->stop(s->at[i].device);
  else if (driver->safe)
    driver->safe(s->at[i].device);
  ethd__stack_foreign(s, i, NULL);
  return status;
}

/* Returns which driver is the i-th to start, from 0, and the i-th from the end to stop. Those that take torques start
   last: a drive that is enabled doesn't wait for another driver, however long that takes. */
static uint32_t turn(const ethd__stack *s, uint32_t i) {
  uint32_t order[ETHD_DRIVERS_MAX] = {0}, n = 0;
  for (uint32_t k = 0; k < s->count; k++)
    if (!s->at[k].driver->write) order[n++] = k;
  for (uint32_t k = 0; k < s->count; k++)
    if (s->at[k].driver->write) order[n++] = k;
  return order[i];
}

/* Starts all drivers; when one refuses, those that have started are stopped. */
static ethd_status start(void *stack) {
  ethd__stack *s = stack;
  if (is_forked(s)) return ETHD_E_DEVICE;
  for (uint32_t i = 0; i < s->count; i++) {
    ethd_status status = start_one(s, turn(s, i));
    if (status >= 0) continue;
    while (i--) (void)!stop_one(s, turn(s, i));
    return status;
  }
  return ETHD_OK;
}

static ethd_status stop(void *stack) {
  ethd__stack *s = stack;
  ethd_status status = ETHD_OK;
  if (is_forked(s)) return ETHD_E_DEVICE;
  for (uint32_t i = s->count; i--;) status = worse(status, stop_one(s, turn(s, i)));
  return status;
}

static void close_all(void *stack) {
  ethd__stack *s = stack;
  if (!s) return;
  for (uint32_t i = is_forked(s) ? 0 : s->count; i--;)
    if (s->at[i].device) s->at[i].driver->close(s->at[i].device);
  free(s);
}

static ethd_limits limits(const void *stack) {
  const ethd__stack *s = stack;
  ethd_limits most = ethd_limits_none();
  for (uint32_t i = 0; i < s->count; i++) {
    if (!s->at[i].driver->limits) continue;
    ethd_limits own = s->at[i].driver->limits(s->at[i].device);
    most = ethd_limits_narrower(&most, &own);
  }
  return most;
}

static uint32_t figures(const void *stack, ethd_figure *out, uint32_t max) {
  const ethd__stack *s = stack;
  uint32_t n = 0;
  for (uint32_t i = 0; i < s->count; i++) {
    if (!s->at[i].driver->figures) continue;
    uint32_t own = s->at[i].driver->figures(s->at[i].device, out + n, max - n);
    n += own < max - n ? own : max - n;
  }
  return n;
}

static const char *remark(const void *stack, uint32_t i) {
  const ethd__stack *s = stack;
  const char *own = NULL;
  for (uint32_t k = 0; k < s->count && !own; k++) {
    if (!s->at[k].driver->remark) continue;
    uint32_t n = 0;
    while (n < ETHD_REMARKS_MAX && s->at[k].driver->remark(s->at[k].device, n)) n++;
    if (i < n) own = s->at[k].driver->remark(s->at[k].device, i);
    i -= i < n ? i : n;
  }
  return own;
}

static void clear(void *stack) {
  const ethd__stack *s = stack;
  for (uint32_t i = 0; i < s->count && !is_forked(s); i++)
    if (s->at[i].driver->clear) s->at[i].driver->clear(s->at[i].device);
}

static ethd_status home(void *stack, const double q[2]) {
  const ethd__stack *s = stack;
  ethd_status status = ETHD_E_ARGUMENT; /* none of the drivers has anything to find out */
  if (is_forked(s)) return ETHD_E_DEVICE;
  for (uint32_t i = 0; i < s->count; i++) {
    if (!s->at[i].driver->home) continue;
    status = s->at[i].driver->home(s->at[i].device, q);
    if (status) return status;
  }
  return status;
}

static const char *why(const void *stack) {
  const ethd__stack *s = stack;
  const char *says = NULL;
  for (uint32_t i = 0; i < s->count && !(says && says[0]); i++)
    if (s->at[i].driver->why) says = s->at[i].driver->why(s->at[i].device);
  return says ? says : "";
}

/* Later drivers add what earlier ones don't know. */
static ethd_dynamics dynamics(const void *stack) {
  const ethd__stack *s = stack;
  ethd_dynamics all = ethd_dynamics_unknown();
  for (uint32_t i = 0; i < s->count; i++) {
    if (!s->at[i].driver->dynamics) continue;
    ethd_dynamics own = s->at[i].driver->dynamics(s->at[i].device);
    all = ethd_dynamics_known(&all, &own);
  }
  return all;
}

const ethd_driver ethd__driver_stack = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "stack",
    .brief = "several drivers behind one device",
    .start = start,
    .read = read_all,
    .write = write_all,
    .units = units,
    .service = service,
    .safe = safe_all,
    .stop = stop,
    .close = close_all,
    .limits = limits,
    .figures = figures,
    .remark = remark,
    .clear = clear,
    .home = home,
    .why = why,
    .dynamics = dynamics,
};
