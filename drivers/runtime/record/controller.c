#include "record/controller.h"

#include <math.h>
#include <string.h>

/* ---- the plane ---- */

static ethd_status plane_create(const void *setup, void **out, ethd_error *error) {
  ethd_control *control;
  ethd_status status = ethd_control_create(setup, &control, error);
  *out = control;
  return status;
}

static void plane_destroy(void *control) { ethd_control_destroy(control); }

static ethd_status plane_post(void *control, const void *setup, ethd_error *error) {
  return ethd_control_post(control, setup, error);
}

static ethd_status plane_poll(void *control, ethd_event *out) { return ethd_control_poll(control, out); }
static void plane_restart(void *control) { ethd_control_restart(control); }
static void plane_acknowledge(void *control) { ethd_control_acknowledge(control); }
static double plane_clean_time(void *control) { return ethd_control_clean_time(control); }
static void plane_counters(void *control, ethd_counters *out) { ethd_control_counters(control, out); }
static void plane_set_heat(void *control, const double heat[2]) { ethd_control_set_heat(control, heat); }
static void plane_set_memory(void *control, const double *memory) { ethd_control_set_memory(control, memory); }

static void plane_step(void *control, const void *row, void *trace) {
  ethd_command command;
  (void)ethd_control_step(control, &((const ethd_trace *)row)->sense, &command, trace);
}

static const ethd__controller plane = {.columns = ethd_trace_columns,
                                       .row_bytes = sizeof(ethd_trace),
                                       .create = plane_create,
                                       .destroy = plane_destroy,
                                       .post = plane_post,
                                       .poll = plane_poll,
                                       .restart = plane_restart,
                                       .acknowledge = plane_acknowledge,
                                       .clean_time = plane_clean_time,
                                       .counters = plane_counters,
                                       .set_heat = plane_set_heat,
                                       .set_memory = plane_set_memory,
                                       .step = plane_step};

/* ---- space ---- */

static ethd_status space_create(const void *setup, void **out, ethd_error *error) {
  ethd_space *space;
  ethd_status status = ethd_space_create(setup, &space, error);
  *out = space;
  return status;
}

static void space_destroy(void *control) { ethd_space_destroy(control); }

static ethd_status space_post(void *control, const void *setup, ethd_error *error) {
  return ethd_space_post(control, setup, error);
}

static ethd_status space_poll(void *control, ethd_event *out) { return ethd_space_poll(control, out); }
static void space_restart(void *control) { ethd_space_restart(control); }
static void space_acknowledge(void *control) { ethd_space_acknowledge(control); }
static double space_clean_time(void *control) { return ethd_space_clean_time(control); }
static void space_counters(void *control, ethd_counters *out) { ethd_space_counters(control, out); }

/* Gives the surfaces that the tick used; an impossible one if it refused them. */
static uint32_t surfaces_of(const ethd_space_trace *row, ethd_surface out[ETHD_NEAR_MAX]) {
  const double nan = (double)NAN;
  out[0] = (ethd_surface){.point = {nan, nan, nan}};
  if (row->near == ETHD_NEAR_REFUSED) return 1;
  if (row->near < 0 || row->near > ETHD_NEAR_MAX) return 0; /* no controller writes this: the replay differs */
  for (int64_t i = 0; i < row->near; i++)
    out[i] = (ethd_surface){.point = ethd_vec3_of(row->near_point + 3 * i),
                            .n = ethd_vec3_of(row->near_n + 3 * i),
                            .v = ethd_vec3_of(row->near_v + 3 * i),
                            .id = (int32_t)row->near_id[i],
                            .material = (int32_t)row->near_material[i]};
  return (uint32_t)row->near;
}

static void space_step(void *control, const void *row, void *trace) {
  const ethd_space_trace *recorded = row;
  ethd_surface near[ETHD_NEAR_MAX];
  ethd_space_command command;
  const uint32_t count = surfaces_of(recorded, near);
  (void)ethd_space_step(control, &recorded->sense, near, count, &command, trace);
}

/* Surfaces without room in a row are counted in `overflow`, but can't be replayed. */
static const ethd__controller space = {.columns = ethd_space_trace_columns,
                                       .row_bytes = sizeof(ethd_space_trace),
                                       .unrepeated = "overflow",
                                       .create = space_create,
                                       .destroy = space_destroy,
                                       .post = space_post,
                                       .poll = space_poll,
                                       .restart = space_restart,
                                       .acknowledge = space_acknowledge,
                                       .clean_time = space_clean_time,
                                       .counters = space_counters,
                                       .step = space_step};

const ethd__controller *ethd__controller_of(const ethd_config *config) { return config->is_space ? &space : &plane; }
