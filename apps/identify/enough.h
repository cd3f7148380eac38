/* Checks whether recordings suffice to identify a device. [main] */
#ifndef ETHD__APPS_IDENTIFY_ENOUGH_H
#define ETHD__APPS_IDENTIFY_ENOUGH_H

#include "identify/evidence.h"

/* If they don't suffice, ends the program with a line on the missing data and how to record them. count: rad of an
   encoder's count, 0 if it is ideal. */
void ethd__evidence_enough(const ethd__evidence *evidence, double count);

#endif
