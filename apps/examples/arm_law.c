/* Your own law for an arm that takes velocities, a complete plugin: the plate brakes before the wall, and is held there
   while the finger pushes on.

     cc -shared -fPIC arm_law.c -o mine.so $(pkg-config --cflags ethd) -lm
     ethd-tap --arm ur5e --plugin ./mine.so --transition mine,approach */
#include <ethd/plugin.h>
#include <math.h>

static const ethd_param params[] = {{"brake", "m/s2", 0.1, 100, 8, "deceleration before the wall"}};

/* v^2 / (2 a) is left before the wall; the last step goes as far as the wall. */
static ethd_status step(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) {
  const double left = fabs(c->d_re), ahead = c->d_re - c->d_fr; /* m; of the finger, from its place before the plate */
  (void)state;
  out->speed = copysign(fmin(sqrt(2 * p[0] * left), left / c->period), c->d_re);
  out->state = ahead > 0 && c->d_re < 0.001 ? ETHD_VO : ETHD_TRANSPARENT;
  return ETHD_OK;
}

/* The plate turns to a wall within this distance, too. */
static double range(const double *p, double speed) { return 0.2 + speed * speed / (2 * p[0]); }

static const ethd_transition_law mine = {
    .law = {sizeof mine, ETHD_ABI, ETHD_TRANSITION, 0, "mine", "brakes before the wall", params, 1, NULL, NULL},
    .step = step,
    .range = range};
static const ethd_law *const laws[] = {&mine.law};
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "mine", "1.0", laws, 1};
