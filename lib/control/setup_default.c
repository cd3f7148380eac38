#include <string.h>

#include "control/setup.h"
#include "ethd/control.h"

/* Returns how far the law looks ahead at most, from the ring's centre, m; 0: it doesn't. */
static double ahead(const ethd_setup *s) {
  if (!s->transition || !ETHD_LAW_HAS(s->transition, range)) return 0;
  double range = s->transition->range(s->transition_p, (double)INFINITY);
  return range > 0 && range < (double)INFINITY ? s->ring_radius + range : 0;
}

double ethd_setup_range(const ethd_setup *s) {
  double near = 2 * s->ring_radius + (s->ring_radius - s->finger_radius_max), far = ahead(s);
  return far > near ? far : near;
}

static void defaults(const ethd_param *params, uint32_t count, double *p) {
  memset(p, 0, ETHD_PARAMS_MAX * sizeof *p);
  ethd_params_default(params, count, p);
}

void ethd_setup_tracking(ethd_setup *setup, const ethd_tracking_law *law) {
  setup->tracking = law;
  defaults(law->law.params, law->law.param_count, setup->tracking_p);
}

void ethd_setup_contact(ethd_setup *setup, const ethd_contact_law *law) {
  setup->contact = law;
  defaults(law->law.params, law->law.param_count, setup->contact_p);
}

void ethd_setup_transition(ethd_setup *setup, const ethd_transition_law *law) {
  setup->transition = law;
  defaults(law->law.params, law->law.param_count, setup->transition_p);
}

void ethd_setup_velocity(ethd_setup *setup, ethd_velocity_method method) {
  setup->velocity = method;
  defaults(ethd_velocity_methods[method].params, ethd_velocity_methods[method].param_count, setup->velocity_p);
}

void ethd_setup_fit(ethd_setup *setup, ethd_fit_method method) {
  setup->fit = method;
  defaults(ethd_fit_methods[method].params, ethd_fit_methods[method].param_count, setup->fit_p);
}

void ethd_setup_filter(ethd_setup *setup, ethd_filter_method method) {
  setup->filter = method;
  defaults(ethd_filter_methods[method].params, ethd_filter_methods[method].param_count, setup->filter_p);
}

ethd_setup ethd_setup_default(void) {
  ethd_setup s;
  memset(&s, 0, sizeof s);
  s.cookie = ETHD__SETUP_COOKIE;
  for (const ethd__setup_field *f = ethd__setup_fields; f < ethd__setup_fields + ETHD__SETUP_FIELDS; f++)
    for (uint32_t i = 0; i < f->key.count; i++) ethd__setup_field_set(&s, f, i, f->key.param.def);
  ethd_setup_velocity(&s, ETHD_VELOCITY_LOWPASS);
  ethd_setup_fit(&s, ETHD_FIT_KASA);
  ethd_setup_filter(&s, ETHD_FILTER_CA);
  ethd_setup_tracking(&s, &ethd_tracking_pd);
  ethd_setup_contact(&s, &ethd_contact_kelvin_voigt);
  ethd_setup_transition(&s, &ethd_transition_offset);
  s.limits = ethd_limits_none();
  return s;
}
