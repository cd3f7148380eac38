#include "tap/reach_table.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/file_name.h"
#include "text/text.h"

static size_t cell_count(const ethd__reach_plan *plan) { return plan->law_count * plan->speed_count; }

ethd__reach_cell *ethd__reach_cells_create(const ethd__reach_plan *plan) {
  const size_t count = cell_count(plan);
  ethd__reach_cell *cells = calloc(count, sizeof *cells);
  ethd__reach *taps = calloc(count * plan->taps, sizeof *taps);
  if (!cells || !taps) {
    free(cells);
    free(taps);
    return NULL;
  }
  for (size_t i = 0; i < count; i++)
    cells[i] = (ethd__reach_cell){.law = plan->laws[i / plan->speed_count],
                                  .speed = &plan->speeds[i % plan->speed_count],
                                  .taps = taps + i * plan->taps};
  return cells;
}

void ethd__reach_cells_free(ethd__reach_cell *cells) {
  if (cells) free(cells->taps);
  free(cells);
}

static ethd_status run_cell(const ethd__reach_plan *plan, ethd__reach_cell *cell, char *message) {
  static ethd__reach_rig rig; /* large */
  cell->count = 0;
  ethd_status status = ethd__reach_open(&plan->reaches, cell->law, &rig, message);
  for (size_t k = 0; !status && k < plan->taps && !ethd__stop; k++) {
    status = ethd__reach_run(&rig, cell->speed->commanded, k, &cell->taps[k], NULL);
    cell->count = k + 1;
  }
  ethd__reach_close(&rig);
  return status;
}

ethd_status ethd__reach_cells_run(const ethd__reach_plan *plan, ethd__reach_cell *cells,
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < cell_count(plan) && !ethd__stop; i++) {
    ethd__progress(i, cell_count(plan), cells[i].law);
    status = run_cell(plan, &cells[i], message);
  }
  ethd__progress(1, 1, "");
  return status;
}

/* ---- figures ---- */

ethd__reach_figures ethd__reach_figures_of(const ethd__reach_cell *cell) {
  ethd__reach_figures f = {.felt_sd = NAN, .deepest = 0};
  double felt = 0, speed = 0, squares = 0;
  for (size_t i = 0; i < cell->count; i++) {
    const ethd__reach *tap = &cell->taps[i];
    f.early += tap->reason == ETHD_TAP_EARLY_CONTACT;
    if (tap->reason != ETHD_TAP_OK) continue;
    f.valid++;
    felt += tap->felt;
    speed += fabs(tap->speed);
    if (fabs(tap->felt) >= fabs(f.deepest)) f.deepest = tap->felt;
    f.fastest = fmax(f.fastest, fabs(tap->speed));
  }
  f.early_share = (double)f.early / (double)(f.early + f.valid);
  f.felt = felt / (double)f.valid;
  f.speed = speed / (double)f.valid;
  if (!f.valid) f.deepest = f.fastest = NAN;
  for (size_t i = 0; i < cell->count; i++)
    if (cell->taps[i].reason == ETHD_TAP_OK) squares += (cell->taps[i].felt - f.felt) * (cell->taps[i].felt - f.felt);
  if (f.valid > 1) f.felt_sd = sqrt(squares / (double)(f.valid - 1));
  return f;
}

static void print_heading(FILE *file, const ethd__reach_plan *plan) {
  const ethd__reaches *r = &plan->reaches;
  fprintf(file,
          "Taps on a simulated arm, not realtime: commands at %.6g Hz, delay %.4g ms, gap %.4g mm, %.3g m/s2 along the "
          "wall's normal.\nWall %.4f %.4f %.4f from %.4f m on. Headset at %.4g Hz, 30 ms late, noise 1 mm, bias %.4g "
          "mm. ",
          r->table.servo.rate, 1e3 * r->table.servo.delay, 1e3 * r->gap, r->acceleration, r->n.x, r->n.y, r->n.z,
          r->wall, r->rate, 1e3 * r->bias);
  if (r->recorded_count)
    fprintf(file, "%zu recorded movement%s", r->recorded_count, ethd__s(r->recorded_count));
  else
    fputs("Drawn reaches", file);
  fprintf(file, ", seed %" PRIu64 ".\nMeans (standard deviations) over the valid taps; worst: the largest.\n\n",
          r->seed);
}

static void print_number(FILE *file, int width, int digits, double value) {
  if (isnan(value))
    fprintf(file, " %*s", width, "-");
  else
    fprintf(file, " %*.*f", width, digits, value);
}

static void print_cell(FILE *file, const ethd__reach_cell *cell, int law) {
  const ethd__reach_figures f = ethd__reach_figures_of(cell);
  char sd[24] = "";
  fprintf(file, "%-*s %5s %6zu %6zu", law, cell->law, cell->speed->word, cell->count, f.valid);
  print_number(file, 6, 1, 100 * f.early_share);
  print_number(file, 9, 3, 1e3 * f.felt);
  if (f.valid > 1) snprintf(sd, sizeof sd, "(%.3f)", 1e3 * f.felt_sd);
  fprintf(file, " %-9s", sd);
  print_number(file, 8, 3, 1e3 * f.deepest);
  print_number(file, 9, 4, f.speed);
  print_number(file, 8, 4, f.fastest);
  fputc('\n', file);
}

/* The reasons of invalid taps, except early ones. */
static void print_reasons(FILE *file, const ethd__reach_cell *cell) {
  size_t count[ETHD_TAP_REASON_COUNT] = {0};
  ethd_fault fault = ETHD_FAULT_NONE;
  for (size_t i = 0; i < cell->count; i++) {
    count[cell->taps[i].reason]++;
    if (!fault) fault = cell->taps[i].fault;
  }
  for (int i = 0; i < ETHD_TAP_REASON_COUNT; i++)
    if (count[i] && i != ETHD_TAP_OK && i != ETHD_TAP_EARLY_CONTACT)
      fprintf(file, "%s %s: %zu %s%s%s\n", cell->law, cell->speed->word, count[i], ethd__reason_words[i],
              i == ETHD_TAP_FAULT ? ", the first: " : "", i == ETHD_TAP_FAULT ? ethd_fault_sentence(fault) : "");
}

void ethd__reach_print(FILE *file, const ethd__reach_plan *plan, const ethd__reach_cell *cells) {
  int law = 3;
  for (size_t i = 0; i < plan->law_count; i++) law = (int)fmax(law, (double)strlen(plan->laws[i]));
  print_heading(file, plan);
  fprintf(file, "%*s %5s %6s %6s %6s %9s %-9s %8s %9s %8s\n", law, "", "", "", "", "early", "felt", "offset", "worst",
          "at touch", "worst");
  fprintf(file, "%-*s %5s %6s %6s %6s %9s %-9s %8s %9s %8s\n", law, "law", "speed", "taps", "valid", "%", "mm", "",
          "mm", "m/s", "m/s");
  for (size_t i = 0; i < cell_count(plan); i++) print_cell(file, &cells[i], law);
  fputc('\n', file);
  for (size_t i = 0; i < cell_count(plan); i++) print_reasons(file, &cells[i]);
}

/* ---- files ---- */

ethd_status ethd__reach_write(const ethd__reach_plan *plan, const ethd__reach_cell *cells, const char *path,
                              char message[ETHD_MESSAGE_MAX]) {
  char seed[24];
  snprintf(seed, sizeof seed, "%" PRIu64, plan->reaches.seed);
  ethd_csv_out *csv = ethd_csv_create(path, ETHD_REACH_HEADER, message);
  if (!csv) return ETHD_E_FILE;
  for (size_t i = 0; i < cell_count(plan); i++)
    for (size_t k = 0; k < cells[i].count; k++) {
      const ethd__reach *tap = &cells[i].taps[k];
      ethd_csv_integer(csv, (int64_t)k);
      ethd_csv_word(csv, cells[i].law);
      ethd_csv_word(csv, cells[i].speed->word);
      ethd_csv_word(csv, seed);
      ethd_csv_integer(csv, tap->reason == ETHD_TAP_OK);
      ethd_csv_word(csv, ethd__reason_words[tap->reason]);
      ethd_csv_number(csv, tap->felt);
      ethd_csv_number(csv, tap->speed);
      ethd_csv_row(csv);
    }
  return ethd_csv_close(csv, message);
}

static size_t typical(const ethd__reach_cell *cell) {
  const double mean = ethd__reach_figures_of(cell).felt;
  size_t best = 0;
  double least = INFINITY;
  for (size_t k = 0; k < cell->count; k++) {
    const double d = fabs(cell->taps[k].felt - mean);
    if (cell->taps[k].reason == ETHD_TAP_OK && d < least) least = d, best = k;
  }
  return best;
}

static ethd_status write_rows(const ethd__reach_rows *rows, bool touched, const char *path, char *message) {
  ethd_csv_out *csv = ethd_csv_create(path, ETHD_REACH_TRACE, message);
  if (!csv) return ETHD_E_FILE;
  for (size_t i = 0; i < rows->count; i++) {
    const ethd__reach_row *r = &rows->row[i];
    const double figures[] = {r->t,           touched ? r->t - rows->row[rows->touch].t : NAN,
                              r->plate,       r->commanded,
                              r->finger,      r->v_plate,
                              r->v_commanded, r->v_finger};
    for (size_t c = 0; c < sizeof figures / sizeof *figures; c++) ethd_csv_number(csv, figures[c]);
    ethd_csv_integer(csv, r->state);
    ethd_csv_row(csv);
  }
  return ethd_csv_close(csv, message);
}

static ethd_status trace_cell(const ethd__reach_plan *plan, const ethd__reach_cell *cell, const char *folder,
                              char *message) {
  static ethd__reach_rig rig;
  ethd__reach_rows rows = {0};
  ethd__reach tap;
  char name[ETHD_FILE_NAME_MAX];
  const char *words[] = {cell->law, cell->speed->word, NULL};
  ethd__file_name(words, ".csv", name);
  char *path = ethd__path_join(folder, name);
  ethd_status status = path ? ethd__reach_open(&plan->reaches, cell->law, &rig, message) : ETHD_E_MEMORY;
  if (!status) status = ethd__reach_run(&rig, cell->speed->commanded, typical(cell), &tap, &rows);
  if (status == ETHD_E_MEMORY) status = ethd__no_memory(message, folder);
  if (!status) status = write_rows(&rows, !isnan(tap.felt), path, message);
  ethd__reach_close(&rig);
  free(rows.row);
  free(path);
  return status;
}

ethd_status ethd__reach_trace(const ethd__reach_plan *plan, const ethd__reach_cell *cells, const char *folder,
                              char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < cell_count(plan); i++)
    if (cells[i].count) status = trace_cell(plan, &cells[i], folder, message);
  return status;
}

/* ---- sensitivity ---- */

enum { VARIED = 3, POINTS = 10 };
static const struct varied {
  const char *name;
  double value[POINTS]; /* s, m, m; NaN ends them */
} varied[VARIED] = {
    {"delay_s", {0.004, 0.008, 0.012, 0.016, 0.020, 0.025, 0.030, NAN}},
    {"gap_m", {0.015, 0.020, 0.030, 0.040, 0.050, 0.060, 0.080, 0.100, 0.120, NAN}},
    {"bias_m", {-0.013, -0.010, -0.006, -0.003, 0, 0.003, 0.006, 0.010, 0.013, NAN}},
};

static void write_point(ethd_csv_out *csv, const ethd__reach_cell *cell, const char *name, double value) {
  const ethd__reach_figures f = ethd__reach_figures_of(cell);
  ethd_csv_word(csv, cell->law);
  ethd_csv_word(csv, cell->speed->word);
  ethd_csv_word(csv, name);
  ethd_csv_number(csv, value);
  ethd_csv_integer(csv, (int64_t)cell->count);
  ethd_csv_integer(csv, (int64_t)f.valid);
  const double figures[] = {f.early_share, f.felt, f.felt_sd, f.deepest, f.speed, f.fastest};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
}

static ethd_status sweep_point(const ethd__reach_plan *plan, size_t v, double value, const char *name,
                               ethd__reach_cell *cell, char *message) {
  ethd__reach_plan here = *plan;
  double *const at[] = {&here.reaches.table.servo.delay, &here.reaches.gap, &here.reaches.bias};
  *at[v] = value;
  const ethd_status status = ethd__reaches_prepare(&here.reaches, name, message);
  return status ? status : run_cell(&here, cell, message);
}

static ethd_status sweep_law(const ethd__reach_plan *plan, size_t law, const char *name, ethd__reach_cell *cell,
                             ethd_csv_out *csv, char *message) {
  ethd_status status = ETHD_OK;
  cell->law = plan->laws[law];
  for (size_t v = 0; v < VARIED; v++)
    for (size_t i = 0; !status && !isnan(varied[v].value[i]) && !ethd__stop; i++) {
      ethd__progress((law * VARIED + v) * POINTS + i, plan->law_count * VARIED * POINTS, cell->law);
      status = sweep_point(plan, v, varied[v].value[i], name, cell, message);
      if (!status) write_point(csv, cell, varied[v].name, varied[v].value[i]);
    }
  return status;
}

ethd_status ethd__reach_sweep(const ethd__reach_plan *plan, const char *name, const char *path,
                              char message[ETHD_MESSAGE_MAX]) {
  ethd__reach_plan one = *plan;
  one.law_count = one.speed_count = 1;
  ethd__reach_cell *cell = ethd__reach_cells_create(&one);
  if (!cell) return ethd__no_memory(message, path);
  ethd_csv_out *csv = ethd_csv_create(path, ETHD_REACH_SWEEP, message);
  ethd_status status = csv ? ETHD_OK : ETHD_E_FILE;
  for (size_t i = 0; !status && i < plan->law_count; i++) status = sweep_law(plan, i, name, cell, csv, message);
  ethd__progress(1, 1, "");
  ethd__reach_cells_free(cell);
  if (!status) return ethd_csv_close(csv, message);
  ethd_csv_abandon(csv);
  return status;
}
