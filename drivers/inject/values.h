/* Changes the numbers of a sample as a broken sensor would. */
#ifndef ETHD__INJECT_VALUES_H
#define ETHD__INJECT_VALUES_H

#include "inject/script.h"

/* A sample of a device in either front; both have `have` and `time_ns`. */
typedef union ethd__inject_sense {
  ethd_sense plane;
  ethd_space_sense space;
} ethd__inject_sense;

/* Return the address of a channel's numbers in a sample; NULL if the sample doesn't have them. `is_new`: the joints, or
   the effector, are new. [rt] */
double *ethd__inject_plane_numbers(ethd__inject_channel channel, bool is_new, ethd__inject_sense *sense) ETHD_RT;
double *ethd__inject_space_numbers(ethd__inject_channel channel, bool is_new, ethd__inject_sense *sense) ETHD_RT;

/* Applies one injection at t, ns since the first sample, to a sample's instant, or to the numbers of its channel, if it
   is due; NULL: the sample lacks them. Returns true if a number was changed. [rt] */
bool ethd__inject_values(ethd__injection *injection, int64_t t, int64_t *time_ns, double *numbers) ETHD_RT;

#endif
