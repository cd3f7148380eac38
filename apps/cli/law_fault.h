/* Finds the law that caused a fault: the events of a controller's faults LAW and FINITE contain it in their value. All [main]. */
#ifndef ETHD__APPS_CLI_LAW_FAULT_H
#define ETHD__APPS_CLI_LAW_FAULT_H

#include "ethd/control.h"

typedef struct ethd__law_fault {
  const ethd_law *law; /* NULL: not a law's fault */
  const char *what;    /* a sentence */
} ethd__law_fault;

/* Returns which of the active laws, by their kind, caused the event's fault. */
ethd__law_fault ethd__law_fault_of(const ethd_law *const laws[ETHD_TRANSITION + 1], const ethd_event *event);

/* Removes all waiting events and returns the first law's fault among them. */
ethd__law_fault ethd__law_fault_take(ethd_control *control, const ethd_setup *setup);

/* Writes "the contact law cubic: what it did" and returns text. */
const char *ethd__law_fault_text(const ethd__law_fault *fault, char text[ETHD_MESSAGE_MAX]);

#endif
