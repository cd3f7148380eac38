#include "record/limits_event.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "clock.h"

#define TEXT_MAX 256
#define SECOND ((int64_t)1000000000) /* ns */

/* Adds the key's numbers to the text; returns true if one has changed. */
static bool list_values(const ethd__config_front *front, const ethd_setup_key *key, const void *was, const void *is,
                        char text[TEXT_MAX]) {
  char name[96];
  bool changed = false;
  int n = snprintf(text, TEXT_MAX, "%s.%s", key->section, key->param.name);
  for (uint32_t i = 0; i < key->count; i++) {
    snprintf(name, sizeof name, key->count > 1 ? "%s.%s[%u]" : "%s.%s", key->section, key->param.name, i);
    const double now = front->get(is, name);
    changed |= !isnan(now) && now != front->get(was, name);
    n += snprintf(text + n, (size_t)(TEXT_MAX - n), " %.17g", now);
  }
  return changed;
}

ethd_status ethd__section_events(ethd_recording *recording, const ethd__config_front *front, const char *section,
                                 const void *was, const void *is) {
  char text[TEXT_MAX];
  ethd_setup_key key;
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; !status && front->key_at(is, i, &key) == ETHD_OK; i++)
    if (!strcmp(key.section, section) && list_values(front, &key, was, is, text))
      status = ethd_recording_event(recording, "set", text);
  return status;
}

ethd_status ethd__clock_event(ethd_recording *recording, int64_t instant) {
  char text[TEXT_MAX], date[32];
  struct timespec now;
  struct tm parts;
  clock_gettime(CLOCK_REALTIME, &now);
  int64_t age = ethd__clock_now() - instant, date_ns = now.tv_sec * SECOND + now.tv_nsec;
  if (age > 0 && age < SECOND) date_ns -= age; /* else the device has its own clock */
  const time_t seconds = (time_t)(date_ns / SECOND);
  if (!gmtime_r(&seconds, &parts) || !strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts)) return ETHD_OK;
  snprintf(text, sizeof text, "%" PRId64 " %s.%09" PRId64 "Z", instant, date, date_ns % SECOND);
  return ethd_recording_event(recording, "clock", text);
}
