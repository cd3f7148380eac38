/* A tap in real time on a thread of its own: controller and simulated device at their period, the hand led by
   the pointer. Screen and thread meet in two cells. */
#ifndef ETHD__APPS_SCREEN_LIVE_H
#define ETHD__APPS_SCREEN_LIVE_H

#include <pthread.h>
#include <stdatomic.h>

#include "ethd/cell.h"
#include "screen/hand.h"
#include "tap/study.h"

/* The state that the screen draws. */
typedef struct ethd__glimpse {
  double t; /* s of the tap */
  ethd_vec finger, ring;
  int32_t state; /* of the controller, ETHD_TRANSPARENT .. */
  int32_t reserved;
  double touch; /* s of the tap: the finger's first touch, NaN before it */
} ethd__glimpse;

/* The pointer's arrival, place and instant. */
typedef struct ethd__led {
  int64_t ns;
  ethd_vec x;
} ethd__led;

typedef struct ethd__live {
  ethd__stage *stage;
  ethd__rule rule;
  ethd_sim_tap tap;
  ethd__hand hand;
  ethd_cell *pointer, *glimpse; /* ethd__led in, ethd__glimpse out */
  double touch;                 /* of the glimpse */
  int64_t began_ns;             /* the clock's time at the tap's 0 */
  pthread_t thread;
  bool started;
  atomic_int over, stop;
  ethd_status status;
  uint64_t late; /* ticks that began a period or more too late */
} ethd__live;

/* Begins tap `number` at rest at x, at most `seconds` long. On failure nothing runs. [main] */
ETHD_MUST_CHECK ethd_status ethd__live_start(ethd__live *live, ethd__stage *stage, const ethd__speed *speed,
                                             uint64_t number, ethd_vec x, double seconds);

/* Passes on the pointer's arrival at x at this instant of the clock. [main] */
void ethd__live_lead(ethd__live *live, int64_t ns, ethd_vec x);

/* Gives the newest glimpse; false: the tap is over. [main] */
bool ethd__live_look(ethd__live *live, ethd__glimpse *out);

/* Ends the tap, if it isn't over yet; its ticks are then in stage->rows. [main] */
ETHD_MUST_CHECK ethd_status ethd__live_join(ethd__live *live);

#endif
