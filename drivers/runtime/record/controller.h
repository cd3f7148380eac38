/* A controller of either front, behind one set of functions: those of control.h and space.h. [main] */
#ifndef ETHD__RECORD_CONTROLLER_H
#define ETHD__RECORD_CONTROLLER_H

#include "ethd/record.h"
#include "ethd/space.h"

/* `control` is an ethd_control or an ethd_space, `setup` an ethd_setup or an ethd_space_setup. */
typedef struct ethd__controller {
  const ethd_column *columns; /* of a row, which is the front's trace */
  size_t row_bytes;
  const char *unrepeated; /* the column that a replay can't compute; NULL: none */
  ethd_status (*create)(const void *setup, void **out, ethd_error *error);
  void (*destroy)(void *control);
  ethd_status (*post)(void *control, const void *setup, ethd_error *error);
  ethd_status (*poll)(void *control, ethd_event *out);
  void (*restart)(void *control); /* for a device that is enabled again */
  void (*acknowledge)(void *control);
  double (*clean_time)(void *control);
  void (*counters)(void *control, ethd_counters *out);
  void (*set_heat)(void *control, const double heat[2]);               /* NULL: it models none */
  void (*set_memory)(void *control, const double memory[ETHD_MEMORY]); /* NULL: it can't be set */
  /* Repeats a recorded row's tick. */
  void (*step)(void *control, const void *row, void *trace);
} ethd__controller;

/* Returns the front of a configuration. */
const ethd__controller *ethd__controller_of(const ethd_config *config);

#endif
