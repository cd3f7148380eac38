#include "ethd/fault.h"

#include <stdbool.h>

static const struct {
  const char *bound, *sentence;
  ethd_reaction reaction[2];
} rows[ETHD_FAULT_COUNT] = {[ETHD_FAULT_NONE] = {"", "no fault", {ETHD_REACTION_NONE, ETHD_REACTION_NONE}},
#define ROW(row, name, first, second, bound, sentence) \
  [row] = {bound, sentence, {ETHD_REACTION_##first, ETHD_REACTION_##second}},
                            ETHD_FAULTS(ROW)
#undef ROW
};

static bool is_row(ethd_fault fault) { return (unsigned)fault < ETHD_FAULT_COUNT; }

const char *ethd_fault_sentence(ethd_fault fault) { return is_row(fault) ? rows[fault].sentence : "an unknown fault"; }

const char *ethd_fault_bound(ethd_fault fault) { return is_row(fault) ? rows[fault].bound : ""; }

ethd_reaction ethd_fault_reaction(ethd_fault fault, int32_t grave) {
  return is_row(fault) ? rows[fault].reaction[grave != 0] : ETHD_REACTION_NONE;
}
