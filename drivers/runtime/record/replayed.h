/* A controller that repeats what was recorded, of either front. [main] */
#ifndef ETHD__RECORD_REPLAYED_H
#define ETHD__RECORD_REPLAYED_H

#include "ethd/record.h"
#include "ethd/space.h"

/* The functions are those of control.h and space.h. */
typedef struct ethd__replayed {
  const ethd_column *columns; /* of a row, which is the front's trace */
  size_t row_bytes;
  const char *unrepeated; /* the column that doesn't follow from the others; NULL: there is none */
  ethd_status (*create)(const void *setup, void **out, ethd_error *error);
  void (*destroy)(void *control);
  ethd_status (*post)(void *control, const void *setup, ethd_error *error);
  void (*restart)(void *control); /* for a device that is enabled again */
  void (*acknowledge)(void *control);
  void (*set_heat)(void *control, const double heat[2]);               /* NULL: it models none */
  void (*set_memory)(void *control, const double memory[ETHD_MEMORY]); /* NULL: it can't be set */
  /* Repeats a row's tick, and takes its events: a setup is taken only while they have room. */
  void (*step)(void *control, const void *row, void *trace);
} ethd__replayed;

/* Returns the front of a configuration's recordings. */
const ethd__replayed *ethd__replayed_of(const ethd_config *config);

#endif
