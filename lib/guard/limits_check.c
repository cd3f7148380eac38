#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "error.h"
#include "ethd/guard.h"

#define INF ((double)INFINITY)
#define AT(field) (uint32_t)offsetof(ethd_limits, field)

const ethd_limit ethd_limit_rows[ETHD_LIMITS] = {
    {"torque", "Nm", AT(torque), 1, ETHD_LIMIT_MOST, 0, INF, "of each joint"},
    {"torque_rate", "Nm/s", AT(torque_rate), 1, ETHD_LIMIT_MOST, 0, INF, "of each joint"},
    {"speed", "m/s", AT(speed), 1, ETHD_LIMIT_MOST, 0, INF, "of the ring"},
    {"workspace", "m", AT(workspace), 4, ETHD_LIMIT_RANGES, -INF, INF, "x_min x_max y_min y_max"},
    {"step_time", "s", AT(step_time), 1, ETHD_LIMIT_MOST, 1e-9, INF, "time budget of one step"},
    {"reach", "m", AT(reach), 2, ETHD_LIMIT_RANGES, -INF, INF, "r_min r_max"},
    {"joints", "rad", AT(joints), 4, ETHD_LIMIT_RANGES, -INF, INF, "q1_min q1_max q2_min q2_max"},
    {"margin", "m", AT(margin), 1, ETHD_LIMIT_LEAST, 0, 1, "inside of workspace and reach, where a wall pushes back"},
    {"energy", "J", AT(energy), 1, ETHD_LIMIT_MOST, 1e-9, INF, "that a contact may give away before it is damped"},
    {"nominal_torque", "Nm", AT(nominal_torque), 1, ETHD_LIMIT_MOST, 1e-9, INF,
     "that each motor can give continuously"},
    {"heat_time", "s", AT(heat_time), 1, ETHD_LIMIT_MOST, 1e-3, INF, "time constant of a motor's heat"},
    {"gap", "s", AT(gap), 1, ETHD_LIMIT_MOST, 1e-9, INF, "longest time between two steps"},
    {"finger_age", "s", AT(finger_age), 1, ETHD_LIMIT_MOST, 1e-4, INF,
     "age of the finger's reading at which tracking fades out"},
    {"finger_lost", "s", AT(finger_lost), 1, ETHD_LIMIT_MOST, 1e-4, INF,
     "age of the finger's reading at which the ring is stopped"},
    {"clean_time", "s", AT(clean_time), 1, ETHD_LIMIT_LEAST, 0, 1e6,
     "without a fault before an acknowledgement counts"},
};

/* Returns the value that means "no limit", for number i of the row. */
static double none(const ethd_limit *row, uint32_t i) {
  if (row->kind == ETHD_LIMIT_LEAST) return row->min;
  return row->kind == ETHD_LIMIT_RANGES && i % 2 == 0 ? -INF : INF;
}

static double narrower(const ethd_limit *row, uint32_t i, double a, double b) {
  bool rises = row->kind == ETHD_LIMIT_LEAST || (row->kind == ETHD_LIMIT_RANGES && i % 2 == 0);
  return rises ? fmax(a, b) : fmin(a, b);
}

ethd_limits ethd_limits_none(void) {
  ethd_limits limits = {.latch = 1};
  for (const ethd_limit *row = ethd_limit_rows; row < ethd_limit_rows + ETHD_LIMITS; row++)
    for (uint32_t i = 0; i < row->count; i++) ethd_limit_of(&limits, row)[i] = none(row, i);
  return limits;
}

ethd_limits ethd_limits_torque(double torque) {
  ethd_limits limits = ethd_limits_none();
  limits.torque = torque;
  return limits;
}

ethd_limits ethd_limits_device(void) {
  ethd_limits limits = ethd_limits_none();
  limits.gap = 0.005;
  limits.clean_time = 1;
  limits.finger_age = 0.010;
  limits.finger_lost = 0.030;
  return limits;
}

ethd_limits ethd_limits_narrower(const ethd_limits *a, const ethd_limits *b) {
  ethd_limits r = *a, other = *b;
  for (const ethd_limit *row = ethd_limit_rows; row < ethd_limit_rows + ETHD_LIMITS; row++)
    for (uint32_t i = 0; i < row->count; i++)
      ethd_limit_of(&r, row)[i] = narrower(row, i, ethd_limit_of(&r, row)[i], ethd_limit_of(&other, row)[i]);
  r.latch = a->latch || b->latch;
  return r;
}

static ethd_status check(const ethd_limit *row, const double *values, ethd_error *error) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = row->count; !status && i-- > 0;) {
    double most = row->kind == ETHD_LIMIT_RANGES && i % 2 == 0 ? values[i + 1] : row->max;
    status = ethd__check_number(error, row->name, values[i], row->min, most);
  }
  return status;
}

ethd_status ethd_limits_check(const ethd_limits *limits, ethd_error *error) {
  ethd_limits own = *limits;
  ethd_status status = ETHD_OK;
  for (const ethd_limit *row = ethd_limit_rows; !status && row < ethd_limit_rows + ETHD_LIMITS; row++)
    status = check(row, ethd_limit_of(&own, row), error);
  return status;
}
