#include "ethd/law.h"

const ethd_law *const ethd_laws[] = {
    &ethd_tracking_pd.law,
    &ethd_tracking_follow.law,
    &ethd_contact_kelvin_voigt.law,
    &ethd_contact_spring.law,
    &ethd_contact_hunt_crossley.law,
    &ethd_transition_abrupt.law,
    &ethd_transition_smooth.law,
    &ethd_transition_offset.law,
    &ethd_transition_predictive.law,
    &ethd_transition_approach.law,
    NULL,
};
