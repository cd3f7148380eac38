#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "space/state.h"

ethd_status ethd_space_create(const ethd_space_setup *setup, ethd_space **out, ethd_error *error) {
  *out = NULL;
  ethd_space *space = aligned_alloc(_Alignof(ethd_space), sizeof *space);
  if (!space) return ethd__error(error, ETHD_E_MEMORY, "controller");
  memset(space, 0, sizeof *space);
  ethd_status status = ethd__space_prepare(setup, &space->plans[0], error);
  if (status < 0) {
    free(space);
    return status;
  }
  space->period = setup->period;
  space->kind = setup->kind;
  ethd_space_reset(space);
  *out = space;
  return ETHD_OK;
}

void ethd_space_destroy(ethd_space *space) { free(space); }

ethd_status ethd_space_post(ethd_space *space, const ethd_space_setup *setup, ethd_error *error) {
  if (atomic_load_explicit(&space->mail.posted, memory_order_acquire)) return ETHD_STATUS_BUSY;
  const ethd_space_setup *now = &space->plans[space->mail.ruling].setup;
  ethd_status status = ethd__space_prepare(setup, &space->plans[1 - space->mail.ruling], error);
  if (status < 0) return status;
  if (setup->period != now->period)
    return ethd__refuse(error, ETHD_E_ARGUMENT, "period", (ethd__found){setup->period, now->period, now->period});
  if (setup->kind != now->kind) return ethd__error(error, ETHD_E_ARGUMENT, "kind (it can't change)");
  atomic_store_explicit(&space->mail.posted, 1, memory_order_release);
  return ETHD_OK;
}
