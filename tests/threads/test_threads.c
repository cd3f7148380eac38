/* Two threads: one steps, the other posts setups with scenes of their own, polls and clears. Whole setups
   arrive or none, every replaced scene comes back once and in order, and thread sanitizers find no race. */
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "unit/rig.h"

enum { POSTS = 10000 };

/* ---- laws whose numbers must all be the same ---- */

static atomic_int torn;
static _Thread_local double number; /* of this tick */

static void same(const double *p, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    if (p[i] != number) atomic_fetch_add(&torn, 1);
}

static ethd_status rule(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  double *kept = state; /* belongs to this law and contact: it counts up, from 0 */
  (void)c;
  number = p[0];
  same(p, 6);
  if (kept[0] != kept[1]) atomic_fetch_add(&torn, 1);
  kept[1] = ++kept[0];
  out->state = ETHD_VO;
  out->share = 1;
  return ETHD_OK;
}

static ethd_status touch(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)state, (void)speed, (void)entering;
  same(p, 6);
  *force = gap < 0 ? 1000 * gap : 0;
  return ETHD_OK;
}

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  (void)state;
  same(p, 6);
  tau[0] = in->eps_q[0];
  tau[1] = in->eps_q[1];
  return ETHD_OK;
}

#define ROW(name) {name, "1", 0, 1e9, 0, "the number"}
static const ethd_param params[] = {ROW("a"), ROW("b"), ROW("c"), ROW("d"), ROW("e"), ROW("f")};
#define LAW(type, kind) {sizeof(type), ETHD_ABI, kind, 16, "same", "all the same number", params, 6, NULL, NULL}
static const ethd_transition_law transitions[2] = {{.law = LAW(ethd_transition_law, ETHD_TRANSITION), .step = rule},
                                                   {.law = LAW(ethd_transition_law, ETHD_TRANSITION), .step = rule}};
static const ethd_contact_law contact = {.law = LAW(ethd_contact_law, ETHD_CONTACT), .step = touch};
static const ethd_tracking_law tracking = {.law = LAW(ethd_tracking_law, ETHD_TRACKING), .step = track};

static void set_number(ethd_setup *s, int n) {
  s->transition = &transitions[n % 2];
  s->contact = &contact;
  s->tracking = &tracking;
  for (int i = 0; i < 6; i++) s->transition_p[i] = s->contact_p[i] = s->tracking_p[i] = n;
}

/* ---- the control thread ---- */

static atomic_int stop;
static atomic_long faulty;

static void *control_thread(void *rig_) {
  rig *r = rig_;
  motion m = rig_at(-0.001, 0.01, 0);
  ethd_sense good = rig_sense(&r->setup.arm, &m);
  for (long tick = 0; !atomic_load(&stop); tick++) {
    ethd_sense s = good;
    ethd_command command;
    ethd_trace trace;
    s.time_ns = 1000000 * tick;
    if (tick % 50 == 49) s.q[0] = (double)NAN;
    if (ethd_control_step(r->control, &s, &command, tick % 2 ? &trace : NULL) < 0) atomic_fetch_add(&faulty, 1);
    if (tick % 16 == 0) (void)!ethd_control_rehearse(r->control, &good, &command);
    if (tick % 4 == 0) sched_yield();
  }
  return NULL;
}

/* ---- the main thread ---- */

typedef struct ledger {
  ethd_scene *scenes[POSTS + 1];
  int given, taken, faults, cleared; /* scenes posted; events */
} ledger;

static void drain(rig *r, ledger *l) {
  for (ethd_event e; (e = rig_poll(r)).kind != 0;) {
    if (e.kind == ETHD_EVENT_FAULT) l->faults++;
    if (e.kind == ETHD_EVENT_CLEARED) l->cleared++;
    if (e.kind != ETHD_EVENT_TAKEN) continue;
    ck_assert_ptr_eq(e.scene, l->scenes[l->taken]);
    ethd_scene_destroy(l->scenes[l->taken++]);
  }
}

static ethd_scene *scene_of(int n) {
  char text[100];
  snprintf(text, sizeof text, "halfplane -1 0 -0.238\ncircle 0.1 0.1 %.4f\n", 0.001 + n * 1e-6);
  return rig_scene(text);
}

TEST(test_post_poll_clear_while_stepping) {
  static ledger l;
  static rig r;
  pthread_t thread;
  rig_open(&r, NULL);
  r.setup.scene = l.scenes[0] = scene_of(0);
  set_number(&r.setup, 0);
  rig_start(&r);
  ethd_setup setup = r.setup; /* the other thread reads the rig */
  ck_assert_int_eq(pthread_create(&thread, NULL, control_thread, &r), 0);
  while (l.given < POSTS) {
    setup.scene = scene_of(l.given + 1);
    set_number(&setup, l.given + 1);
    ethd_status status;
    while ((status = ethd_control_post(r.control, &setup, NULL)) == ETHD_STATUS_BUSY) {
      drain(&r, &l);
      sched_yield();
    }
    ck_assert_int_eq(status, ETHD_OK);
    l.scenes[++l.given] = (ethd_scene *)setup.scene;
    if (l.given % 3 == 0) drain(&r, &l);
    if (l.given % 7 == 0) ethd_control_acknowledge(r.control);
  }
  while (l.taken < POSTS) {
    drain(&r, &l);
    sched_yield();
  }
  /* the event ring alone, some times round */
  for (int more = l.faults + 300; l.faults < more;) {
    ethd_control_acknowledge(r.control);
    drain(&r, &l);
    sched_yield();
  }
  atomic_store(&stop, 1);
  pthread_join(thread, NULL);
  drain(&r, &l);
  ethd_counters c;
  ethd_control_counters(r.control, &c);
  ck_assert_int_eq(atomic_load(&torn), 0);
  ck_assert_uint_eq(c.swaps, POSTS);
  ck_assert_int_eq(l.taken, POSTS);
  ck_assert(l.faults > 10 && l.cleared > 10 && atomic_load(&faulty) > 10);
  ck_assert_uint_le(c.faults[ETHD_FAULT_INPUT], (uint64_t)l.faults + c.events_dropped);
  ethd_scene_destroy(l.scenes[POSTS]);
  rig_close(&r);
}
