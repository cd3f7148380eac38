/* Sound: two laws of one kind, and one of each other kind with the first one's id. */
#include <ethd/plugin.h>

static ethd_status rule(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state, (void)contact, (void)out;
  return ETHD_OK;
}

static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)p, (void)state, (void)gap, (void)speed, (void)entering;
  *force = 0;
  return ETHD_OK;
}

static ethd_status follow(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  (void)p, (void)state, (void)in;
  tau[0] = tau[1] = 0;
  return ETHD_OK;
}

static const ethd_transition_law one = {
    .law = {sizeof one, ETHD_ABI, ETHD_TRANSITION, 0, "one", "does nothing", NULL, 0, NULL, NULL}, .step = rule};
static const ethd_transition_law two = {
    .law = {sizeof two, ETHD_ABI, ETHD_TRANSITION, 0, "two", "does nothing", NULL, 0, NULL, NULL}, .step = rule};
static const ethd_contact_law soft = {
    .law = {sizeof soft, ETHD_ABI, ETHD_CONTACT, 0, "one", "no wall at all", NULL, 0, NULL, NULL}, .step = push};
static const ethd_tracking_law still = {
    .law = {sizeof still, ETHD_ABI, ETHD_TRACKING, 0, "one", "stays where it is", NULL, 0, NULL, NULL}, .step = follow};
static const ethd_law *const laws[] = {&soft.law, &one.law, &two.law, &still.law};

ETHD_API extern const ethd_plugin_entry ethd_plugin;
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "pair", "1.0", laws, 4};
