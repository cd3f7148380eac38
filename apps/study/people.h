/* Simulated people: a person's properties are a function of (seed, person) alone.

   The plant's spreads are fitted over all taps of all hands. A share of their variance, `between`, lies
   between people, the rest within them, so that many people together tap as the plant does. A finger's radius
   belongs to the person and is the same in all taps. The spread of the hand's stiffness and damping is assumed, not
   fitted. [any] */
#ifndef ETHD__APPS_STUDY_PEOPLE_H
#define ETHD__APPS_STUDY_PEOPLE_H

#include "ethd/sim.h"

/* Returns the key of all random numbers of this person's taps. */
uint64_t ethd__person_seed(uint64_t seed, uint32_t person);

/* Returns a whole number below `count` for the person's draw number `index`. */
uint32_t ethd__person_below(uint64_t seed, uint32_t person, uint32_t index, uint32_t count);

/* Returns the plant with this person's finger and hand. */
ethd_plant ethd__person_plant(const ethd_plant *plant, uint64_t seed, uint32_t person, double between,
                              double hand_spread);

#endif
