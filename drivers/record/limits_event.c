#include "record/limits_event.h"

#include <stdio.h>
#include <string.h>

#define TEXT_MAX 256

static ethd_status tell(ethd_recording *recording, const ethd_limit *row, const double *values) {
  char text[TEXT_MAX];
  int n = snprintf(text, sizeof text, "limits.%s", row->name);
  for (uint32_t i = 0; i < row->count; i++) n += snprintf(text + n, sizeof text - (size_t)n, " %.17g", values[i]);
  return ethd_recording_event(recording, "set", text);
}

ethd_status ethd__limits_event(ethd_recording *recording, const ethd_limits *was, const ethd_limits *is) {
  ethd_limits before = *was, now = *is;
  ethd_status status = ETHD_OK;
  for (const ethd_limit *row = ethd_limit_rows; !status && row < ethd_limit_rows + ETHD_LIMITS; row++) {
    const double *values = ethd_limit_of(&now, row);
    if (memcmp(ethd_limit_of(&before, row), values, row->count * sizeof *values) != 0)
      status = tell(recording, row, values);
  }
  return status;
}
