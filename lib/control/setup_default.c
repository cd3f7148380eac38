#include <math.h>
#include <string.h>

#include "control/setup.h"
#include "ethd/control.h"
#include "fp_mode.h"

/* Returns the largest distance from the ring's centre, m, to which the law looks ahead; 0: it doesn't. */
static double ahead(const ethd_setup *s) {
  if (!s->transition || !ETHD_LAW_HAS(s->transition, range)) return 0;
  double range = s->transition->range(s->transition_p, (double)INFINITY);
  return range > 0 && range < (double)INFINITY ? s->ring_radius + range : 0;
}

ETHD__FP_APART static double range_of(const ethd_setup *s) {
  if (ethd__setup_made(s, NULL) < 0) return (double)NAN;
  double near = 2 * s->ring_radius + (s->ring_radius - s->finger_radius_max), far = ahead(s);
  return far > near ? far : near;
}

double ethd_setup_range(const ethd_setup *s) { ETHD__FP_RETURN(double, range_of(s)); }

/* Without params it sets nothing: then ethd_setup_check refuses the setup. */
static void method_defaults(const ethd_method *methods, uint32_t count, uint32_t method, double *p) {
  const ethd_method chosen = method < count ? methods[method] : (ethd_method){0};
  ethd__setup_values(chosen.params, chosen.param_count, p);
}

void ethd_setup_tracking(ethd_setup *setup, const ethd_tracking_law *law) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->tracking = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->tracking_p);
}

void ethd_setup_contact(ethd_setup *setup, const ethd_contact_law *law) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->contact = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->contact_p);
}

void ethd_setup_transition(ethd_setup *setup, const ethd_transition_law *law) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->transition = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->transition_p);
}

void ethd_setup_velocity(ethd_setup *setup, ethd_velocity_method method) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->velocity = method;
  method_defaults(ethd_velocity_methods, ETHD_VELOCITY_COUNT, (uint32_t)method, setup->velocity_p);
}

void ethd_setup_fit(ethd_setup *setup, ethd_fit_method method) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->fit = method;
  method_defaults(ethd_fit_methods, ETHD_FIT_COUNT, (uint32_t)method, setup->fit_p);
}

void ethd_setup_filter(ethd_setup *setup, ethd_filter_method method) {
  if (ethd__setup_made(setup, NULL) < 0) return;
  setup->filter = method;
  method_defaults(ethd_filter_methods, ETHD_FILTER_COUNT, (uint32_t)method, setup->filter_p);
}

void ethd__setup_defaults(ethd_setup *s) {
  for (const ethd__setup_field *f = ethd__setup_fields; f < ethd__setup_fields + ETHD__SETUP_FIELDS; f++)
    for (uint32_t i = 0; i < f->key.count; i++) ethd__setup_field_set(s, f, i, f->key.param.def);
  ethd_setup_velocity(s, ETHD_VELOCITY_LOWPASS);
  ethd_setup_fit(s, ETHD_FIT_KASA);
  ethd_setup_filter(s, ETHD_FILTER_CA);
  ethd_setup_tracking(s, &ethd_tracking_pd);
  ethd_setup_contact(s, &ethd_contact_kelvin_voigt);
  ethd_setup_transition(s, &ethd_transition_offset);
  s->limits = ethd_limits_none();
}
