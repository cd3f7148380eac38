#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file/error_text.h"
#include "report/html.h"
#include "report/report.h"
#include "tap/ticks.h"

/* What a tap is drawn by: the wall of the folder's scene. */
static ethd_status view_of(const ethd__report *r, const ethd__group *group, const ethd__result *result, ethd__view *out) {
  ethd__study study = {.config = r->folder->loaded.config, .plant = r->folder->loaded.plant};
  ethd_status status = ethd__study_prepare(&study, r->message);
  if (status) return status;
  const ethd__stage stage = {.study = &study, .setup = study.config->setup};
  *out = ethd__stage_view(&stage, &group->speed, result->finger_radius);
  return ETHD_OK;
}

/* taps/P01-03-004 of a row. */
static char *recording_of(const ethd__report *r, const ethd__group *group, size_t index) {
  const ethd__sheet *sheet = &r->data.sheet;
  size_t row = group->who[index].row;
  char *path = NULL, *folder = ethd__folder_path(r->folder->path, ETHD_STUDY_RECORDINGS);
  if (asprintf(&path, "%s/%s-%02d-%03d", folder, ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "participant")),
               atoi(ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "block"))),
               atoi(ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "attempt")))) < 0)
    path = NULL;
  free(folder);
  return path;
}

static const char *base_name(const char *path) { return strrchr(path, '/') ? strrchr(path, '/') + 1 : path; }

/* The typical tap, or the chosen one if it is of this group; no such index: none. */
static size_t chosen(const ethd__report *r, const ethd__group *group) {
  if (!r->tap) return ethd__cell_valid(&group->cell) ? ethd__cell_typical(&group->cell) : group->cell.count;
  for (size_t i = 0; i < group->cell.count; i++) {
    char *path = recording_of(r, group, i);
    bool same = path && !strcmp(base_name(path), r->tap);
    free(path);
    if (same) return i;
  }
  return group->cell.count;
}

static ethd_status write_trace(ethd__report *r, const ethd__group *group, size_t index, const char *recording, const char *csv) {
  ethd__rows rows;
  ethd__view view;
  ethd_status status = view_of(r, group, &group->cell.results[index], &view);
  if (!status) status = ethd__ticks_read(recording, &rows, r->message);
  if (status) return status;
  status = ethd__trace_write(csv, &view, &rows, r->message);
  ethd__rows_free(&rows);
  return status;
}

static ethd_status draw(ethd__report *r, const ethd__group *group, const char *recording) {
  char caption[256], name[96];
  snprintf(name, sizeof name, "trace-%s-%s.png", group->cell.law, group->speed.word);
  snprintf(caption, sizeof caption, "As figures 9 to 12 of the paper: %s, %s, tap %s%s.", group->cell.law, group->speed.word,
           base_name(recording), r->tap ? "" : ", the valid one nearest to the cell's means");
  return ethd__report_picture(r, "tap.gp", name, caption, "in='trace-%s-%s.csv'; title='%s, %s speed'; plant='%.60s'",
                              group->cell.law, group->speed.word, group->cell.law, group->speed.word,
                              r->folder->protocol.plant ? r->folder->protocol.plant : "n");
}

/* names, titles: what the picture of the states shows. */
static ethd_status trace_group(ethd__report *r, const ethd__group *group, FILE *names, FILE *titles, size_t *count) {
  char name[96];
  size_t index = chosen(r, group);
  char *recording = index < group->cell.count ? recording_of(r, group, index) : NULL;
  if (!recording || access(recording, F_OK) != 0) {
    free(recording);
    return ETHD_OK;
  }
  snprintf(name, sizeof name, "trace-%s-%s.csv", group->cell.law, group->speed.word);
  char *csv = ethd__report_path(r, name);
  ethd_status status = write_trace(r, group, index, recording, csv);
  if (!status) status = draw(r, group, recording);
  fprintf(names, "%strace-%s-%s.csv", *count ? " " : "", group->cell.law, group->speed.word);
  fprintf(titles, "%s%s-%s", *count ? " " : "", group->cell.law, group->speed.word);
  ++*count;
  free(csv);
  free(recording);
  return status;
}

static ethd_status draw_states(ethd__report *r, const char *names, const char *titles) {
  return ethd__report_picture(r, "report-states.gp", "states.png",
                              "As figure 6 of the paper: the active state, and the weight of the tracking torque, which stays "
                              "continuous while the wall moves. Where a strategy has no states, vo stands for the ring in the wall.",
                              "in='%s'; titles='%s'; note='the taps above'", names, titles);
}

ethd_status ethd__report_traces(ethd__report *r) {
  char *names = NULL, *titles = NULL;
  size_t length, count = 0;
  ethd_status status = ETHD_OK;
  FILE *name = open_memstream(&names, &length), *title = open_memstream(&titles, &length);
  ethd__html_heading(r->page, "traces", "Traces of single taps");
  for (size_t i = 0; name && title && !status && i < r->data.group_count; i++)
    status = trace_group(r, &r->data.group[i], name, title, &count);
  if (name) fclose(name);
  if (title) fclose(title);
  if (!status && !count && r->tap) status = ethd__say(r->message, ETHD_E_RANGE, "--tap: no test tap %s is recorded here", r->tap);
  if (!status && count) status = draw_states(r, names, titles);
  if (!status && !count) fputs("<p>No ticks were recorded: there is nothing to draw.</p>\n", r->page);
  free(names);
  free(titles);
  return status;
}
