/* Your own law, a complete plugin.

     cc -shared -fPIC law.c -o mine.so $(pkg-config --cflags ethd)
     printf '[plugins]\nfile = mine.so\n[transition]\nlaw = mine\n' >mine.ini
     ethd-tap --config mine.ini --transition mine,offset */
#include <ethd/plugin.h>

static const ethd_param params[] = {{"brake", "Ns/m", 0, 1000, 60, "damping inside the wall"}};

static ethd_status step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) {
  (void)state;
  out->beta = contact->d_re < 0 ? 0.1 : 1;
  out->share = 1;
  out->damping = contact->d_re < 0 ? p[0] : 0;
  out->state = contact->d_re < 0 ? ETHD_VO : ETHD_TRANSPARENT;
  return ETHD_OK;
}

static const ethd_transition_law mine = {
    .law = {sizeof mine, ETHD_ABI, ETHD_TRANSITION, 0, "mine", "damped wall", params, 1, NULL, NULL}, .step = step};
static const ethd_law *const laws[] = {&mine.law};
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "mine", "1.0", laws, 1};
