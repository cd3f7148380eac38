#include "error.h"

#include <string.h>

/* Copies a name without its control characters: it may come from a plugin, and terminals obey them. */
static void copy_name(char *to, size_t room, const char *from) {
  size_t n = 0;
  for (; n < room - 1 && from[n]; n++) to[n] = (unsigned char)from[n] < ' ' || from[n] == 0x7f ? '?' : from[n];
  to[n] = 0;
}

ethd_status ethd__refuse(ethd_error *error, ethd_status status, const char *name, ethd__found found) {
  if (error) {
    memset(error, 0, sizeof *error);
    error->status = status;
    error->found = found.value;
    error->min = found.min;
    error->max = found.max;
    copy_name(error->name, sizeof error->name, name);
  }
  return status;
}

ethd_status ethd__error(ethd_error *error, ethd_status status, const char *name) {
  return ethd__refuse(error, status, name, ethd__unsaid);
}

void ethd__error_prefix(ethd_error *error, const char *prefix) {
  if (!error) return;
  char name[sizeof error->name];
  size_t n = strlen(prefix);
  if (n > sizeof name - 2) n = sizeof name - 2; /* unreachable: ids and names of at most 31 characters come here */
  memcpy(name, prefix, n);
  name[n] = '.';
  copy_name(name + n + 1, sizeof name - n - 1, error->name);
  memcpy(error->name, name, sizeof name);
}

ethd_status ethd__check_number(ethd_error *error, const char *name, double value, double min, double max) {
  if (isgreaterequal(value, min) && islessequal(value, max)) return ETHD_OK; /* NaN raises no trap */
  return ethd__refuse(error, isnan(value) ? ETHD_E_NOT_FINITE : ETHD_E_RANGE, name, (ethd__found){value, min, max});
}
