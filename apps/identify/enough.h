/* Whether recordings say enough of a device to identify it. [main] */
#ifndef ETHD__APPS_IDENTIFY_ENOUGH_H
#define ETHD__APPS_IDENTIFY_ENOUGH_H

#include "identify/evidence.h"

/* Ends the program where they don't, with a line that says what is missing and how to record it. count: rad of an
   encoder's count, 0 if it is ideal. */
void ethd__evidence_enough(const ethd__evidence *evidence, double count);

#endif
