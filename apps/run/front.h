/* The differences between a session in the plane and one in space. All [main]. */
#ifndef ETHD__APPS_RUN_FRONT_H
#define ETHD__APPS_RUN_FRONT_H

#include <stdbool.h>

#include "ethd/loop.h"
#include "record/controller.h"
#include "settings/front.h"

/* A row of a loop of either front. */
typedef union ethd__row {
  ethd_loop_row plane;
  ethd_space_row space;
} ethd__row;

/* The common fields of both rows. */
typedef struct ethd__row_head {
  const void *trace;
  int64_t time_ns, fault;
  double share;
  uint64_t lost, swaps;
  int32_t marks, armed;
  bool sees_finger; /* it has a reading of the finger */
} ethd__row_head;

typedef struct ethd__session_front {
  const ethd__config_front *config;
  const char *limits;    /* section of the limits, with the keys speed and clean_time */
  const char *merged[2]; /* sections that merge may change; NULL: none */
  const char *unseen;    /* the remark on a finger without readings */
  /* Puts the device's limits and dynamics into a copy of the configuration's setup. */
  void (*merge)(const ethd_device *device, ethd__setup_copy *setup);
  /* Gives a loop its controller and the numbers that follow from the setup; `config` owns the scene. */
  void (*enter)(const ethd_config *config, const ethd__setup_copy *setup, void *control, ethd_loop_def *loop);
  ethd_status (*take)(ethd_loop *loop, ethd__row *out);
  ethd__row_head (*head)(const ethd__row *row);
  void (*laws)(const ethd__setup_copy *setup, const ethd_law *out[ETHD_TRANSITION + 1]);
  /* Writes state, position and command of a row as text for the user. */
  void (*say)(const ethd__setup_copy *setup, const ethd__row *row, char *text, size_t size);
} ethd__session_front;

/* Returns the front of a configuration. */
const ethd__session_front *ethd__session_front_of(const ethd_config *config);

#endif
