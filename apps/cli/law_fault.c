#include "cli/law_fault.h"

#include <stdio.h>

ethd__law_fault ethd__law_fault_of(const ethd_law *const laws[ETHD_TRANSITION + 1], const ethd_event *event) {
  int value = (int)event->value, kind = event->code == ETHD_FAULT_LAW ? value / 100 : value;
  if (event->kind != ETHD_EVENT_FAULT || (event->code != ETHD_FAULT_LAW && event->code != ETHD_FAULT_FINITE) ||
      kind < 0 || kind > ETHD_TRANSITION)
    return (ethd__law_fault){0};
  return (ethd__law_fault){laws[kind], event->code == ETHD_FAULT_LAW
                                           ? ethd_status_sentence((ethd_status) - (value % 100))
                                           : ethd_fault_sentence(ETHD_FAULT_FINITE)};
}

ethd__law_fault ethd__law_fault_take(ethd_control *control, const ethd_setup *setup) {
  const ethd_law *const laws[] = {&setup->tracking->law, &setup->contact->law, &setup->transition->law};
  ethd__law_fault first = {0};
  ethd_event event;
  while (ethd_control_poll(control, &event) == ETHD_OK)
    if (!first.law) first = ethd__law_fault_of(laws, &event);
  return first;
}

const char *ethd__law_fault_text(const ethd__law_fault *fault, char text[ETHD_MESSAGE_MAX]) {
  static const char *const kinds[] = {"tracking", "contact", "transition"};
  snprintf(text, ETHD_MESSAGE_MAX, "the %s law %s: %s", kinds[fault->law->kind], fault->law->id, fault->what);
  return text;
}
