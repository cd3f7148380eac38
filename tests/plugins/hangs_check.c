/* Loads well; its check never returns. */
#include <ethd/plugin.h>
static ethd_status check(const double *p, ethd_error *error) {
  volatile int on = 1;
  (void)p, (void)error;
  while (on) continue;
  return ETHD_OK;
}
#define CHECK check
#include "broken.h"
