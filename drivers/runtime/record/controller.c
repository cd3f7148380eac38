#include "record/controller.h"

#include <math.h>
#include <string.h>

/* The functions of a front: those of control.h or space.h behind a `void *`. */
#define FRONT(front, type)                                                                              \
  static ethd_status front##_create(const void *setup, void **out, ethd_error *error) {                 \
    type *control;                                                                                      \
    ethd_status status = type##_create(setup, &control, error);                                         \
    *out = control;                                                                                     \
    return status;                                                                                      \
  }                                                                                                     \
  static void front##_destroy(void *control) { type##_destroy(control); }                               \
  static ethd_status front##_post(void *control, const void *setup, ethd_error *error) {                \
    return type##_post(control, setup, error);                                                          \
  }                                                                                                     \
  static ethd_status front##_poll(void *control, ethd_event *out) { return type##_poll(control, out); } \
  static void front##_restart(void *control) { type##_restart(control); }                               \
  static void front##_acknowledge(void *control) { type##_acknowledge(control); }                       \
  static double front##_clean_time(void *control) { return type##_clean_time(control); }                \
  static void front##_counters(void *control, ethd_counters *out) { type##_counters(control, out); }
#define FUNCTIONS(front)                                                                            \
  .create = front##_create, .destroy = front##_destroy, .post = front##_post, .poll = front##_poll, \
  .restart = front##_restart, .acknowledge = front##_acknowledge, .clean_time = front##_clean_time, \
  .counters = front##_counters, .step = front##_step

FRONT(plane, ethd_control)
FRONT(space, ethd_space)

/* ---- the plane ---- */

static void plane_set_heat(void *control, const double heat[2]) { ethd_control_set_heat(control, heat); }
static void plane_set_memory(void *control, const double *memory) { ethd_control_set_memory(control, memory); }

static void plane_step(void *control, const void *row, void *trace) {
  ethd_command command;
  (void)ethd_control_step(control, &((const ethd_trace *)row)->sense, &command, trace);
}

static const ethd__controller plane = {.columns = ethd_trace_columns,
                                       .row_bytes = sizeof(ethd_trace),
                                       .set_heat = plane_set_heat,
                                       .set_memory = plane_set_memory,
                                       FUNCTIONS(plane)};

/* ---- space ---- */

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
                                       FUNCTIONS(space)};

const ethd__controller *ethd__controller_of(const ethd_config *config) { return config->is_space ? &space : &plane; }
