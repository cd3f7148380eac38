#include <math.h>

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

const ethd__quantity ethd__quantities[ETHD_QUANTITIES] = {
    [ETHD_Q_V_RVO] = {"v_rvo", "Ring's speed as it meets the wall", "m/s", v_rvo, 3},
    [ETHD_Q_V_OF] = {"v_of", "Ring's speed as the finger touches it", "m/s", v_of, 3},
    [ETHD_Q_D_MAX] = {"d_max", "First rebound", "mm", d_max, 3},
    [ETHD_Q_V_RMIN] = {"v_rmin", "Ring's smallest speed after the touch", "m/s", v_rmin, 3},
    [ETHD_Q_DELTA_S] = {"delta_s", "Time of braking", "ms", delta_s, 2},
    [ETHD_Q_EPS] = {"eps", "Offset of the wall", "mm", eps, 3},
    [ETHD_Q_DELAY] = {"delay", "Touch felt after it is seen", "ms", delay, 1},
    [ETHD_Q_FORCE] = {"peak_force", "Largest rendered force", "N", force, 2},
};

size_t ethd__group_values(const ethd__group *group, const ethd__quantity *quantity, double *out, uint32_t *person) {
  size_t n = 0;
  for (size_t i = 0; i < group->cell.count; i++) {
    const ethd__metrics *m = &group->cell.results[i].metrics;
    double value = quantity->of(m);
    if (m->reason != ETHD_TAP_OK || isnan(value)) continue;
    if (person) person[n] = group->who[i].person;
    out[n++] = value;
  }
  return n;
}
