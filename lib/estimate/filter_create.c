/* Tables and checks of the finger filters. [main] */
#include <math.h>
#include <string.h>

#include "error.h"
#include "estimate/filter_methods.h"

/* clang-format off */
#define REFERENCE                                                                  \
  [FILTER_REFERENCE] = {"reference", "sample|tick", 0, 1, ETHD_REFERENCE_SAMPLE,   \
      "the ring's position that a reading is added to: at the reading's sample, or at this tick"}
#define COMPENSATION                                                               \
  [FILTER_COMPENSATION] = {"compensation", "stamp|none", 0, 1,                     \
      ETHD_COMPENSATION_STAMP, "age of a reading: compensated by its stamp, or ignored"}
#define LATENCY                                                                    \
  [FILTER_LATENCY] = {"latency", "s", 0, 0.1, 0,                                   \
      "time from the sample to its stamp, compensated too (only with compensation = stamp)"}
#define NOISE                                                                      \
  [FILTER_NOISE] = {"noise", "m", 1e-7, 1e-2, 0.1e-3, "sd of a reading, in x and in y"}
#define GATE                                                                       \
  [FILTER_GATE] = {"gate", "1", 1, INFINITY, 25,                                   \
      "innovation, in its standard deviations, above which a reading is dropped; a finger on glass reaches 20"}

static const ethd_param hold[] = {REFERENCE};

static const ethd_param alpha_beta[] = {
    REFERENCE, COMPENSATION, LATENCY,
    [ALPHA_BETA_ALPHA] = {"alpha", "1", 0.01, 1, 0.5,
        "share of the innovation that moves the position"},
    [ALPHA_BETA_BETA] = {"beta", "1", 0, 2, 0.4,
        "share of the innovation, over the time step, that changes the speed"},
};

static const ethd_param cv[] = {
    REFERENCE, COMPENSATION, LATENCY, NOISE, GATE,
    [FILTER_DRIVE] = {"acceleration", "m/s^2", 1e-3, 1e5, 8, "rms acceleration of the finger"},
};

static const ethd_param ca[] = {
    REFERENCE, COMPENSATION, LATENCY, NOISE, GATE,
    [FILTER_DRIVE] = {"jerk", "m/s^3", 1e-2, 1e7, 400, "rms jerk of the finger"},
    [FILTER_MEMORY] = {"memory", "s", 1e-3, INFINITY, 0.08, "time constant of the acceleration; inf: constant"},
};
/* clang-format on */

#define ROWS(table) table, sizeof table / sizeof *table

const ethd_method ethd_filter_methods[ETHD_FILTER_COUNT] = {
    [ETHD_FILTER_CA] = {"ca", "Kalman filter of constant acceleration", ROWS(ca)},
    [ETHD_FILTER_HOLD] = {"hold", "last reading, with speed 0", ROWS(hold)},
    [ETHD_FILTER_ALPHA_BETA] = {"alpha-beta", "position and velocity with fixed gains", ROWS(alpha_beta)},
    [ETHD_FILTER_CV] = {"cv", "Kalman filter of constant velocity", ROWS(cv)},
};

static ethd_status check(ethd_filter_method method, const double *p, double period, ethd_error *error) {
  if ((uint32_t)method >= ETHD_FILTER_COUNT)
    return ethd__refuse(error, ETHD_E_UNKNOWN, "method", (ethd__found){(double)method, 0, ETHD_FILTER_COUNT - 1});
  const ethd_method *m = &ethd_filter_methods[method];
  ethd_status status = ethd__check_number(error, "period", period, 1e-6, 1);
  if (!status) status = ethd_params_check(m->params, m->param_count, p, error);
  return status;
}

ethd_status ethd_filter_prepare(ethd_filter_method method, const double *p, double period, ethd_filter *out,
                                ethd_error *error) {
  ethd_status status = check(method, p, period, error);
  if (status) return status;
  memset(out, 0, sizeof *out);
  out->method = method;
  out->reference = (int)p[FILTER_REFERENCE];
  out->compensation = method == ETHD_FILTER_HOLD ? ETHD_COMPENSATION_NONE : (int)p[FILTER_COMPENSATION];
  out->period = period;
  for (uint32_t i = 0; i < ethd_filter_methods[method].param_count; i++) out->p[i] = p[i];
  return ETHD_OK;
}
