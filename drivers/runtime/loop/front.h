/* The two fronts of a loop: the differences between controller and device of the plane and those of space. A loop has
   one of them from its creation on. */
#ifndef ETHD__LOOP_FRONT_H
#define ETHD__LOOP_FRONT_H

#include <stdbool.h>
#include <stddef.h>

#include "ethd/loop.h"

/* The fields with which both senses begin. */
typedef struct ethd__sense_head {
  int64_t time_ns, have, missed, step_ns, faults, grave;
} ethd__sense_head;

/* The fields of both rows behind the trace. */
typedef struct ethd__row_tail {
  double share;
  uint64_t lost, swaps;
  int32_t marks, armed;
} ethd__row_tail;

/* The last joint sample, as it came. */
typedef struct ethd__joints {
  int64_t time_ns, have;
  double q[2], dq[2], age[2];
} ethd__joints;

/* The same of a device in space. */
typedef struct ethd__effector {
  int64_t time_ns, have;
  double x[3], v[3], normal[3], ability[ETHD_ABILITY];
} ethd__effector;

/* A loop's sense, by its front. */
typedef union ethd__loop_sense {
  ethd__sense_head head;
  ethd_sense plane;
  ethd_space_sense space;
} ethd__loop_sense;

typedef union ethd__loop_row {
  ethd_loop_row plane;
  ethd_space_row space;
} ethd__loop_row;

/* The surfaces near an effector, and what was written to a device in space. */
typedef struct ethd__near {
  ethd_surface at[ETHD_SURFACES_MAX];
  uint32_t count;
  bool altered; /* the device got another command than the controller's: */
  double given[3];
} ethd__near;

typedef struct ethd__loop_front {
  size_t row, tail; /* bytes of a row; offset of its tail */
  /* [rt] */
  /* Adds the device's data to the sense, which is empty unless a sample is held, and returns the device's status. */
  ethd_status (*read)(ethd_loop *loop) ETHD_RT;
  /* Marks the device as unknown: the controller gets NaN and reports its input fault. */
  void (*blind)(ethd_loop *loop) ETHD_RT;
  /* Stores the sense's sample, or replaces it by the last one. */
  void (*remember)(ethd_loop *loop, bool is_new) ETHD_RT;
  /* Finds the surfaces near the effector; NULL: the controller finds them. */
  void (*look)(ethd_loop *loop) ETHD_RT;
  void (*rehearse)(ethd_loop *loop) ETHD_RT;
  /* Steps the controller; returns true if it has taken a posted setup. */
  bool (*step)(ethd_loop *loop) ETHD_RT;
  bool (*is_safe)(const ethd_loop *loop) ETHD_RT; /* the command */
  /* Writes this share of the command, or the safe command. */
  ethd_status (*write)(ethd_loop *loop, bool armed, double share) ETHD_RT;
  void (*acknowledge)(ethd_loop *loop) ETHD_RT;
  /* [any] */
  const ethd_law *(*law)(const ethd_loop *loop)ETHD_RT;
  /* [main] */
  double (*period)(const ethd_loop_def *def);
  void (*counters)(const ethd_loop *loop, ethd_counters *out);
  void (*restart)(ethd_loop *loop);
  void (*start)(ethd_loop *loop);           /* the device has been started */
  bool (*has_fault)(const ethd_loop *loop); /* as the last row says */
} ethd__loop_front;

extern const ethd__loop_front ethd__loop_plane, ethd__loop_space;

#endif
