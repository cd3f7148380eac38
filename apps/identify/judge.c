/* Judges how well a plant predicts: the state is fitted to the first half of a window, the second half is compared. */
#include <math.h>

#include "identify/page.h"

#define TOLERANCE 1e-8
#define MOST 3000 /* windows */

static void compare(const ethd__shooting *p, ethd__predictor *predictor, const ethd__fit_window *w, int seen,
                    ethd__judgement *out) {
  double predicted[2 * ETHD__WINDOW_MOST];
  const ethd__evidence *e = p->evidence;
  ethd__predict(predictor, &w->window, w->state, predicted);
  for (int j = 0; j < 2; j++) {
    int last = w->window.count - 1;
    double step = e->q[w->window.first + (size_t)seen][j] - predicted[2 * seen + j];
    double ahead = e->q[w->window.first + (size_t)last][j] - predicted[2 * last + j];
    out->step[j] += step * step;
    out->ahead[j] += ahead * ahead;
  }
  out->windows++;
}

ethd__judgement ethd__prediction_judge(const ethd__evidence *e, const ethd_plant *plant) {
  ethd__judgement out = {{0, 0}, {0, 0}, 0};
  ethd__predictor predictor;
  ethd__shooting p;
  int ahead = (int)rint(ETHD__AHEAD / e->period);
  ethd__shooting_open(e, MOST, TOLERANCE, &p);
  p.plant = *plant;
  ethd__predictor_prepare(e, plant, TOLERANCE, &predictor);
  for (size_t i = 0; i < p.window_count; i++) {
    if (p.windows[i].window.count <= ahead + 8) continue;
    p.windows[i].window.count -= ahead;
    p.windows[i].rows = 2 * p.windows[i].window.count;
  }
  ethd__shooting_settle(&p);
  for (size_t i = 0; i < p.window_count; i++) {
    int seen = p.windows[i].window.count;
    const ethd__shot *w = &p.windows[i].window;
    if (w->first + (size_t)(seen + ahead) > w->end) continue;
    p.windows[i].window.count += ahead;
    compare(&p, &predictor, &p.windows[i], seen, &out);
  }
  for (int j = 0; j < 2 && out.windows; j++) {
    out.step[j] = sqrt(out.step[j] / (double)out.windows);
    out.ahead[j] = sqrt(out.ahead[j] / (double)out.windows);
  }
  ethd__shooting_close(&p);
  return out;
}
