/* Tables, checks and coefficients of the velocity estimators. [main] */
#include <math.h>
#include <string.h>

#include "error.h"
#include "estimate/velocity_methods.h"

static const ethd_param lowpass[] = {
    [LOWPASS_CUTOFF] = {"cutoff", "Hz", 1, 1e4, 130, "-3 dB frequency of the low-pass"},
};

static const ethd_param lsq[] = {
    [LSQ_WINDOW] = {"window", ETHD_WHOLE, 2, ETHD_VELOCITY_WINDOW_MAX, 8, "number of samples in the line's fit"},
};

static const ethd_param foaw[] = {
    [FOAW_WINDOW] = {"window", ETHD_WHOLE, 2, ETHD_VELOCITY_WINDOW_MAX, 16,
                     "largest number of samples in the line's fit"},
    [FOAW_NOISE] = {"noise", "rad", 1e-9, 1, 160e-6, "largest distance of a sample from the line: one encoder count"},
};

static const ethd_param kalman[] = {
    [VELOCITY_NOISE] = {"noise", "rad", 1e-9, 1, 46e-6, "sd of a position: an encoder count / sqrt(12)"},
    [VELOCITY_ACCELERATION] =
        {"acceleration", "rad/s^2", 1e-3, 1e6, 50,
         "rms acceleration that the torque doesn't explain: by friction, contacts, wrong inertia"},
    [VELOCITY_INERTIA] = {"inertia", "kg m^2", 1e-6, 1e3, 0.1173 * 0.0625, "inertia of each joint: mass L^2"},
};

#define ROWS(table) table, sizeof table / sizeof *table

const ethd_method ethd_velocity_methods[ETHD_VELOCITY_COUNT] = {
    [ETHD_VELOCITY_LOWPASS] = {"lowpass", "first-order low-pass of the difference", ROWS(lowpass)},
    [ETHD_VELOCITY_DIFFERENCE] = {"difference", "backward difference of the positions", NULL, 0},
    [ETHD_VELOCITY_LSQ] = {"lsq", "slope of a least-squares line through the last samples", ROWS(lsq)},
    [ETHD_VELOCITY_FOAW] = {"foaw", "first-order adaptive windowing", ROWS(foaw)},
    [ETHD_VELOCITY_KALMAN] = {"kalman", "Kalman filter with the commanded torque as known input", ROWS(kalman)},
};

#define PERIOD_MIN 1e-6 /* s */
#define PERIOD_MAX 1.0

static uint32_t window(ethd_velocity_method method, const double *p) {
  if (method == ETHD_VELOCITY_LSQ) return (uint32_t)p[LSQ_WINDOW];
  if (method == ETHD_VELOCITY_FOAW) return (uint32_t)p[FOAW_WINDOW];
  return 0;
}

static ethd_status check(ethd_velocity_method method, const double *p, double period, ethd_error *error) {
  if ((uint32_t)method >= ETHD_VELOCITY_COUNT)
    return ethd__refuse(error, ETHD_E_UNKNOWN, "method", (ethd__found){(double)method, 0, ETHD_VELOCITY_COUNT - 1});
  const ethd_method *m = &ethd_velocity_methods[method];
  ethd_status status = ethd__check_number(error, "period", period, PERIOD_MIN, PERIOD_MAX);
  if (!status) status = ethd_params_check(m->params, m->param_count, p, error);
  return status;
}

ethd_status ethd_velocity_prepare(ethd_velocity_method method, const double *p, double period, ethd_velocity *out,
                                  ethd_error *error) {
  ethd_status status = check(method, p, period, error);
  if (status) return status;
  memset(out, 0, sizeof *out);
  out->method = method;
  out->window = window(method, p);
  out->period = period;
  if (method == ETHD_VELOCITY_LOWPASS) out->gain = ethd__velocity_gain(p[LOWPASS_CUTOFF], period);
  for (uint32_t i = 0; i < ethd_velocity_methods[method].param_count; i++) out->p[i] = p[i];
  return ETHD_OK;
}

/* The filter's gains settle at alpha and beta, which its tracking index m determines (Kalata 1984). While the joint
   accelerates at a constant a, the innovation r is constant: beta r = a T^2 and (v - v_hat) T = alpha r - a T^2 / 2. */
static double kalman_lag(const ethd_velocity *v) {
  double m = v->p[VELOCITY_ACCELERATION] * v->period * v->period / v->p[VELOCITY_NOISE];
  double root = (4 + m - sqrt(m * (8 + m))) / 4;
  double alpha = 1 - root * root, beta = 2 * (1 - root) * (1 - root);
  return (alpha / beta - 0.5) * v->period;
}

double ethd_velocity_lag(const ethd_velocity *v) {
  switch (v->method) { /* unreachable: a method that isn't listed */
  case ETHD_VELOCITY_LOWPASS: return (0.5 + (1 - v->gain) / v->gain) * v->period;
  case ETHD_VELOCITY_LSQ:
  case ETHD_VELOCITY_FOAW: return (v->window - 1) / 2.0 * v->period;
  case ETHD_VELOCITY_KALMAN: return kalman_lag(v);
  case ETHD_VELOCITY_DIFFERENCE:
  case ETHD_VELOCITY_COUNT: break;
  }
  return 0.5 * v->period;
}
