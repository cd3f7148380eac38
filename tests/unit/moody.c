#include "unit/moody.h"

#include <math.h>
#include <string.h>

moody mood;

static ethd_status status_of(int m) {
  return m == MOODY_FAIL ? ETHD_E_LAW : m == MOODY_POSITIVE ? ETHD_STATUS_STALE : ETHD_OK;
}

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  (void)p, (void)state;
  tau[0] = 40 * in->eps_q[0] + in->eps_q_dot[0];
  tau[1] = mood.tracking == MOODY_BAD ? mood.value : 40 * in->eps_q[1] + in->eps_q_dot[1];
  return status_of(mood.tracking);
}

static ethd_status touch(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)p, (void)state, (void)speed, (void)entering;
  *force = mood.contact == MOODY_BAD ? mood.value : gap < 0 ? 2500 * gap : 0;
  return status_of(mood.contact);
}

static ethd_status rule(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state;
  out->state = c->d_re < 0 ? ETHD_VO : ETHD_TRANSPARENT;
  out->share = 1;
  if (mood.transition == MOODY_BAD) memcpy((char *)out + mood.field, &mood.value, sizeof mood.value);
  return status_of(mood.transition);
}

#define LAW(type, kind) {sizeof(type), ETHD_ABI, kind, 0, "moody", "as it is told", NULL, 0, NULL, NULL}
static const ethd_tracking_law moody_tracking = {.law = LAW(ethd_tracking_law, ETHD_TRACKING), .step = track};
static const ethd_contact_law moody_contact = {.law = LAW(ethd_contact_law, ETHD_CONTACT), .step = touch};
static const ethd_transition_law moody_transition = {.law = LAW(ethd_transition_law, ETHD_TRANSITION), .step = rule};

void moody_open(rig *r, int latch) {
  memset(&mood, 0, sizeof mood);
  rig_open(r, RIG_WALL);
  ethd_setup_tracking(&r->setup, &moody_tracking);
  ethd_setup_contact(&r->setup, &moody_contact);
  ethd_setup_transition(&r->setup, &moody_transition);
  r->setup.dynamics = (ethd_dynamics){{MOODY_MASS, MOODY_MASS}, NAN, NAN, 0};
  r->setup.limits.latch = latch;
  rig_start(r);
}

ethd_sense moody_sense(const rig *r) {
  motion m = rig_at(-0.001, 0.010, 0.001);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  return s;
}

void moody_expect_safe(const rig *r, ethd_status status, ethd_fault fault) {
  if (r->status != status || r->trace.fault != (int64_t)fault)
    ck_abort_msg("%s, fault %d", ethd_status_sentence(r->status), (int)r->trace.fault);
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->command.torque[1] == 0);
  ck_assert(r->trace.tau[0] == 0 && r->trace.tau[1] == 0);
}

void moody_expect_event(rig *r, int kind, int code, double value) {
  ethd_event e = rig_poll(r);
  if ((int)e.kind != kind || e.code != code || !(e.value == value || isnan(value)))
    ck_abort_msg("event %d, %d, %g; not %d, %d, %g", (int)e.kind, e.code, e.value, kind, code, value);
}
