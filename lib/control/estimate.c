#include "control/control.h"
#include "estimate/fit_methods.h"

/* ---- ring ---- */

static void joint_speeds(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt,
                         double qd[2]) ETHD_RT {
  for (int i = 0; i < 2; i++)
    qd[i] = sense->have & ETHD_HAVE_DQ
                ? sense->dq[i]
                : ethd_velocity_step(&plan->velocity, &state->velocity[i], sense->q[i], state->guard.last[i], dt);
}

static void remember(ethd__state *state, int64_t time_ns, ethd_vec x) ETHD_RT {
  uint64_t i = state->remembered++ % ETHD__HISTORY;
  state->history[i].time_ns = time_ns;
  state->history[i].x = x;
}

/* b - a for any a <= b. */
static double seconds(int64_t a, int64_t b) ETHD_RT { return 1e-9 * (double)((uint64_t)b - (uint64_t)a); }

/* Where the ring stood at an earlier instant: linear between ticks, held beyond the history. */
static ethd_vec ring_at(const ethd__state *state, int64_t time_ns) ETHD_RT {
  uint64_t now = state->remembered - 1;
  uint64_t oldest = now >= ETHD__HISTORY ? now - ETHD__HISTORY + 1 : 0;
  uint64_t k = now;
  while (k > oldest && state->history[k % ETHD__HISTORY].time_ns > time_ns) k--;
  ethd_vec a = state->history[k % ETHD__HISTORY].x;
  int64_t ta = state->history[k % ETHD__HISTORY].time_ns;
  if (k == now || ta >= time_ns) return a;
  ethd_vec b = state->history[(k + 1) % ETHD__HISTORY].x;
  int64_t tb = state->history[(k + 1) % ETHD__HISTORY].time_ns;
  double share = seconds(ta, time_ns) / seconds(ta, tb);
  return ethd_vec_add(a, ethd_vec_scale(share, ethd_vec_sub(b, a)));
}

/* ---- finger ---- */

static ethd_vec reference(const ethd__plan *plan, const ethd__state *state, const ethd_sense *sense,
                          ethd_vec now) ETHD_RT {
  if (plan->filter.reference == ETHD_REFERENCE_TICK) return now;
  if (sense->have & ETHD_HAVE_RING) return (ethd_vec){sense->ring[0], sense->ring[1]};
  return ring_at(state, sense->sample_ns);
}

/* Of finger and ring, between the first of a frame's rays and the last. */
static ethd_vec relative_speed(const ethd__plan *plan, const ethd__state *state, const ethd_sense *sense) ETHD_RT {
  int64_t first = sense->sample_ns - (int64_t)(1e9 * plan->lag_most);
  int64_t last = sense->sample_ns - (int64_t)(1e9 * plan->lag_least);
  ethd_vec way = ethd_vec_sub(ring_at(state, last), ring_at(state, first));
  ethd_vec v = {state->filter.v[0], state->filter.v[1]};
  return ethd_vec_sub(v, ethd_vec_scale(1 / (plan->lag_most - plan->lag_least), way));
}

static ethd_status fit(const ethd__plan *plan, const ethd__state *state, const ethd_sense *sense,
                       ethd_finger *out) ETHD_RT {
  if (plan->lag_least == plan->lag_most || !state->filter.started) return ethd_fit_step(&plan->fit, sense->rays, out);
  return ethd__fit_moving(&plan->fit, sense->rays, plan->setup.ray_lag, relative_speed(plan, state, sense), out);
}

/* The reading of this tick relative to the ring; false: none, or not usable. */
static int reading(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, ethd_vec *out) ETHD_RT {
  if (sense->have & ETHD_HAVE_CENTRE) {
    *out = (ethd_vec){sense->centre[0], sense->centre[1]};
    return isfinite(out->x) && isfinite(out->y);
  }
  ethd_finger finger;
  if (fit(plan, state, sense, &finger) != ETHD_OK) return 0;
  state->finger_radius = finger.radius;
  *out = finger.centre;
  return 1;
}

/* From the past, and not the last one once more: ages, as sums of periods, wouldn't tell it from a reading
   that is newer by their rounding. */
static int is_new(const ethd__state *state, const ethd_sense *sense) ETHD_RT {
  return sense->sample_ns <= sense->time_ns && (state->filter.used == 0 || sense->sample_ns != state->reading_ns);
}

/* No: not used. The finger's centre can't be outside of the ring; what the filter gates out isn't plausible
   either. */
static int use(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, ethd_vec relative,
               ethd_vec ring) ETHD_RT {
  int watched = ethd__is_watched(plan), outside = watched && !(ethd_vec_norm(relative) <= plan->setup.ring_radius);
  uint32_t gated = state->filter.gated;
  ethd_vec x = ethd_vec_add(relative, reference(plan, state, sense, ring));
  ethd_status status =
      outside ? ETHD_STALE
              : ethd_filter_update(&plan->filter, &state->filter, x, seconds(sense->sample_ns, sense->time_ns));
  if (watched) ethd__finger_doubt(state, outside || state->filter.gated != gated);
  return status == ETHD_OK;
}

static void correct(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, ethd_vec ring) ETHD_RT {
  ethd_vec relative;
  if (is_new(state, sense) && reading(plan, state, sense, &relative) && use(plan, state, sense, relative, ring))
    state->reading_ns = sense->sample_ns;
  else
    state->counters.readings_dropped++;
}

static void finger(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_vec ring,
                   ethd_vec ring_v, ethd_vec *x, ethd_vec *v) ETHD_RT {
  if (sense->have & ETHD_HAVE_FINGER) {
    *x = (ethd_vec){sense->finger[0], sense->finger[1]};
    *v = (ethd_vec){sense->finger_v[0], sense->finger_v[1]};
    return;
  }
  if (sense->have & ETHD_HAVE_START)
    ethd_filter_start(&plan->filter, &state->filter, (ethd_vec){sense->finger[0], sense->finger[1]}, (ethd_vec){0, 0});
  else if (state->filter.started)
    ethd_filter_predict(&plan->filter, &state->filter, dt);
  if (sense->have & (ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS)) correct(plan, state, sense, ring);
  if (ethd__is_watched(plan)) ethd__finger_watch(plan, state, sense, dt);
  if (state->filter.started) {
    ethd_filter_output(&plan->filter, &state->filter, x, v);
  } else { /* never seen: nothing to follow */
    *x = ring;
    *v = ring_v;
  }
}

static void put(double to[2], ethd_vec from) ETHD_RT {
  to[0] = from.x;
  to[1] = from.y;
}

void ethd__estimate(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_pose *pose,
                    ethd_trace *out) {
  joint_speeds(plan, state, sense, dt, out->qd);
  ethd_arm_pose(&plan->setup.arm, sense->q, pose);
  ethd_vec v = ethd_mat_mul(pose->j, (ethd_vec){out->qd[0], out->qd[1]});
  remember(state, sense->time_ns, pose->x);
  ethd_vec xf, vf;
  finger(plan, state, sense, dt, pose->x, v, &xf, &vf);
  put(out->x, pose->x);
  put(out->v, v);
  put(out->xf, xf);
  put(out->vf, vf);
  out->rf = state->finger_radius;
}
