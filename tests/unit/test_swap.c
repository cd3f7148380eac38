/* Changing laws while they work: at the tick of a swap the torque is what the old setup gives, to the
   last bit; afterwards the difference fades in a straight line. Motion is scripted, so that a controller
   that swaps and one that doesn't see the same. */
#include <math.h>
#include <string.h>

#include "control/controller.h"
#include "unit/draw.h"
#include "unit/rig.h"

/* A tap: in at 0.4 m/s, stopped 3 mm behind the wall, pressed, pulled out; the finger goes before. */
enum { TAP = 160 };

static motion tap(int tick) {
  double t = 0.001 * tick, d, v;
  if (tick < 50) {
    v = 0.4 * (1 - t * t / 0.0025);
    d = 0.0103 - 0.4 * (t - t * t * t / 0.0075);
  } else if (tick < 100) {
    v = 0.05 * sin(125.6 * (t - 0.05));
    d = -0.0030 - 0.0004 * (1 - cos(125.6 * (t - 0.05)));
  } else {
    v = -8 * (t - 0.1);
    d = -0.0030 + 4 * (t - 0.1) * (t - 0.1);
  }
  return rig_at(d, v, 0.0012 * sin(40 * t));
}

static const ethd_transition_law *const strategies[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                        &ethd_transition_offset};

/* ---- ten thousand random ones ---- */

static const char *const scenes[] = {
    RIG_WALL, RIG_WALL "halfplane 0 -1 -0.237\n", "segment 0.238 0.1 0.238 0.4\ncircle 0.2 0.23 0.035\n",
    "material soft k_e=300\npolygon 0 0 0.6 0 0.6 0.238 0.238 0.238 0.238 0.6 0 0.6 material=soft\n"};

static void random_p(const ethd_param *rows, uint32_t count, uint64_t n, double *p) {
  for (uint32_t i = 0; i < count; i++) {
    if (ethd_param_words(&rows[i]))
      p[i] = draw(n + i, 0, 1) < 0.5 ? 0 : 1;
    else if (isfinite(rows[i].max) || draw(n + i + 20, 0, 1) < 0.8)
      p[i] = rows[i].def * draw(n + i, 0.5, 1.5);
    else
      p[i] = INFINITY;
    if (p[i] < rows[i].min) p[i] = rows[i].min;
    if (p[i] > rows[i].max) p[i] = rows[i].max;
    if (!strcmp(rows[i].name, "window")) p[i] = floor(p[i]);
  }
}

static void randomize(ethd_setup *s, uint64_t n, ethd_scene *const scene[4]) {
  static const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                     &ethd_contact_hunt_crossley};
  n *= 1000;
  ethd_setup_transition(s, strategies[draw_bits(n) % 3]);
  ethd_setup_contact(s, contacts[draw_bits(n + 1) % 3]);
  ethd_setup_velocity(s, (ethd_velocity_method)(draw_bits(n + 2) % ETHD_VELOCITY_COUNT));
  ethd_setup_filter(s, (ethd_filter_method)(draw_bits(n + 3) % ETHD_FILTER_COUNT));
  random_p(s->transition->law.params, s->transition->law.param_count, n + 100, s->transition_p);
  random_p(s->contact->law.params, s->contact->law.param_count, n + 200, s->contact_p);
  random_p(s->tracking->law.params, s->tracking->law.param_count, n + 300, s->tracking_p);
  const ethd_method *v = &ethd_velocity_methods[s->velocity], *f = &ethd_filter_methods[s->filter];
  random_p(v->params, v->param_count, n + 400, s->velocity_p);
  random_p(f->params, f->param_count, n + 500, s->filter_p);
  s->finger_radius = draw(n + 4, 0.006, 0.009);
  s->finger_radius_max = draw(n + 5, 0.009, 0.0105);
  s->v_hysteresis = draw_bits(n + 6) % 2 ? draw(n + 6, 0, 0.02) : 0;
  s->swap_time = draw_bits(n + 7) % 5 ? draw(n + 7, 0, 0.05) : 0;
  if (draw_bits(n + 8) % 4 == 0) s->scene = draw_bits(n + 9) % 5 ? scene[draw_bits(n + 9) % 5 - 1] : NULL;
}

/* Speeds by difference, the finger by readings every third tick or known; now and then missed ticks. */
static ethd_sense scripted(rig *r, int tick) {
  motion m = tap(tick % TAP);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  if (tick / TAP % 2) s.have = ETHD_HAVE_FINGER;
  if (tick / TAP % 4 > 1) {
    s.have &= ~ETHD_HAVE_FINGER;
    s.centre[0] = m.xf.x - m.x.x + 1e-4 * draw_normal((uint64_t)tick);
    if (tick % 3 == 0) s.have |= ETHD_HAVE_CENTRE;
  }
  s.missed = draw((uint64_t)tick + 7777, 0, 1) < 0.03;
  s.time_ns = r->sense.time_ns + 1000000 * (1 + s.missed);
  s.sample_ns = s.time_ns - 2000000;
  return s;
}

/* The same controller without a fade. */
static void copy_without_fade(ethd_control *to, const ethd_control *from) {
  memcpy(to, from, sizeof *to);
  to->state.core.fade.elapsed = INFINITY;
}

TEST(test_ten_thousand) {
  static ethd_control plain;
  ethd_scene *scene[4];
  rig r;
  int tick = 0, nested = 0, moved = 0;
  for (int i = 0; i < 4; i++) scene[i] = rig_scene(scenes[i]);
  rig_open(&r, NULL);
  r.setup.scene = scene[0];
  rig_start(&r);
  for (int n = 0; n < 10000; n++) {
    ethd_sense s = scripted(&r, tick++);
    randomize(&r.setup, (uint64_t)n, scene);
    rig_post(&r);
    ethd_command told, bare;
    nested += !isinf(r.control->state.core.fade.elapsed);
    ck_assert_int_eq(ethd_control_rehearse(r.control, &s, &told), ETHD_OK); /* the one that doesn't swap */
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ck_assert_int_eq(r.trace.swap, 1);
    ck_assert_mem_eq(told.torque, r.trace.tau, sizeof told.torque);
    ck_assert_int_eq(rig_poll(&r).kind, ETHD_EVENT_TAKEN);
    double delta[2], elapsed = 0, last[2];
    memcpy(delta, r.control->state.core.fade.delta, sizeof delta);
    memcpy(last, delta, sizeof last);
    moved += fabs(delta[0]) > 0.1;
    copy_without_fade(&plain, r.control);
    for (int k = (int)(draw_bits((uint64_t)n) % 25); k > 0; k--) {
      s = scripted(&r, tick++);
      /* this estimator works with the commanded torque, fade included */
      if (r.setup.velocity == ETHD_VELOCITY_KALMAN) copy_without_fade(&plain, r.control);
      ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
      ck_assert_int_eq(ethd_control_step(&plain, &s, &bare, NULL), ETHD_OK);
      double dt = 0.001 * (double)(1 + s.missed), share;
      elapsed += dt;
      share = elapsed < r.setup.swap_time - 1e-10 ? 1 - elapsed / r.setup.swap_time : 0;
      for (int i = 0; i < 2; i++) {
        double fade = r.trace.tau[i] - bare.torque[i], grain = 1e-15 * fabs(bare.torque[i]) + 1e-12;
        if (share == 0 && fade != 0) ck_abort_msg("swap %d: %g left of the fade", n, fade);
        ck_assert_double_eq_tol(fade, share * delta[i], 1e-9 * fabs(delta[i]) + grain);
        double most = r.setup.swap_time > dt ? fabs(delta[i]) * dt / r.setup.swap_time : fabs(delta[i]);
        ck_assert_double_le(fabs(fade - last[i]), most * (1 + 1e-9) + 2 * grain);
        last[i] = fade;
      }
    }
  }
  ck_assert_msg(nested > 3000 && moved > 3000, "%d swaps within a fade, %d with something to bridge", nested, moved);
  rig_close(&r);
  for (int i = 0; i < 4; i++) ethd_scene_destroy(scene[i]);
}

/* The same setup again: no difference at all, ever, of anything that was estimated either. */
TEST(test_nothing_new) {
  rig r, stays;
  rig_open(&r, RIG_WALL);
  rig_open(&stays, RIG_WALL);
  stays.setup.scene = r.scene;
  rig_start(&r);
  rig_start(&stays);
  for (int tick = 0; tick < 8 * TAP; tick++) {
    if (tick % 3 == 1) rig_post(&r);
    ethd_sense s = scripted(&r, tick);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ck_assert_int_eq(rig_try(&stays, &s), ETHD_OK);
    r.trace.swap = 0;
    ck_assert_mem_eq(&r.trace, &stays.trace, sizeof r.trace);
    (void)rig_poll(&r);
  }
  rig_close(&r);
  rig_close(&stays);
}
