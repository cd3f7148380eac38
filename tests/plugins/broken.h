/* What the broken plugins share: a law that does nothing, whose table a plugin may spoil. */
#ifndef ETHD_TESTS_BROKEN_H
#define ETHD_TESTS_BROKEN_H

#include <ethd/plugin.h>

#ifndef STATE
#define STATE 0
#endif
#ifndef PARAMS
#define PARAMS NULL
#define PARAM_COUNT 0
#endif
#ifndef STEP
static ethd_status step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state, (void)contact, (void)out;
  return ETHD_OK;
}
#define STEP step
#endif
#ifndef BRIEF
#define BRIEF "does nothing"
#endif
#ifndef CHECK
#define CHECK NULL
#endif
#ifndef ENTRY
#define ENTRY ethd_plugin
#endif
#ifndef ENTRY_ID
#define ENTRY_ID "broken"
#endif
#ifndef ENTRY_VERSION
#define ENTRY_VERSION "0"
#endif
#ifndef ENTRY_LAWS
#define ENTRY_LAWS laws
#endif
#ifndef ENTRY_SIZE
#define ENTRY_SIZE ((uint32_t)sizeof(ethd_plugin_entry))
#endif
#ifndef ABI
#define ABI ETHD_ABI
#endif

static const ethd_transition_law law = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, STATE, "broken", BRIEF, PARAMS, PARAM_COUNT, CHECK,
            NULL},
    .step = STEP,
};
static const ethd_law *const laws[] = {&law.law, &law.law};

#ifndef LAWS
#define LAWS 1
#endif
ETHD_API extern const ethd_plugin_entry ENTRY;
const ethd_plugin_entry ENTRY = {ENTRY_SIZE, ABI, ENTRY_ID, ENTRY_VERSION, ENTRY_LAWS, LAWS};

#endif
