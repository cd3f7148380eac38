/* Details that a small bug would change and that no other test looks at: found by changing lib at random
   (tests/mutation.sh). */
#include <math.h>
#include <string.h>

#include "scene/check.h"
#include "unit/rig.h"

/* A polygon that comes to a point twice: the message names both visits. */
TEST(test_same_point_twice) {
  const double p[] = {0, 0, 2, 0, 1, 1, 2, 2, 0, 2, 1, 1};
  char room[1024];
  size_t meet[2] = {99, 99};
  ck_assert(!ethd__is_simple(p, 6, room, meet));
  ck_assert((meet[0] == 2 && meet[1] == 5) || (meet[0] == 5 && meet[1] == 2));
}

/* ---- which law runs ---- */

static const ethd_control *asked;
static const ethd_law *answers[2];

static ethd_status rule(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) {
  (void)p, (void)state, (void)c;
  out->share = 1;
  answers[0] = ethd_control_law(asked);
  return ETHD_OK;
}

static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)p, (void)state, (void)gap, (void)speed, (void)entering;
  *force = 0;
  answers[1] = ethd_control_law(asked);
  return ETHD_OK;
}

TEST(test_law_of_each_kind) {
  ethd_transition_law ruling = ethd_transition_smooth;
  ethd_contact_law pushing = ethd_contact_spring;
  ruling.step = rule;
  pushing.step = push;
  rig r;
  rig_open(&r, "halfplane -1 0 -0.238\nhalfplane 0 -1 -0.238\n");
  ethd_setup_transition(&r.setup, &ruling);
  ethd_setup_contact(&r.setup, &pushing);
  rig_start(&r);
  asked = r.control;
  motion m = {{0.249, 0.249}, {0, 0}, {0.249, 0.249}, {0, 0}};
  rig_step(&r, &m);
  ck_assert_int_eq(r.trace.contacts, 2);
  ck_assert_ptr_eq(answers[0], &ruling.law);
  ck_assert_ptr_eq(answers[1], &pushing.law);
  rig_close(&r);
}

/* ---- the finger's fit ---- */

/* A polygon far from its first vertex's middle is judged by its area over its extent: a sliver is none. */
TEST(test_slivers) {
  ethd_fit fit;
  ethd_setup s = ethd_setup_default();
  ck_assert_int_eq(ethd_fit_prepare(ETHD_FIT_CENTROID, s.fit_p, 0.012, 0.0075, &fit, NULL), ETHD_OK);
  ethd_finger finger;
  double r[ETHD_RAYS];
  for (int k = 0; k < ETHD_RAYS; k++) r[k] = k % 8 ? (double)NAN : 0.0045; /* two, opposite */
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  r[4] = 0.012 - 1e-14; /* a third one on the line between them, up to rounding */
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  r[4] = 0.0045;
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
}
