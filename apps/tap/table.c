#include "tap/table.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "cli/dropped.h"

/* ---- cells ---- */

struct column {
  const char *name, *unit;
  size_t field;
  double scale;
  int digits;
};
enum { COLUMNS = 6 };

static const struct column of_ring[COLUMNS] = {
    {"v_rvo", "m/s", ETHD_TAP_FIELD(v_rvo), 1, 3},    {"v_of", "m/s", ETHD_TAP_FIELD(v_of), 1, 3},
    {"d_max", "mm", ETHD_TAP_FIELD(d_max), 1e3, 2},   {"v_rmin", "m/s", ETHD_TAP_FIELD(v_rmin), 1, 3},
    {"Delta_s", "ms", ETHD_TAP_FIELD(delta_s), 1, 2}, {"eps", "mm", ETHD_TAP_FIELD(eps), 1e3, 3},
};
/* Defined for every law: from the touch on, and d_max. */
static const struct column of_finger[COLUMNS] = {
    {"v_hand", "m/s", ETHD_TAP_FIELD(v_hand), 1, 3},      {"v_of", "m/s", ETHD_TAP_FIELD(v_of), 1, 3},
    {"d_max", "mm", ETHD_TAP_FIELD(d_max), 1e3, 2},       {"v_rmin", "m/s", ETHD_TAP_FIELD(v_rmin), 1, 3},
    {"depth", "mm", ETHD_TAP_FIELD(touch_depth), 1e3, 3}, {"felt", "mm", ETHD_TAP_FIELD(eps_felt), 1e3, 3},
};

static void print_figure(FILE *file, const ethd__figure *figure, double scale, int digits) {
  char sd[24] = "";
  if (!figure->n) {
    fprintf(file, " %7s%-8s", "-", "");
    return;
  }
  if (figure->n > 1) snprintf(sd, sizeof sd, " (%.*f)", digits, scale * figure->sd);
  fprintf(file, " %7.*f%-8s", digits, scale * figure->mean, sd);
}

static void print_figures(FILE *file, const ethd__cell *cell, const struct column *columns) {
  for (int c = 0; c < COLUMNS; c++) {
    ethd__figure figure = ethd__cell_figure(cell, columns[c].field);
    print_figure(file, &figure, columns[c].scale, columns[c].digits);
  }
}

static void print_cells(FILE *file, const ethd__cell *cells, size_t count, bool by_finger) {
  const struct column *columns = by_finger ? of_finger : of_ring;
  int law = 3, speed = 5;
  for (size_t i = 0; i < count; i++) {
    law = (int)fmax(law, (double)strlen(cells[i].law));
    speed = (int)fmax(speed, (double)strlen(cells[i].speed->word));
  }
  fprintf(file, "%-*s %-*s %5s %7s", law, "law", speed, "speed", "taps", "valid");
  for (int c = 0; c < COLUMNS; c++) fprintf(file, " %7s %-7s", columns[c].name, columns[c].unit);
  fputc('\n', file);
  for (size_t i = 0; i < count; i++) {
    ethd__cell cell = cells[i];
    cell.by_finger = by_finger;
    double share = cell.count ? 100 * (double)ethd__cell_valid(&cell) / (double)cell.count : 0;
    fprintf(file, "%-*s %-*s %5zu %5.1f %%", law, cell.law, speed, cell.speed->word, cell.count, share);
    if (!by_finger && ethd__cell_stops(&cell))
      fputs("   stops before the wall: see below", file);
    else
      print_figures(file, &cell, columns);
    fputc('\n', file);
  }
}

/* By the paper's rule, which judges the ring as it meets the wall; if a law stops it before, all laws once more by the
   finger's. */
static void print_laws(FILE *file, const ethd__study *study, const ethd__cell *cells, size_t count) {
  bool stops = study->validity == ETHD_TAP_BY_FINGER;
  if (!stops) print_cells(file, cells, count, false);
  for (size_t i = 0; i < count && !stops; i++) stops = ethd__cell_stops(&cells[i]);
  if (!stops) return;
  fprintf(file,
          "%sValid by the hand's speed alone (--validity finger). depth: of the ring in the wall at the touch;\nfelt: "
          "offset of the wall 60 ms later, 0 if the law never moves it.\n\n",
          study->validity == ETHD_TAP_BY_FINGER ? "" : "\n");
  print_cells(file, cells, count, true);
}

static void print_reasons(FILE *file, const ethd__cell *cells, size_t count) {
  size_t by_reason[ETHD_TAP_REASON_COUNT] = {0};
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < cells[c].count; i++) by_reason[cells[c].results[i].metrics.reason]++;
  const char *between = "taps by reason: ";
  for (int r = 0; r < ETHD_TAP_REASON_COUNT; r++) {
    if (!by_reason[r]) continue;
    fprintf(file, "%s%s %zu", between, ethd__reason_words[r], by_reason[r]);
    between = ", ";
  }
  fputc('\n', file);
}

static void print_queries(FILE *file, const ethd_scene *scene, const ethd__cell *cells, size_t count) {
  uint64_t ticks = 0, queried = 0;
  for (size_t c = 0; c < count; c++) {
    for (size_t i = 0; i < cells[c].count; i++) {
      ticks += cells[c].results[i].ticks;
      queried += cells[c].results[i].queried;
    }
  }
  fprintf(file, "scene queried %" PRIu64 " of %" PRIu64 " ticks", queried, ticks);
  ethd__dropped_print(file, scene);
  fputc('\n', file);
}

/* ---- the paper ---- */

/* The means of Table 1. */
static const struct paper_mean {
  const char *name, *unit, *speed, *paper;
  size_t field;
  double scale;
} means[] = {
    {"Delta_s, low", "ms", "low", "3.111 (2.804)", ETHD_TAP_FIELD(delta_s), 1},
    {"eps, low", "mm", "low", "0.388 (0.251)", ETHD_TAP_FIELD(eps), 1e3},
    {"Delta_s, high", "ms", "high", "14.556 (1.424)", ETHD_TAP_FIELD(delta_s), 1},
    {"eps, high", "mm", "high", "2.434 (0.357)", ETHD_TAP_FIELD(eps), 1e3},
};

static const ethd__cell *find_cell(const ethd__cell *cells, size_t count, const char *law, const char *speed) {
  for (size_t i = 0; i < count; i++)
    if (!strcmp(cells[i].law, law) && !strcmp(cells[i].speed->word, speed)) return &cells[i];
  return NULL;
}

static void print_means(FILE *file, const ethd__cell *cells, size_t count) {
  fprintf(file, "\n%-20s %-16s %s\n", "Table 1 (offset)", "paper (9 taps)", "here, all taps");
  for (size_t i = 0; i < sizeof means / sizeof *means; i++) {
    const struct paper_mean *m = &means[i];
    const ethd__cell *cell = find_cell(cells, count, "offset", m->speed);
    ethd__figure here = cell ? ethd__cell_figure(cell, m->field) : (ethd__figure){0, NAN, NAN};
    char text[32] = "-";
    if (here.n > 1) snprintf(text, sizeof text, "%.3f (%.3f)", m->scale * here.mean, m->scale * here.sd);
    if (here.n == 1) snprintf(text, sizeof text, "%.3f", m->scale * here.mean);
    fprintf(file, "%-15s %-4s %-16s %s\n", m->name, m->unit, m->paper, text);
  }
  fputs("The paper's comparisons of smooth and offset are within people: ethd-report tests them on a study's taps.\n",
        file);
}

/* Figures of the paper that the table above lacks, without a verdict. */
static void print_beside(FILE *file, const ethd__cell *cells, size_t count) {
  const ethd__cell *low = find_cell(cells, count, "offset", "low");
  const ethd__cell *smooth = find_cell(cells, count, "smooth", "high");
  const ethd__cell *offset = find_cell(cells, count, "offset", "high");
  const size_t field = ETHD_TAP_FIELD(d_max);
  if (low && ethd__cell_valid(low) > 1) {
    ethd__figure figure = ethd__cell_figure(low, ETHD_TAP_FIELD(delta_s));
    fprintf(file, "sd of the low Delta_s: paper 2.80 ms, here %.2f; %.1f %% of its taps brake for less than 3 ms.\n",
            figure.sd, 100 * ethd__cell_share(low, ETHD_TAP_FIELD(delta_s), 0, 2.5));
  }
  if (!smooth || !offset || !ethd__cell_valid(smooth) || !ethd__cell_valid(offset)) return;
  ethd__figure s = ethd__cell_figure(smooth, field), o = ethd__cell_figure(offset, field);
  fprintf(file, "High d_max, smooth to offset: %.1f to 1 by means, %.1f to 1 by medians of all taps.\n",
          s.mean / o.mean, ethd__cell_median(smooth, field) / ethd__cell_median(offset, field));
}

static void print_truth(FILE *file, const ethd__study *study, const ethd__cell *cells, size_t count) {
  fputs("\nFitted to Table 1, not measured: the plant, that is the device's mass, friction, torque limit, delay,\n"
        "encoder, and the finger, hand and sensor. The laws and gains are the paper's.\n",
        file);
  if (!isinf(study->plant.stiffness))
    fputs("The compliant transmission is a hypothesis: sufficient for Table 1, not proven. Speeds are measured on "
          "the\nencoder's side, as in a lab.\n",
          file);
  print_beside(file, cells, count);
}

/* ---- all ---- */

static void print_heading(FILE *file, const ethd__study *study, const ethd__heading *heading) {
  fprintf(file, "Tapping study, simulated, not realtime. Plant %s, configuration %s, seed %" PRIu64 ".\n",
          heading->plant, heading->config, study->seed);
  if (!heading->movement) {
    fputs("Synthetic hand.", file);
  } else {
    fprintf(file, "Hand: %s, ", heading->movement);
    if (heading->scaled)
      fprintf(file, "SCALED by %g.", heading->scale);
    else
      fputs("not scaled.", file);
  }
  fputs(" Means (standard deviations) over the valid taps.\n\n", file);
}

/* The first fault under each transition law, and the law that caused it, if any. */
static void print_faults(FILE *file, const ethd__study *study, const ethd__cell *cells, size_t count) {
  char text[ETHD_MESSAGE_MAX];
  for (size_t law = 0; law < count; law += study->speed_count) {
    const ethd__result *first = NULL;
    for (size_t c = law; c < law + study->speed_count; c++)
      for (size_t i = 0; i < cells[c].count && !first; i++)
        if (cells[c].results[i].metrics.fault) first = &cells[c].results[i];
    if (!first) continue;
    ethd_fault fault = first->metrics.fault;
    bool is_laws = first->law_fault.law && (fault == ETHD_FAULT_LAW || fault == ETHD_FAULT_FINITE);
    fprintf(file, "%s: the first fault: %s\n", cells[law].law,
            is_laws ? ethd__law_fault_text(&first->law_fault, text) : ethd_fault_sentence(fault));
  }
}

void ethd__table_print(FILE *file, const ethd__study *study, const ethd__heading *heading, const ethd__cell *cells,
                       size_t count) {
  print_heading(file, study, heading);
  print_laws(file, study, cells, count);
  fputc('\n', file);
  print_reasons(file, cells, count);
  print_faults(file, study, cells, count);
  print_queries(file, study->config->scene, cells, count);
  if (heading->movement) return;
  print_means(file, cells, count);
  print_truth(file, study, cells, count);
}
