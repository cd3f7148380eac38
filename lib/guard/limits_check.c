#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "error.h"
#include "ethd/guard.h"
#include "fp_mode.h"

#define INF ((double)INFINITY)
#define AT(field) (uint32_t)offsetof(ethd_limits, field)

const ethd_limit ethd_limit_rows[ETHD_LIMITS] = {
    {"torque", "Nm", AT(torque), 1, ETHD_LIMIT_MOST, 0, INF, "largest torque of each joint"},
    {"torque_rate", "Nm/s", AT(torque_rate), 1, ETHD_LIMIT_MOST, 0, INF, "fastest change of each joint's torque"},
    {"speed", "m/s", AT(speed), 1, ETHD_LIMIT_MOST, 0, INF, "highest speed of the ring's centre"},
    {"workspace", "m", AT(workspace), 4, ETHD_LIMIT_RANGES, -INF, INF, "x_min x_max y_min y_max"},
    {"step_time", "s", AT(step_time), 1, ETHD_LIMIT_MOST, 1e-9, INF, "time budget of one step"},
    {"reach", "m", AT(reach), 2, ETHD_LIMIT_RANGES, -INF, INF, "r_min r_max"},
    {"joints", "rad", AT(joints), 4, ETHD_LIMIT_RANGES, -INF, INF, "q1_min q1_max q2_min q2_max"},
    {"margin", "m", AT(margin), 1, ETHD_LIMIT_LEAST, 0, 1,
     "distance inside the workspace's and reach's edge at which a soft wall pushes back"},
    {"energy", "J", AT(energy), 1, ETHD_LIMIT_MOST, 1e-9, INF, "energy that a contact may release before it is damped"},
    {"nominal_torque", "Nm", AT(nominal_torque), 1, ETHD_LIMIT_MOST, 1e-9, INF,
     "torque that each motor can give continuously"},
    {"heat_time", "s", AT(heat_time), 1, ETHD_LIMIT_MOST, 1e-3, INF, "thermal time constant of a motor"},
    {"gap", "s", AT(gap), 1, ETHD_LIMIT_MOST, 1e-9, INF, "longest time between two steps"},
    {"finger_age", "s", AT(finger_age), 1, ETHD_LIMIT_MOST, 1e-4, INF,
     "age of the finger's reading at which tracking fades out"},
    {"finger_lost", "s", AT(finger_lost), 1, ETHD_LIMIT_MOST, 1e-4, INF,
     "age of the finger's reading at which the ring is stopped"},
    {"clean_time", "s", AT(clean_time), 1, ETHD_LIMIT_LEAST, 0, 1e6,
     "time without a fault that an acknowledgement requires"},
    {"stop_time", "s", AT(stop_time), 1, ETHD_LIMIT_MOST, 1e-3, INF, "longest stop, after which the torque is removed"},
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

void ethd_limits_fill(ethd_limits *out, uint32_t size) {
  memset(out, 0, size);
  out->size = size;
  if (size != sizeof *out) return;
  out->latch = 1;
  for (const ethd_limit *row = ethd_limit_rows; row < ethd_limit_rows + ETHD_LIMITS; row++)
    for (uint32_t i = 0; i < row->count; i++) ethd_limit_of(out, row)[i] = none(row, i);
}

void ethd_limits_narrow(ethd_limits *limits, const ethd_limits *other) {
  if (limits->size != sizeof *limits) return;
  limits->size = other->size;
  if (other->size != sizeof *other) return;
  ethd_limits own = *other;
  for (const ethd_limit *row = ethd_limit_rows; row < ethd_limit_rows + ETHD_LIMITS; row++)
    for (uint32_t i = 0; i < row->count; i++)
      ethd_limit_of(limits, row)[i] = narrower(row, i, ethd_limit_of(limits, row)[i], ethd_limit_of(&own, row)[i]);
  limits->latch = limits->latch || other->latch;
}

static ethd_status check(const ethd_limit *row, const double *values, ethd_error *error) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = row->count; !status && i-- > 0;) {
    double most = row->kind == ETHD_LIMIT_RANGES && i % 2 == 0 ? values[i + 1] : row->max;
    status = ethd__check_number(error, row->name, values[i], row->min, most);
  }
  return status;
}

ETHD__FP_APART static ethd_status check_all(const ethd_limits *limits, ethd_error *error) {
  if (limits->size != sizeof *limits)
    return ethd__refuse(error, ETHD_E_SIZE, "size", (ethd__found){limits->size, sizeof *limits, sizeof *limits});
  ethd_limits own = *limits;
  ethd_status status = ETHD_OK;
  for (const ethd_limit *row = ethd_limit_rows; !status && row < ethd_limit_rows + ETHD_LIMITS; row++)
    status = check(row, ethd_limit_of(&own, row), error);
  return status;
}

ethd_status ethd_limits_check(const ethd_limits *limits, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, check_all(limits, error));
}
