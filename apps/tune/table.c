#include "tune/table.h"

#include <math.h>
#include <string.h>

#include "check/report.h"
#include "cli/cli.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

#define SHOWN 8 /* points of the front that are printed */

/* ---- the front ---- */

static void print_head(FILE *out, const ethd__tune_space *space) {
  fprintf(out, "  %-10s", "");
  for (size_t k = 0; k < space->count; k++) {
    const char *dot = strchr(space->keys[k].name, '.');
    fprintf(out, " %8.8s", dot + 1);
  }
  fprintf(out, " | early %%  lag mm  eps mm  delta ms d_max mm  v mm/s  mNm a tick\n");
}

static void print_entry(FILE *out, const char *what, const ethd__tune_space *space, const ethd__tune_entry *e) {
  const ethd__tune_score *s = &e->score;
  char text[ETHD_TUNE_VALUE_MAX];
  fprintf(out, "  %-10s", what);
  for (size_t k = 0; k < space->count; k++) fprintf(out, " %8s", ethd__space_text(e->point.value[k], text));
  fprintf(out, " | %7.1f %7.3f %7.3f %9.2f %8.3f %7.1f %11.1f\n", 100 * s->early[1], 1e3 * s->lag[1], 1e3 * s->eps[1],
          s->delta_s[1], 1e3 * s->d_max[1], 1e3 * s->v_touch[1], 1e3 * s->rough[1]);
}

void ethd__tune_print(FILE *out, const ethd__tune_search *s, const ethd__tune_entry *choice) {
  const ethd__tune_space *space = s->rig->space;
  const ethd__tune_round *last = &s->rounds[ETHD_TUNE_ROUNDS - 1];
  size_t front = 0, shown = 0;
  for (size_t i = 0; i < last->count; i++) front += last->entries[i].front;
  fprintf(out, "\nfront        %zu of %zu point%s, %u tap%s at each speed; figures at high speed\n", front, last->count,
          ethd__s(last->count), last->taps, ethd__s(last->taps));
  print_head(out, space);
  print_entry(out, last->entries[0].keeps ? "own" : "own, thin", space, &last->entries[0]);
  for (size_t i = 1; i < last->count && shown < SHOWN; i++)
    if (last->entries[i].front && &last->entries[i] != choice) {
      print_entry(out, "front", space, &last->entries[i]);
      shown++;
    }
  if (choice) print_entry(out, "chosen", space, choice);
  if (!last->entries[0].keeps) fprintf(out, "own, thin: the configuration's own gains don't keep the margins\n");
}

/* ---- margins ---- */

int ethd__tune_print_margins(const ethd__tune_rig *rig, const ethd__tune_point *point) {
  char unsaid[ETHD_MESSAGE_MAX];
  const ethd__bounds_device device = ethd__bounds_device_of(&rig->study->plant, 0);
  ethd_setup setup;
  return ethd__space_setup(rig->space, point, &setup, unsaid) ? 0 : ethd__report_stability(&setup, &device);
}

/* ---- effect of each gain ---- */

ethd_status ethd__tune_weigh(const ethd__tune_search *s, const ethd__tune_entry *choice, ethd__tune_worths *out,
                             char message[ETHD_MESSAGE_MAX]) {
  const ethd__tune_space *space = s->rig->space;
  const uint32_t taps = s->rounds[ETHD_TUNE_ROUNDS - 1].taps;
  for (size_t k = 0; k < space->count; k++) {
    ethd__tune_point back = choice->point;
    ethd__tune_score score;
    back.value[k] = space->keys[k].own;
    ethd_status status = ethd__score_run(s->rig, &back, taps, &score, message);
    if (status) return status;
    ethd__score_goals(&score, &choice->score, out->times[k]);
    for (int g = 0; g < ETHD_TUNE_GOALS; g++) out->times[k][g] = exp(out->times[k][g]);
  }
  return ETHD_OK;
}

void ethd__tune_print_worths(FILE *out, const ethd__tune_space *space, const ethd__tune_point *choice,
                             const ethd__tune_worths *worths) {
  fprintf(out, "Effect of each gain: the figures with this gain alone at its old value, as multiples of the choice's. "
               "Over 1\nthe new value is better, under 1 it is worse.\n");
  fprintf(out, "  %-28s %10s %10s  %9s %9s %9s %9s\n", "gain", "own", "chosen", ethd__tune_goal_names[0],
          ethd__tune_goal_names[1], ethd__tune_goal_names[2], ethd__tune_goal_names[3]);
  for (size_t k = 0; k < space->count; k++) {
    char own[ETHD_TUNE_VALUE_MAX], chosen[ETHD_TUNE_VALUE_MAX];
    fprintf(out, "  %-28s %10s %10s ", space->keys[k].name, ethd__space_text(space->keys[k].own, own),
            ethd__space_text(choice->value[k], chosen));
    for (int g = 0; g < ETHD_TUNE_GOALS; g++) fprintf(out, " %9.2f", worths->times[k][g]);
    fputs("\n", out);
  }
}

/* ---- the table ---- */

static char *header_of(const ethd__tune_space *space) {
  ethd__printed text;
  FILE *f = ethd__print_begin(&text);
  fputs("round,point,keeps,front,chosen", f);
  for (size_t k = 0; k < space->count; k++) fprintf(f, ",%s", space->keys[k].name);
  for (size_t i = 0; i < ETHD_TUNE_FIGURE_COUNT; i++) fprintf(f, ",%s", ethd__tune_figure_names[i]);
  for (int g = 0; g < ETHD_TUNE_GOALS; g++) fprintf(f, ",goal_%s", ethd__tune_goal_names[g]);
  fputs(",settled", f);
  return ethd__print_end(&text);
}

static void put_entry(ethd_csv_out *csv, const ethd__tune_space *space, const ethd__tune_entry *e, bool chosen) {
  double numbers[ETHD_TUNE_FIGURE_COUNT];
  memcpy(numbers, &e->score, sizeof numbers);
  ethd_csv_integer(csv, e->keeps);
  ethd_csv_integer(csv, e->front);
  ethd_csv_integer(csv, chosen);
  for (size_t k = 0; k < space->count; k++) ethd_csv_number(csv, e->point.value[k]);
  for (size_t i = 0; i < ETHD_TUNE_FIGURE_COUNT; i++) ethd_csv_number(csv, numbers[i]);
  for (int g = 0; g < ETHD_TUNE_GOALS; g++) ethd_csv_number(csv, isfinite(e->goals[g]) ? e->goals[g] : (double)NAN);
  ethd_csv_number(csv, e->settled < 0 ? (double)NAN : e->settled);
  ethd_csv_row(csv);
}

ethd_status ethd__tune_csv(const ethd__tune_search *s, const ethd__tune_entry *choice, const char *path,
                           char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *header = header_of(s->rig->space);
  ethd_csv_out *csv = ethd_csv_create(path, header, message);
  if (!csv) return ETHD_E_FILE;
  for (int round = 0; round < ETHD_TUNE_ROUNDS; round++)
    for (size_t i = 0; i < s->rounds[round].count; i++) {
      const ethd__tune_entry *e = &s->rounds[round].entries[i];
      ethd_csv_integer(csv, round + 1);
      ethd_csv_integer(csv, (int64_t)i);
      put_entry(csv, s->rig->space, e, e == choice);
    }
  return ethd_csv_close(csv, message);
}
