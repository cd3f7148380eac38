#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "report/data.h"

#define OF(name, expression) \
  static double name(const ethd__metrics *m) { return expression; }
OF(v_rvo, m->v_rvo)
OF(v_of, m->v_of)
OF(d_max, 1e3 * m->d_max)
OF(v_rmin, m->v_rmin)
OF(delta_s, m->delta_s)
OF(eps, 1e3 * m->eps)
OF(delay, 1e3 * (m->t_of - m->t_seen))
OF(force, m->peak_force)
OF(v_hand, m->v_hand)
OF(touch_depth, 1e3 * m->touch_depth)
OF(eps_felt, 1e3 * m->eps_felt)

const ethd__quantity ethd__quantities[ETHD_QUANTITIES] = {
    [ETHD_Q_V_RVO] = {"v_rvo", "Ring's speed as it meets the wall", "m/s", v_rvo, 3, 0},
    [ETHD_Q_V_OF] = {"v_of", "Ring's speed as the finger touches it", "m/s", v_of, 3, 0},
    [ETHD_Q_D_MAX] = {"d_max", "First rebound", "mm", d_max, 3, 0},
    [ETHD_Q_V_RMIN] = {"v_rmin", "Ring's smallest speed after the touch", "m/s", v_rmin, 3, 0},
    [ETHD_Q_DELTA_S] = {"delta_s", "Time of braking", "ms", delta_s, 2, 1},
    [ETHD_Q_EPS] = {"eps", "Offset of the wall", "mm", eps, 3, 0},
    [ETHD_Q_DELAY] = {"delay", "Touch felt after it is seen", "ms", delay, 1, 1},
    [ETHD_Q_FORCE] = {"peak_force", "Largest force that the wall asks for", "N", force, 2, 0},
    [ETHD_Q_V_HAND] = {"v_hand", "Hand's own speed at the touch plane", "m/s", v_hand, 3, 0},
    [ETHD_Q_TOUCH_DEPTH] = {"touch_depth", "Ring behind the wall at the touch", "mm", touch_depth, 3, 0},
    [ETHD_Q_EPS_FELT] = {"eps_felt", "Offset of the wall 60 ms after the touch", "mm", eps_felt, 3, 0},
};

/* NaN: the tap isn't valid, or hasn't the figure. */
static double value_of(const ethd__group *group, const ethd__quantity *quantity, size_t i) {
  const ethd__metrics *m = &group->cell.results[i].metrics;
  return m->reason == ETHD_TAP_OK ? quantity->of(m) : NAN;
}

size_t ethd__group_values(const ethd__group *group, const ethd__quantity *quantity, double *out) {
  size_t n = 0;
  for (size_t i = 0; i < group->cell.count; i++) {
    out[n] = value_of(group, quantity, i);
    n += !isnan(out[n]);
  }
  return n;
}

double *ethd__group_medians(const ethd__data *data, const ethd__group *group, const ethd__quantity *quantity) {
  double *out = malloc((data->people_count + 1) * sizeof *out);
  if (!out) ethd__fail_memory();
  ethd__people_figure(&group->cell, quantity->of, ETHD_PERSON_MEDIAN, data->people_count, out);
  return out;
}

size_t ethd__group_taps(const ethd__group *a, const ethd__group *b, const ethd__quantity *quantity,
                        ethd__tapped **out) {
  size_t n = 0;
  *out = malloc((a->cell.count + (b ? b->cell.count : 0) + 1) * sizeof **out);
  if (!*out) ethd__fail_memory();
  for (uint32_t side = 0; side < (b ? 2 : 1); side++) {
    const ethd__group *group = side ? b : a;
    for (size_t i = 0; i < group->cell.count; i++) {
      (*out)[n] = (ethd__tapped){value_of(group, quantity, i), group->cell.person[i], side};
      n += !isnan((*out)[n].value);
    }
  }
  return n;
}
