#include "record/limits_event.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "clock.h"

#define TEXT_MAX 256
#define SECOND ((int64_t)1000000000) /* ns */

static ethd_status tell(ethd_recording *recording, const ethd_limit *row, const double *values) {
  char text[TEXT_MAX];
  int n = snprintf(text, sizeof text, "limits.%s", row->name);
  for (uint32_t i = 0; i < row->count; i++) n += snprintf(text + n, sizeof text - (size_t)n, " %.17g", values[i]);
  return ethd_recording_event(recording, "set", text);
}

ethd_status ethd__limits_event(ethd_recording *recording, const ethd_setup *was, const ethd_setup *is) {
  ethd_limits before = was->limits, now = is->limits;
  ethd_status status = ETHD_OK;
  for (const ethd_limit *row = ethd_limit_rows; !status && row < ethd_limit_rows + ETHD_LIMITS; row++) {
    const double *values = ethd_limit_of(&now, row);
    if (memcmp(ethd_limit_of(&before, row), values, row->count * sizeof *values) != 0)
      status = tell(recording, row, values);
  }
  return status;
}

ethd_status ethd__dynamics_event(ethd_recording *recording, const ethd_setup *was, const ethd_setup *is) {
  static const char *const names[] = {"arm.mass_x", "arm.mass_y", "arm.friction", "arm.viscous", "arm.delay"};
  char text[TEXT_MAX];
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < sizeof names / sizeof *names; i++) {
    double now = ethd_setup_get(is, names[i]);
    if (isnan(now) || now == ethd_setup_get(was, names[i])) continue;
    snprintf(text, sizeof text, "%s %.17g", names[i], now);
    status = ethd_recording_event(recording, "set", text);
  }
  return status;
}

ethd_status ethd__clock_event(ethd_recording *recording, int64_t instant) {
  char text[TEXT_MAX], date[32];
  struct timespec now;
  struct tm parts;
  clock_gettime(CLOCK_REALTIME, &now);
  int64_t age = ethd__clock_now() - instant, date_ns = now.tv_sec * SECOND + now.tv_nsec;
  if (age > 0 && age < SECOND) date_ns -= age; /* else the device has a clock of its own */
  const time_t seconds = (time_t)(date_ns / SECOND);
  if (!gmtime_r(&seconds, &parts) || !strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts)) return ETHD_OK;
  snprintf(text, sizeof text, "%" PRId64 " %s.%09" PRId64 "Z", instant, date, date_ns % SECOND);
  return ethd_recording_event(recording, "clock", text);
}
