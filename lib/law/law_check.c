#include <stdbool.h>
#include <string.h>

#include "error.h"
#include "ethd/law.h"
#include "line.h"

/* The sizes of a law's struct, by kind: the smallest of ABI 1, and this library's. A longer struct was built against a
   newer header, whose functions and fields this library doesn't know. */
static const size_t smallest[] = {ETHD_TRACKING_LAW_MIN, ETHD_CONTACT_LAW_MIN, ETHD_TRANSITION_LAW_MIN};
static const size_t largest[] = {sizeof(ethd_tracking_law), sizeof(ethd_contact_law), sizeof(ethd_transition_law)};

static bool id_is_good(const char *id) {
  size_t n = id ? strlen(id) : 0;
  return n >= 1 && n <= 31 && strspn(id, "abcdefghijklmnopqrstuvwxyz0123456789-") == n;
}

static bool has_step(const ethd_law *law) {
  if (law->kind == ETHD_TRACKING) {
    const ethd_tracking_law *tracking = (const ethd_tracking_law *)(const void *)law;
    return tracking->step || ETHD_TRACKING_HAS(tracking, force) || ETHD_TRACKING_HAS(tracking, velocity);
  }
  if (law->kind == ETHD_CONTACT) return ((const ethd_contact_law *)(const void *)law)->step;
  return ((const ethd_transition_law *)(const void *)law)->step;
}

#define GAINS(kind) \
  (law->size >= offsetof(kind, gains) + sizeof(ethd_gains *) ? ((const kind *)(const void *)law)->gains : NULL)

const ethd_gains *ethd_law_gains(const ethd_law *law) {
  if (law->kind == ETHD_TRACKING) return GAINS(ethd_tracking_law);
  return law->kind == ETHD_CONTACT ? GAINS(ethd_contact_law) : GAINS(ethd_transition_law);
}

static bool gains_are_params(const ethd_law *law) {
  const ethd_gains *gains = ethd_law_gains(law);
  for (int i = 0; gains && i < 2; i++) {
    const char *name = i ? gains->damping : gains->stiffness;
    if (name && ethd_params_find(law->params, law->param_count, name) < 0) return false;
  }
  return true;
}

/* The ABI is checked first: if it differs, the following fields can't be trusted. */
ethd_status ethd_law_check(const ethd_law *law, ethd_error *error) {
  if (!law) return ethd__error(error, ETHD_E_ARGUMENT, "law");
  if (law->abi != ETHD_ABI) return ethd__refuse(error, ETHD_E_ABI, "abi", (ethd__found){law->abi, ETHD_ABI, ETHD_ABI});
  if (law->kind > ETHD_TRANSITION)
    return ethd__refuse(error, ETHD_E_ARGUMENT, "kind", (ethd__found){law->kind, 0, ETHD_TRANSITION});
  if (law->size < smallest[law->kind] || law->size > largest[law->kind])
    return ethd__refuse(error, ETHD_E_SIZE, "size",
                        (ethd__found){law->size, (double)smallest[law->kind], (double)largest[law->kind]});
  if (!id_is_good(law->id)) return ethd__error(error, ETHD_E_ARGUMENT, "id");
  if (!ethd__is_line(law->brief, ETHD_BRIEF_MAX)) return ethd__error(error, ETHD_E_ARGUMENT, law->id);
  if (law->state_size > ETHD_STATE_MAX)
    return ethd__refuse(error, ETHD_E_STATE, law->id, (ethd__found){law->state_size, 0, ETHD_STATE_MAX});
  if (!has_step(law)) return ethd__error(error, ETHD_E_ARGUMENT, law->id);
  ethd_status status = ethd_params_check_table(law->params, law->param_count, error);
  if (!status && !gains_are_params(law)) status = ethd__error(error, ETHD_E_TABLE, "gains");
  if (status < 0) ethd__error_prefix(error, law->id);
  return status;
}
