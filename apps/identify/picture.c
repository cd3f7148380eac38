/* Draws a stretch of motion, measured and predicted, the residual and its spectrum. */
#include <math.h>
#include <stdlib.h>

#include "cli/picture.h"
#include "identify/page.h"
#include "text/csv.h"

#define SHOWN 10 /* consecutive windows that are drawn */

static double way(const ethd__finding *f, size_t from, int joint) {
  double sum = 0;
  const ethd__shooting *p = &f->problem;
  for (size_t i = from; i < from + SHOWN && i < p->window_count; i++) {
    const ethd__shot *w = &p->windows[i].window;
    for (size_t k = w->first + 1; k < w->first + (size_t)w->count; k++)
      sum += fabs(f->evidence->q[k][joint] - f->evidence->q[k - 1][joint]);
  }
  return sum;
}

/* Finds the stretch and the joint that move most. */
static size_t liveliest(const ethd__finding *f, int *joint) {
  size_t best = 0;
  double most = -1;
  for (size_t i = 0; i + SHOWN <= f->problem.window_count || i == 0; i += SHOWN)
    for (int j = 0; j < 2; j++)
      if (way(f, i, j) > most) {
        most = way(f, i, j);
        best = i;
        *joint = j;
      }
  return best;
}

static void put(ethd_csv_out *out, int part, const double *values, int count) {
  ethd_csv_integer(out, part);
  for (int i = 0; i < count; i++) ethd_csv_number(out, values[i]);
  ethd_csv_row(out);
}

static void put_motion(const ethd__finding *f, ethd_csv_out *out) {
  int j = 0;
  const ethd__shooting *p = &f->problem;
  size_t from = liveliest(f, &j), begin = p->windows[from].window.first;
  for (size_t i = from; i < from + SHOWN && i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    for (int k = 0; k < w->window.count; k++) {
      size_t tick = w->window.first + (size_t)k;
      double q = f->evidence->q[tick][j], r = f->residual[w->row + 2 * (size_t)k + (size_t)j];
      double row[] = {(double)(tick - begin) * f->evidence->period, q, q - r, r};
      put(out, 0, row, 4);
    }
  }
}

ethd_status ethd__page_csv(const ethd__finding *f, const char *path, char message[ETHD_MESSAGE_MAX]) {
  const ethd__whiteness *w = &f->whiteness;
  ethd_csv_out *out = ethd_csv_create(path, "part,x,measured_rad,predicted_rad,left_rad", message);
  if (!out) return ETHD_E_FILE;
  put_motion(f, out);
  double T = f->evidence->period;
  for (int i = 1; i < w->tones; i++) {
    double row[] = {i / (2 * T * (w->tones - 1)), w->density[i], w->floor * w->floor * 2 * T, 0};
    put(out, 1, row, 4);
  }
  return ethd_csv_close(out, message);
}

ethd_status ethd__identify_draw(const ethd__finding *f, const char *csv, const char *png,
                                char message[ETHD_MESSAGE_MAX]) {
  char about[160];
  const ethd__whiteness *w = &f->whiteness;
  int joint = 0;
  (void)liveliest(f, &joint);
  snprintf(about, sizeof about,
           "joint %d; residual %.3g rad rms, %.2f times the residual of rounding; largest correlation %.3f", joint + 1,
           w->rms, w->floor > 0 ? w->rms / w->floor : (double)NAN, w->correlation[w->largest]);
  const ethd__picture_value values[] = {
      {"in", csv, true}, {"out", png, true}, {"about", about, false}, {NULL, NULL, false}};
  return ethd__picture_draw("identify.gp", NULL, values, message);
}
