#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "control/controller.h"
#include "error.h"

/* Makes a plan, and refuses a stop_time in which full torque can't brake the device. ethd_setup_check can't refuse it,
   because a device adds its mass and its limits to the configuration's. */
static ethd_status prepare(const ethd_setup *setup, ethd__plan *out, ethd_error *error) {
  ethd_status status = ethd__plan_prepare(setup, out, error);
  if (status < 0) return status;
  const double most = setup->limits.stop_time < (double)INFINITY ? setup->limits.stop_time : ETHD_STOP_TIME;
  if (most >= out->brake_time) return ETHD_OK;
  return ethd__refuse(error, ETHD_E_RANGE, "limits.stop_time", (ethd__found){most, out->brake_time, (double)INFINITY});
}

ethd_status ethd_control_create(const ethd_setup *setup, ethd_control **out, ethd_error *error) {
  *out = NULL;
  ethd_control *control = aligned_alloc(_Alignof(ethd_control), sizeof *control);
  if (!control) return ethd__error(error, ETHD_E_MEMORY, "controller");
  memset(control, 0, sizeof *control);
  ethd_status status = prepare(setup, &control->plans[0], error);
  if (status < 0) {
    free(control);
    return status;
  }
  control->period = setup->period;
  ethd_control_reset(control);
  *out = control;
  return ETHD_OK;
}

void ethd_control_destroy(ethd_control *control) { free(control); }

ethd_status ethd_control_post(ethd_control *control, const ethd_setup *setup, ethd_error *error) {
  if (atomic_load_explicit(&control->mail.posted, memory_order_acquire)) return ETHD_STATUS_BUSY;
  ethd__plan *spare = &control->plans[1 - control->mail.ruling];
  ethd_status status = prepare(setup, spare, error);
  if (status < 0) return status;
  if (setup->period != control->period)
    return ethd__refuse(error, ETHD_E_ARGUMENT, "loop.period",
                        (ethd__found){setup->period, control->period, control->period});
  atomic_store_explicit(&control->mail.posted, 1, memory_order_release);
  return ETHD_OK;
}
