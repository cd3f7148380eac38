#include <math.h>
#include <stdio.h>

#include "encoder/unwrap.h"

static ethd_status refuse(ethd_error *error, const char *name, double found, double min, double max) {
  ethd_status status = isnan(found) ? ETHD_E_NOT_FINITE : ETHD_E_RANGE;
  if (!error) return status;
  *error = (ethd_error){.status = status, .found = found, .min = min, .max = max};
  snprintf(error->name, sizeof error->name, "%s", name);
  return status;
}

static double counts_per_radian(const ethd__encoder_def *d) {
  return (double)d->counts_per_turn * d->ratio / (2 * 3.14159265358979323846);
}

ethd_status ethd__encoder_check(const ethd__encoder_def *d, double period, ethd_error *error) {
  const struct {
    const char *name;
    double value, min, max;
  } rows[] = {
      {"ceiling", (double)d->ceiling, 1, 0x1p64},
      {"counts_per_turn", (double)d->counts_per_turn, 1, 0x1p40},
      {"ratio", d->ratio, 1e-3, 1e4},
      {"offset", d->offset, -1e3, 1e3},
      {"speed_max", d->speed_max, 1e-3, 1e4},
      {"freeze_torque", d->freeze_torque, 1e-6, (double)INFINITY},
      {"freeze_time", d->freeze_time, 1e-6, 1e3},
      {"reverse_torque", d->reverse_torque, 1e-6, (double)INFINITY},
      {"reverse_time", d->reverse_time, 1e-6, 1e3},
      {"inertia", d->inertia, 1e-9, 1e6},
      {"sign", fabs((double)d->sign), 1, 1},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!(rows[i].value >= rows[i].min && rows[i].value <= rows[i].max))
      return refuse(error, rows[i].name, rows[i].value, rows[i].min, rows[i].max);
  double most = trunc((double)d->ceiling / 2) / (counts_per_radian(d) * period);
  return d->speed_max <= most ? ETHD_OK : refuse(error, "speed_max", d->speed_max, 1e-3, most);
}

#define APART 2.0 /* times: row 13 compares energies, whose share it knows no better */

bool ethd__encoder_doubt(const ethd__encoder_def *d, const ethd_setup *setup, int joint, char *sentence, size_t room) {
  double link = joint ? setup->arm.link2 : setup->arm.link1, mass = setup->dynamics.mass[joint];
  double known = mass * link * link;
  if (isinf(d->reverse_torque) || !(d->inertia >= APART * known || d->inertia * APART <= known)) return false;
  snprintf(
      sentence, room,
      "inertia of joint %d is %.3g kg m^2, but arm.mass_%c = %.3g kg on a link of %g m makes %.3g: %s; set inertia",
      joint + 1, d->inertia, 'x' + joint, mass, link, known,
      d->inertia < known ? "a reversed encoder isn't noticed"
                         : "a pushing hand may be mistaken for a reversed encoder");
  return true;
}
