/* More I/O threads than there are. */
#include <ethd/driver.h>
static uint32_t many(const void *device) { return (void)device, 4000000000u; }
static ethd_status serve(void *device, uint32_t unit, int64_t now_ns) {
  return (void)device, (void)unit, (void)now_ns, ETHD_OK;
}
#define MORE .units = many, .service = serve
#include "driver_broken.h"
