#include "identify/page.h"

#include <math.h>
#include <string.h>

#include "sim/plant.h"
#include "text/text.h"

#define PLANT_NUMBER "%.7g"

/* ---- the plant ---- */

static bool is_fitted(const ethd__fit *f, ethd__unknown u) { return !isnan(f->low[u]); }

void ethd__finding_plant(ethd__finding *f) {
  for (int u = 0; u < ETHD__UNKNOWNS; u++)
    ethd__unknown_set(&f->plant, (ethd__unknown)u, ethd__unknown_value(&f->fit.plant, (ethd__unknown)u));
  f->plant.friction = fmax(f->plant.friction, 0);
  f->plant.viscous = fmax(f->plant.viscous, 0);
  f->plant.delay = fmax(f->plant.delay, 0);
  f->plant.damping = fmax(f->plant.damping, 0);
  f->plant.count = f->sensing.count;
  f->plant.count_phase = f->sensing.count_drawn;
  if (!isnan(f->sensing.rate.value)) f->plant.rate = f->sensing.rate.value;
  if (!isnan(f->sensing.latency.value)) f->plant.latency = f->sensing.latency.value;
  if (!isnan(f->sensing.noise.value)) f->plant.noise = f->sensing.noise.value;
}

/* ---- information about a row ---- */

static int unknown_of(const ethd__key_row *row) {
  for (int u = 0; u < ETHD__UNKNOWNS; u++)
    if (ethd__unknown_rows[u].offset == row->offset) return u;
  return -1;
}

static const ethd__bracket *bracket_of(const ethd__finding *f, const ethd__key_row *row) {
  if (!strcmp(row->section, "proximity") && !strcmp(row->param.name, "rate")) return &f->sensing.rate;
  if (!strcmp(row->section, "proximity") && !strcmp(row->param.name, "latency")) return &f->sensing.latency;
  if (!strcmp(row->section, "proximity") && !strcmp(row->param.name, "noise")) return &f->sensing.noise;
  return NULL;
}

static bool is_count(const ethd__key_row *row) {
  return !strcmp(row->param.name, "count") || !strcmp(row->param.name, "count_phase");
}

/* Fills the words that follow a number in the file and on the page. */
static void tell(const ethd__finding *f, const ethd__key_row *row, char *out, size_t room) {
  int u = unknown_of(row);
  const ethd__bracket *b = bracket_of(f, row);
  const char *unit = row->param.unit;
  bool rigid = !isfinite(f->plant.stiffness);
  if (u == ETHD__FORCE_LIMIT && f->fit.unseen[u])
    snprintf(out, room, "%s, not reached: %.5g N were commanded; kept as in %s, or more", unit, f->fit.force, f->base);
  else if (u >= ETHD__MOTOR_MASS && u <= ETHD__DAMPING && rigid && !f->fit.unseen[u])
    snprintf(out, room, "%s, rigid by the information criterion", unit);
  else if (u >= 0 && is_fitted(&f->fit, (ethd__unknown)u))
    snprintf(out, room, "%s, %.7g to %.7g (95 %%)", unit, f->fit.low[u], f->fit.high[u]);
  else if (b && !isnan(b->value))
    snprintf(out, room, "%s, %.7g to %.7g%s", unit, b->low, b->high,
             b == &f->sensing.latency ? " (by the ticks with which readings came)" : " (95 %)");
  else if (is_count(row))
    snprintf(out, room, "%s, %s", strchr(unit, '|') ? "" : unit,
             f->sensing.count > 0 ? "found from the angles" : "the angles have no common step");
  else
    snprintf(out, room, "%s, not determined, kept as in %s", strchr(unit, '|') ? "" : unit, f->base);
}

/* ---- the page ---- */

static void print_row(FILE *out, const ethd__finding *f, const ethd__key_row *row) {
  char what[192];
  const char *skip;
  tell(f, row, what, sizeof what);
  skip = what + strspn(what, ", ");
  fprintf(out, "  %-13s %-14s %12.6g  %s\n", row->section, row->param.name,
          strchr(row->param.unit, '|') ? (double)f->plant.count_phase
                                       : *(const double *)(const void *)((const char *)&f->plant + row->offset),
          skip);
}

static bool is_kept(const ethd__finding *f, const ethd__key_row *row) {
  int u = unknown_of(row);
  const ethd__bracket *b = bracket_of(f, row);
  return u < 0 && !is_count(row) && !(b && !isnan(b->value));
}

static void print_kept(FILE *out, const ethd__finding *f) {
  const char *section = "";
  fprintf(out, "\nnot determined, kept as in %s:", f->base);
  for (size_t i = 0; i < ethd__plant_row_count; i++) {
    const ethd__key_row *row = &ethd__plant_rows[i];
    if (!is_kept(f, row)) continue;
    fprintf(out, strcmp(section, row->section) ? "\n  %-13s %s" : ", %.0s%s", row->section, row->param.name);
    section = row->section;
  }
  fprintf(out, "\n");
}

static void print_residual(FILE *out, const ethd__finding *f) {
  const ethd__whiteness *w = &f->whiteness;
  double l = f->evidence->arm.link1;
  fprintf(out, "\nresidual      %.4g rad rms (%.3g um at the ring)", w->rms, 1e6 * l * w->rms);
  if (w->floor > 0) fprintf(out, ", %.3f times the residual of rounding to counts", w->rms / w->floor);
  fprintf(out,
          "\nwhiteness     %d of %d lags outside +-%.3g; the largest correlation is %.3f, %d tick%s apart; %zu ticks\n",
          w->outside, ETHD__LAGS, w->bound, w->correlation[w->largest], w->largest, w->largest > 1 ? "s" : "",
          w->ticks);
  if (!w->explained)
    fprintf(
        out,
        "NOT EXPLAINED by this model: the device has an effect that the model hasn't, such as backlash, a cable with\n "
        "             hysteresis, another friction law, or an unseen finger; the intervals are then too narrow\n");
}

static void print_arm(FILE *out, const ethd__finding *f) {
  const ethd__fit *fit = &f->fit;
  fprintf(out, "fitted to     %zu windows of %.3g s", f->problem.window_count, ETHD__WINDOW);
  if (f->problem.passed_over) fprintf(out, ", %zu of a long recording were passed over", f->problem.passed_over);
  fprintf(out, "\nmodel         %s: ", isfinite(f->plant.stiffness) ? "the transmission is elastic" : "rigid");
  if (isfinite(fit->criterion[1]))
    fprintf(out, "criterion %.1f rigid, %.1f with an elastic transmission (less is better)\n", fit->criterion[0],
            fit->criterion[1]);
  else
    fprintf(out, "the residual is as small as rounding to counts\n");
  if (fit->unseen[ETHD__STIFFNESS])
    fprintf(out,
            "              something is elastic, but not as a transmission whose numbers the recordings determine\n");
}

void ethd__page_print(FILE *out, const ethd__finding *f) {
  const ethd__evidence *e = f->evidence;
  fprintf(out, "recordings    %u, %zu ticks; left out: %zu without the commanded torque, %zu with the finger near\n",
          e->recording_count, e->count, e->unarmed, e->touched);
  print_arm(out, f);
  fprintf(out, "evaluations   %.0f simulated seconds\n\n", f->fit.simulated);
  for (size_t i = 0; i < ethd__plant_row_count; i++)
    if (!is_kept(f, &ethd__plant_rows[i])) print_row(out, f, &ethd__plant_rows[i]);
  print_kept(out, f);
  print_residual(out, f);
  if (f->plant.delay > ETHD_SIM_DELAY_PERIODS * e->period)
    fprintf(out, "The delay is longer than %d periods of %g s, which is the most that the simulator holds.\n",
            ETHD_SIM_DELAY_PERIODS, e->period);
}

/* ---- the file ---- */

static void write_row(FILE *out, const ethd__finding *f, const ethd__key_row *row) {
  const char *at = (const char *)&f->plant + row->offset;
  char what[192], number[40];
  int32_t word;
  double value;
  memcpy(&word, at, sizeof word);
  memcpy(&value, at, sizeof value);
  tell(f, row, what, sizeof what);
  const char *behind = what + strspn(what, ", ");
  if (strchr(row->param.unit, '|')) {
    const char *text = row->param.unit;
    for (int32_t i = 0; i < word; i++) text = strchr(text, '|') + 1;
    snprintf(number, sizeof number, "%.*s", (int)strcspn(text, "|"), text);
  } else {
    snprintf(number, sizeof number, !strcmp(row->param.name, "count") ? "%.15g" : PLANT_NUMBER, value);
  }
  fprintf(out, "%-16s = %-20s ; %s\n", row->param.name, number, behind);
}

ethd_status ethd__page_write(const ethd__finding *f, const char *path, char message[ETHD_MESSAGE_MAX]) {
  ethd_replace replace;
  const char *section = "";
  ethd_status status = ethd_replace_begin(path, &replace, message);
  if (status) return status;
  fprintf(replace.file,
          "# Identified by ethd-identify from %u recording%s, %zu windows of %.3g s. A comment\n# gives a number's "
          "unit and interval; numbers that the recordings don't determine are those of %s.\n",
          f->evidence->recording_count, ethd__s(f->evidence->recording_count), f->problem.window_count, ETHD__WINDOW,
          f->base);
  fprintf(replace.file, "# Residual %.4g rad rms; %s.\n", f->whiteness.rms,
          f->whiteness.explained ? "the model explains it" : "NOT EXPLAINED by this model");
  for (size_t i = 0; i < ethd__plant_row_count; i++) {
    const ethd__key_row *row = &ethd__plant_rows[i];
    if (strcmp(section, row->section)) fprintf(replace.file, "%s[%s]\n", i ? "\n" : "", row->section);
    section = row->section;
    write_row(replace.file, f, row);
  }
  return ethd_replace_commit(&replace, message);
}
