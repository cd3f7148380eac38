/* What every number may be, and is by default: configurations, materials and plugins rely on it, so a change is a
   change of the interface. The rows are written down from the tables; the ranges' reasons stand beside those. */
#include <math.h>
#include <string.h>

#include "ethd/law.h"
#include "unit/rig.h"

typedef struct row {
  const char *owner, *name;
  double min, max, def; /* NaN: there is no default */
} row;

/* In the order of ethd_laws, of the three tables of methods, and of a default setup's sections. */
static const row rows[] = {
    {"pd", "k_t", 0, 10000, 40},
    {"pd", "b_t", 0, 1000, 1},
    {"pd", "derivative", 0, 1, 0},
    {"follow", "k", 0, 1000000, 600},
    {"follow", "b", 0, 100000, 15},
    {"follow", "rate", 0, 1000, 10},
    {"kelvin-voigt", "k_e", 0, 1000000, 2500},
    {"kelvin-voigt", "b_e", 0, 10000, 45},
    {"spring", "k_e", 0, 1000000, 2500},
    {"hunt-crossley", "k_e", 0, 1000000, 2500},
    {"hunt-crossley", "c_e", 0, 1000, 1},
    {"smooth", "beta_min", 0, 1, 0.1},
    {"offset", "b_d", 0, 10000, 100},
    {"offset", "v_th", 1e-06, 10, 0.02},
    {"offset", "beta_min", 0, 1, 0.1},
    {"offset", "eps_max", 0, INFINITY, 0.006},
    {"offset", "t_max", 0, INFINITY, 0.05},
    {"predictive", "b_d", 0, 10000, 100},
    {"predictive", "v_th", 1e-06, 10, 0.02},
    {"predictive", "beta_min", 0, 1, 0.1},
    {"predictive", "eps_max", 0, INFINITY, 0.006},
    {"predictive", "t_max", 0, INFINITY, 0.05},
    {"predictive", "effort", 0.1, 1, 0.86},
    {"predictive", "rate", 10, 2000, 500},
    {"predictive", "aim", 0, 0.005, 8e-05},
    {"predictive", "margin", 0, 0.1, 0.003},
    {"predictive", "range", 0, 0.5, 0.03},
    {"predictive", "memory", 0, 0.99, 0.9},
    {"predictive", "learn", 0, 1, 0},
    {"approach", "effort", 0.1, 1, 0.8},
    {"approach", "acceleration", 0.01, 10000, 5},
    {"approach", "reach", 1e-06, 0.01, 0.001},
    {"approach", "release", -1, 1, 0.5},
    {"approach", "range", 0, 10, 0.4},
    {"approach", "wait", 0, 10, 0.1},
    {"lowpass", "cutoff", 1, 10000, 130},
    {"lsq", "window", 2, 32, 8},
    {"foaw", "window", 2, 32, 16},
    {"foaw", "noise", 1e-09, 1, 0.00016},
    {"kalman", "noise", 1e-09, 1, 4.6e-05},
    {"kalman", "acceleration", 0.001, 1000000, 50},
    {"kalman", "inertia", 1e-06, 1000, 0.00733125},
    {"robust", "gate", 1e-05, 0.01, 0.0012},
    {"ca", "reference", 0, 1, 0},
    {"ca", "compensation", 0, 1, 0},
    {"ca", "latency", 0, 0.1, 0},
    {"ca", "noise", 1e-07, 0.01, 0.0001},
    {"ca", "gate", 1, INFINITY, 25},
    {"ca", "jerk", 0.01, 10000000, 400},
    {"ca", "memory", 0.001, INFINITY, 0.08},
    {"hold", "reference", 0, 1, 0},
    {"alpha-beta", "reference", 0, 1, 0},
    {"alpha-beta", "compensation", 0, 1, 0},
    {"alpha-beta", "latency", 0, 0.1, 0},
    {"alpha-beta", "alpha", 0.01, 1, 0.5},
    {"alpha-beta", "beta", 0, 2, 0.4},
    {"cv", "reference", 0, 1, 0},
    {"cv", "compensation", 0, 1, 0},
    {"cv", "latency", 0, 0.1, 0},
    {"cv", "noise", 1e-07, 0.01, 0.0001},
    {"cv", "gate", 1, INFINITY, 25},
    {"cv", "acceleration", 0.001, 100000, 8},
    {"arm", "mechanism", 0, 1, 0},
    {"arm", "link1", 0.001, 100, 0.25},
    {"arm", "link2", 0.001, 100, 0.25},
    {"arm", "mass_x", 1e-09, 1000000, NAN},
    {"arm", "mass_y", 1e-09, 1000000, NAN},
    {"arm", "friction", 0, 1000000, NAN},
    {"arm", "viscous", 0, 1000000, NAN},
    {"arm", "delay", 0, 0.1, NAN},
    {"loop", "period", 1e-05, 0.1, 0.001},
    {"ring", "radius", 0.0001, 1, 0.012},
    {"finger", "radius", 0.0001, 1, 0.0075},
    {"finger", "radius_max", 1e-05, 1, 0.0095},
    {"finger_fit", "lag", -0.01, 0.01, 0},
    {"transition", "swap_time", 0, 1, 0.02},
    {"transition", "v_hysteresis", 0, 1, 0},
    {"limits", "torque", 0, INFINITY, NAN},
    {"limits", "torque_rate", 0, INFINITY, NAN},
    {"limits", "speed", 0, INFINITY, NAN},
    {"limits", "workspace", -INFINITY, INFINITY, NAN},
    {"limits", "step_time", 1e-09, INFINITY, NAN},
    {"limits", "reach", -INFINITY, INFINITY, NAN},
    {"limits", "joints", -INFINITY, INFINITY, NAN},
    {"limits", "margin", 0, 1, NAN},
    {"limits", "energy", 1e-09, INFINITY, NAN},
    {"limits", "nominal_torque", 1e-09, INFINITY, NAN},
    {"limits", "heat_time", 0.001, INFINITY, NAN},
    {"limits", "gap", 1e-09, INFINITY, NAN},
    {"limits", "finger_age", 0.0001, INFINITY, NAN},
    {"limits", "finger_lost", 0.0001, INFINITY, NAN},
    {"limits", "clean_time", 0, 1000000, NAN},
    {"limits", "stop_time", 0.001, INFINITY, NAN},
};

static size_t at;

static void same(const char *owner, const ethd_param *param) {
  ck_assert_msg(at < sizeof rows / sizeof *rows, "%s.%s isn't listed", owner, param->name);
  const row *r = &rows[at++];
  ck_assert_msg(!strcmp(r->owner, owner) && !strcmp(r->name, param->name), "%s.%s stands where %s.%s was", owner,
                param->name, r->owner, r->name);
  ck_assert_msg(r->min == param->min && r->max == param->max, "%s.%s: %g to %g", owner, param->name, param->min,
                param->max);
  ck_assert_msg(r->def == param->def || (isnan(r->def) && isnan(param->def)), "%s.%s: %g", owner, param->name,
                param->def);
}

static void same_methods(const ethd_method *methods, int count) {
  for (int i = 0; i < count; i++)
    for (uint32_t k = 0; k < methods[i].param_count; k++) same(methods[i].id, &methods[i].params[k]);
}

TEST(test_ranges) {
  const ethd_setup setup = ethd_setup_default();
  ethd_setup_key key;
  at = 0;
  for (const ethd_law *const *law = ethd_laws; *law; law++)
    for (uint32_t k = 0; k < (*law)->param_count; k++) same((*law)->id, &(*law)->params[k]);
  same_methods(ethd_velocity_methods, ETHD_VELOCITY_COUNT);
  same_methods(ethd_fit_methods, ETHD_FIT_COUNT);
  same_methods(ethd_filter_methods, ETHD_FILTER_COUNT);
  for (uint32_t i = 0; ethd_setup_key_at(&setup, i, &key) == ETHD_OK && at < sizeof rows / sizeof *rows; i++)
    same(key.section, &key.param);
  ck_assert_uint_eq(at, sizeof rows / sizeof *rows);
}
