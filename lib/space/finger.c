/* The finger in space: given directly, or filtered from a tracker's readings; the readings' age and plausibility. */
#include "core/finger.h"
#include "core/rows.h"
#include "space/state.h"

static double seconds(int64_t a, int64_t b) { return 1e-9 * (double)(int64_t)((uint64_t)b - (uint64_t)a); }

static bool is_possible(const double v[3], double most) {
  return fabs(v[0]) <= most && fabs(v[1]) <= most && fabs(v[2]) <= most;
}

/* Processes this tick's reading; returns whether it was used. While the filter acquires the finger, gated readings
   don't count as implausible. */
static bool use(ethd__space_tick *t) {
  const ethd_space_sense *s = t->sense;
  ethd__space_state *state = t->state;
  const bool has_v = s->have & ETHD_SPACE_HAVE_READING_V;
  const bool new = s->sample_ns <= s->time_ns && (state->filter.used == 0 || s->sample_ns != state->reading_ns);
  if (!new || !is_possible(s->reading, ETHD_SENSE_LENGTH_MAX)) return false;
  if (has_v && !is_possible(s->reading_v, ETHD_SENSE_SPEED_MAX)) return false;
  const ethd_filter_reading reading = {.x = ethd_vec3_of(s->reading),
                                       .v = has_v ? ethd_vec3_of(s->reading_v) : (ethd_vec3){0, 0, 0},
                                       .age = seconds(s->sample_ns, s->time_ns),
                                       .noise = s->reading_noise,
                                       .v_noise = has_v ? s->reading_v_noise : 0,
                                       .extrapolated = s->have & ETHD_SPACE_HAVE_EXTRAPOLATED};
  const uint32_t gated = state->filter.gated;
  const bool acquires = state->filter.acquired < ETHD_FILTER_ACQUIRED;
  const bool used = ethd_filter_update3(&t->plan->filter, &state->filter, &reading) == ETHD_OK;
  if (t->plan->watches_finger)
    ethd__finger_doubt(&state->core, &state->implausible, state->filter.gated != gated && !acquires);
  if (!used) return false;
  state->reading_ns = s->sample_ns;
  state->reading_age = reading.extrapolated ? 0 : reading.age;
  return true;
}

static void find(ethd__space_tick *t) {
  const ethd_space_setup *setup = &t->plan->setup;
  ethd__space_state *state = t->state;
  t->core.finger = t->core.x; /* a finger that was never seen: the effector follows nothing */
  t->core.finger_v = t->core.v;
  if (t->sense->have & ETHD_SPACE_HAVE_FINGER) {
    t->core.finger = ethd_vec3_of(t->sense->finger);
    t->core.finger_v = ethd_vec3_of(t->sense->finger_v);
    return;
  }
  if (state->filter.started) ethd_filter_predict(&t->plan->filter, &state->filter, t->core.dt);
  if (t->sense->have & ETHD_SPACE_HAVE_READING && !use(t)) state->core.counters.readings_dropped++;
  if (t->plan->watches_finger && state->filter.used > 0) {
    const double age = seconds(state->reading_ns, t->sense->time_ns) - 0.5e-9; /* as in the plane */
    const double limits[2] = {setup->finger_age, setup->finger_lost};
    state->absent = ethd__finger_age(&state->core, age, limits, state->absent, t->core.dt);
  }
  if (state->filter.started) ethd_filter_output3(&t->plan->filter, &state->filter, &t->core.finger, &t->core.finger_v);
}

/* Notes a finger that has left a cap over its rim. */
static void watch_rim(ethd__space_tick *t) {
  if (!(t->sense->have & ETHD_SPACE_HAVE_NORMAL)) return;
  const double out = ethd_vec3_dot(ethd_vec3_of(t->sense->normal), ethd_vec3_sub(t->core.x, t->core.finger));
  if (!(out <= t->plan->setup.rim)) ethd__note(&t->state->core, ETHD_FAULT_FINGER_OUT);
}

void ethd__space_finger(ethd__space_tick *t) {
  find(t);
  if (t->plan->watches_rim) watch_rim(t);
}
