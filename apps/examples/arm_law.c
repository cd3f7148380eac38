/* Your own law for an arm that takes velocities, a complete plugin: the nearer the wall, the slower.

     cc -shared -fPIC arm_law.c -o mine.so $(pkg-config --cflags ethd)
     printf '[plugins]\nfile = mine.so\n[transition]\nlaw = mine\n' >>arm.ini */
#include <ethd/plugin.h>

static const ethd_param params[] = {{"rate", "1/s", 0.1, 100, 6, "speed to the wall, for each metre to it"}};

static ethd_status step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) {
  (void)state;
  out->speed = p[0] * contact->d_re;
  return ETHD_OK;
}

/* The law is asked from the distance on at which it begins to slow down. */
static double range(const double *p, double speed) { return speed / p[0]; }

static const ethd_transition_law mine = {
    .law = {sizeof mine, ETHD_ABI, ETHD_TRANSITION, 0, "mine", "slows down with the distance", params, 1, NULL, NULL},
    .step = step,
    .range = range};
static const ethd_law *const laws[] = {&mine.law};
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "mine", "1.0", laws, 1};
