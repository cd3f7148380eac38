/* A law of one's own: copy this file and change it.

     cc -shared -fPIC mylaw.c -o mylaw.so $(pkg-config --cflags ethd)

     [plugins]     file = mylaw.so
     [transition]  law = brake-ahead      force = 4

   It brakes before the wall, where the paper's VO-B brakes behind it. A ring of mass m at speed v stands
   at the surface if the force

     F = m v^2 / (2 d_re)                       gap d_re > 0, entering

   holds it from here on. Braking begins when F exceeds `force`, what the motors can surely give, and
   follows F until the ring stands; met behind the surface, the ring is braked with `force`. Then the wall
   is rendered where the ring stopped, or in its own place when that is behind it.

                                                     abs(v) < v_th,
     transparent --- F > force, or d_re < 0 ---> braking --- or d_re < -d_beta ---> vo
          ^                                         |                               |
          '------------- d_re > d_beta -------------+-------------------------------'   */
#include <ethd/plugin.h>
#include <math.h>

enum { MASS, FORCE, V_TH, BETA_MIN, COUNT };

/* Values are checked against this table when they are posted; step trusts them. */
static const ethd_param params[COUNT] = {
    {"mass", "kg", 1e-3, 100, 0.12, "effective mass of the ring along the surface's normal"},
    {"force", "N", 0, 1e3, 4, "braking force that the motors can surely give"},
    {"v_th", "m/s", 1e-6, 10, 0.020, "below this speed the ring stands still"},
    {"beta_min", "1", 0, 1, 0.1, "share of tracking that is left at the wall"},
};

/* One block per contact, owned by the controller and zeroed when the contact begins: numbers only. */
typedef struct state {
  double phase;
  double eps;
} state;

/* Force that makes the ring stand at the surface, N. */
static double needed(const double *p, const ethd_contact *c) ETHD_RT {
  if (!(c->v > 0)) return 0;
  return c->d_re > 0 ? p[MASS] * c->v * c->v / (2 * c->d_re) : INFINITY;
}

static void advance(const double *p, state *s, const ethd_contact *c) ETHD_RT {
  if (s->phase != ETHD_TRANSPARENT && c->d_re > c->d_beta) {
    s->phase = ETHD_TRANSPARENT;
    s->eps = 0;
  } else if (s->phase == ETHD_TRANSPARENT && (needed(p, c) > p[FORCE] || c->d_re < 0)) {
    s->phase = ETHD_BRAKING;
  } else if (s->phase == ETHD_BRAKING && (fabs(c->v) < p[V_TH] || c->d_re < -c->d_beta)) {
    s->phase = ETHD_VO;
    s->eps = fmax(0, -c->d_re);
  }
}

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  state *s = block;
  advance(p, s, c);
  out->state = (int32_t)s->phase;
  out->share = s->phase == ETHD_VO ? 1 : 0;
  out->offset = s->eps;
  if (s->phase == ETHD_BRAKING) out->feed = -fmin(needed(p, c), p[FORCE]); /* along n, so: out */
  out->argument = c->d_fr + s->eps;
  double share = fmin(fmax(out->argument / c->d_beta, 0), 1);
  out->beta = p[BETA_MIN] + (1 - p[BETA_MIN]) * share; /* eq. 8 */
  return ETHD_OK;
}

static const ethd_transition_law brake_ahead = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(state), "brake-ahead",
            "brakes before the wall, then the wall where the ring stopped", params, COUNT, NULL, NULL},
    .step = step,
};

static const ethd_law *const laws[] = {&brake_ahead.law};
const ethd_plugin_entry ethd_plugin = {sizeof(ethd_plugin_entry), ETHD_ABI, "mylaw", "1.0", laws, 1};
