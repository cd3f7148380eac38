/* Fills an error and returns its status. */
#ifndef ETHD_LIB_REFUSE_H
#define ETHD_LIB_REFUSE_H

#include <string.h>

#include "ethd/status.h"

static inline ethd_status ethd__refuse(ethd_error *error, ethd_status status, const char *name,
                                       double found, double min, double max) {
  if (!error) return status;
  memset(error, 0, sizeof *error);
  error->status = status;
  for (size_t i = 0; name[i] && i + 1 < sizeof error->name; i++) error->name[i] = name[i];
  error->found = found;
  error->min = min;
  error->max = max;
  return status;
}

#endif
