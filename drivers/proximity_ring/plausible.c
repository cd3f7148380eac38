#include "proximity_ring/plausible.h"

#include <math.h>
#include <string.h>

#define UNUSED_FLAGS 0x80
#define ALL ((1u << ETHD_RAYS) - 1)
#define GONE_US 20000 /* us after which an earlier distance is no longer used */
#define PRESENT 6     /* rays that must meet something, so that a finger's shape can be judged */

ethd_status ethd__plausible_prepare(double ring_radius, double finger_radius, double gate, double speed, double slack,
                                    ethd__plausible *out, ethd_error *error) {
  double p[ETHD_PARAMS_MAX] = {0};
  const ethd_method *robust = &ethd_fit_methods[ETHD_FIT_ROBUST];
  memset(out, 0, sizeof *out);
  ethd_params_default(robust->params, robust->param_count, p);
  p[ethd_params_find(robust->params, robust->param_count, "gate")] = gate;
  out->speed = speed;
  out->slack = slack;
  return ethd_fit_prepare(ETHD_FIT_ROBUST, p, ring_radius, finger_radius, &out->fit, error);
}

static uint32_t bits(uint32_t mask) {
  uint32_t n = 0;
  for (; mask; mask &= mask - 1) n++;
  return n;
}

/* ---- flags ---- */

static uint32_t missing(const ethd__ring_frame *f) {
  uint32_t mask = 0;
  for (int k = 0; k < ETHD_RAYS; k++) mask |= (uint32_t)(f->counts[k] == ETHD__FRAME_MISSING) << k;
  return mask;
}

static bool board_missing(uint32_t mask) {
  const uint32_t whole = (1u << ETHD__FRAME_LANES) - 1;
  for (int b = 1; b < ETHD__FRAME_BOARDS; b++)
    if ((mask >> b * ETHD__FRAME_LANES & whole) == whole) return true;
  return false;
}

static bool flags_agree(const ethd__ring_frame *f, uint32_t mask) {
  if (f->flags & UNUSED_FLAGS) return false;
  if (((f->flags & ETHD__FRAME_SENSOR_MISSING) != 0) != (mask != 0)) return false;
  if ((f->flags & ETHD__FRAME_BOARD_MISSING) && !board_missing(mask)) return false;
  return !(f->flags & ETHD__FRAME_WATCHDOG) || (f->flags & ETHD__FRAME_FIRST);
}

/* ---- slew and geometry: bits of suspect rays ---- */

/* Returns a distance for comparison. Beyond the ring its value doesn't matter, only that nothing is nearer. */
static double seen(const ethd__plausible *p, double d) { return fmin(d, 2 * p->fit.ring_radius); }

static uint32_t too_fast(const ethd__plausible *p, const ethd__ring_frame *f, const double d[ETHD_RAYS]) {
  uint32_t passed_us = f->t_us - p->t_us, suspects = 0;
  double most = p->speed * 1e-6 * passed_us + p->slack;
  if (!p->started || passed_us > GONE_US) return 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    bool known = !isnan(d[k]) && !isnan(p->d[k]), near = fmin(d[k], p->d[k]) < p->fit.ring_radius;
    suspects |= (uint32_t)(known && near && fabs(seen(p, d[k]) - seen(p, p->d[k])) > most) << k;
  }
  return suspects;
}

static uint32_t off_circle(const ethd__plausible *p, const double d[ETHD_RAYS], uint32_t leave_out) {
  double rays[ETHD_RAYS];
  uint32_t met = 0;
  ethd_finger finger;
  for (int k = 0; k < ETHD_RAYS; k++) {
    rays[k] = leave_out >> k & 1 ? (double)NAN : d[k];
    met |= (uint32_t)(fabs(rays[k]) < p->fit.ring_radius) << k;
  }
  if (bits(met) < PRESENT) return 0;
  if (ethd_fit_step(&p->fit, rays, &finger) != ETHD_OK) return met;
  return met & ~finger.used;
}

/* Returns the rays that meet something, if there are enough for a finger; else none. */
static uint32_t on_finger(const ethd__plausible *p, const double d[ETHD_RAYS]) {
  uint32_t met = 0;
  for (int k = 0; k < ETHD_RAYS; k++) met |= (uint32_t)(fabs(d[k]) < p->fit.ring_radius) << k;
  return bits(met) < PRESENT ? 0 : met;
}

/* ---- sensors ---- */

/* Returns the sensors that show a symptom of a failure; `met` are the rays that lie on a finger's circle. */
static uint32_t symptoms(const ethd__plausible *p, const ethd__calibration *c, const ethd__ring_frame *f,
                         uint32_t met) {
  uint32_t same = 0, bad = 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    bool near = met >> k & 1; /* a finger that touches the ring saturates what it touches */
    bool edge = f->counts[k] == ETHD__FRAME_MISSING || (f->counts[k] == ETHD__FRAME_SATURATED && !near);
    same |= (uint32_t)(p->started && f->counts[k] == p->counts[k]) << k;
    bad |= (uint32_t)(edge || !(f->counts[k] >= 0.5 * c->sensors[k].dark)) << k; /* NaN: dark unknown */
  }
  return bits(same) <= ETHD_RAYS / 2 ? bad | same : bad;
}

static void judge_sensors(ethd__plausible *p, uint32_t bad) {
  for (int k = 0; k < ETHD_RAYS; k++) {
    uint8_t *failing = &p->failing[k];
    if (bad >> k & 1)
      *failing += *failing < ETHD__FAILING;
    else
      *failing -= *failing > 0;
    if (*failing == ETHD__FAILING) p->out |= 1u << k;
    if (*failing == 0) p->out &= ~(1u << k);
  }
}

/* ---- frames ---- */

static void keep(ethd__plausible *p, const ethd__ring_frame *f, const double d[ETHD_RAYS], uint32_t suspects,
                 double rays[ETHD_RAYS]) {
  for (int k = 0; k < ETHD_RAYS; k++) {
    bool left_out = (suspects | p->out) >> k & 1;
    rays[k] = left_out ? (double)NAN : d[k];
    p->d[k] = suspects >> k & 1 ? (double)NAN : d[k];
  }
  p->t_us = f->t_us;
  p->started = true;
  p->bad_in_a_row = 0;
  p->suspects += bits(suspects);
}

/* Returns the suspect rays among the sensors in use. */
static uint32_t suspect_rays(const ethd__plausible *p, const ethd__ring_frame *f, const double d[ETHD_RAYS]) {
  uint32_t fast = too_fast(p, f, d);
  if (p->bad_in_a_row >= ETHD__BAD_IN_A_ROW - 1) return off_circle(p, d, p->out) & ~p->out;
  return (fast | off_circle(p, d, p->out | fast)) & ~p->out;
}

bool ethd__plausible_step(ethd__plausible *p, const ethd__calibration *c, const ethd__ring_frame *f,
                          double rays[ETHD_RAYS]) {
  double d[ETHD_RAYS];
  if (!flags_agree(f, missing(f))) {
    p->bad++;
    return false;
  }
  for (int k = 0; k < ETHD_RAYS; k++) d[k] = ethd__sensor_distance(&c->sensors[k], f->counts[k]);
  uint32_t suspects = suspect_rays(p, f, d), bad = symptoms(p, c, f, on_finger(p, d) & ~suspects) | suspects;
  if (bits(suspects) > ETHD__SUSPECTS_MAX && p->bad_in_a_row < ETHD__BAD_IN_A_ROW - 1) {
    p->bad_in_a_row++;
    p->bad++;
    return false;
  }
  memcpy(p->counts, f->counts, sizeof p->counts);
  judge_sensors(p, bad & ALL);
  keep(p, f, d, suspects, rays);
  return true;
}
