/* The proximity ring's board behind a pty, for a fault rig: frames of the rays that the arm's sensors have. */
#ifndef ETHD_TESTS_FAULT_RING_H
#define ETHD_TESTS_FAULT_RING_H

#include "behaviour/fault_rig.h"

typedef struct fault_board {
  char port[80], calibration[80]; /* paths, for the driver's settings */
  int32_t drops, garbles;         /* frames to come that don't arrive, or with a wrong bit */
  uint32_t silent;                /* bits: sensors that don't answer */
  int64_t jump_us;                /* of the board's clock */
  uint64_t frames;                /* that were due so far */
} fault_board;

extern fault_board board;

void fault_board_plug(void); /* sends frames of an empty ring until it is told to run */
void fault_board_run(void);
void fault_board_tick(const ethd_sense *now);
void fault_board_unplug(void);

#endif
