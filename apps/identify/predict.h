/* Predicts the encoders from the commands over a short window, by the simulator of drivers/sim, without a finger.
   [any] */
#ifndef ETHD__APPS_IDENTIFY_PREDICT_H
#define ETHD__APPS_IDENTIFY_PREDICT_H

#include "identify/evidence.h"
#include "sim/arms.h"

/* The state at a window's beginning: angles and speeds that the encoders see, rad and rad/s of both joints; with an
   elastic transmission also the links' lead over them. */
enum { ETHD__STATE_RIGID = 4, ETHD__STATE_MOST = 8 };

#define ETHD__WINDOW_MOST 512 /* ticks */

typedef struct ethd__shot {
  size_t first, begin, end; /* its first tick; begin and end of its stretch, whose commands are known */
  int count;                /* ticks, the first included */
  uint32_t recording;
} ethd__shot;

/* A plant, prepared for the prediction of many windows. */
typedef struct ethd__predictor {
  const ethd__evidence *evidence;
  ethd__body body;
  double delay; /* s */
} ethd__predictor;

/* Prepares a predictor; tolerance, m/s, as in ethd_sim_def. */
void ethd__predictor_prepare(const ethd__evidence *evidence, const ethd_plant *plant, double tolerance,
                             ethd__predictor *out);

/* Fills the joint angles at the window's ticks, both of one tick side by side: 2 * window->count numbers. An arm that
   diverges stands still from there on. */
void ethd__predict(ethd__predictor *predictor, const ethd__shot *window, const double *state, double *out);

/* One of several parallel predictions of a window. */
typedef struct ethd__forecast {
  const ethd__predictor *predictor;
  const double *state;
  double *out; /* as ethd__predict fills it */
} ethd__forecast;

/* Makes up to ETHD__ARMS predictions at once. Their plants differ little; all or none have an elastic transmission. */
void ethd__predict_many(const ethd__forecast *forecasts, int count, const ethd__shot *window);

#endif
