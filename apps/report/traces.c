#include <stdlib.h>
#include <string.h>

#include "report/recordings.h"
#include "report/report.h"
#include "tap/ticks.h"
#include "text/error_text.h"

/* The position of the wall, from the folder's scene, at which taps are drawn. */
static ethd_status view_of(const ethd__report *r, const ethd__group *group, const ethd__result *result,
                           ethd__view *out) {
  ethd__study study = {.config = r->folder->loaded.config, .plant = r->folder->loaded.plant};
  ethd_status status = ethd__study_prepare(&study, r->message);
  if (status) return status;
  const ethd__stage stage = {.study = &study, .setup = study.config->setup};
  *out = ethd__stage_view(&stage, &group->speed, result->finger_radius);
  return ETHD_OK;
}

/* The index of the tap to draw; an index that isn't there means none. */
typedef struct choice {
  size_t index;
  char name[ETHD_FILE_NAME_MAX], *recording;
} choice;

/* The typical one of those whose ticks are there. */
static size_t typical(const ethd__report *r, const ethd__group *group, const ethd__recordings *recordings) {
  char name[ETHD_FILE_NAME_MAX];
  ethd__cell there = group->cell;
  there.results = malloc((there.count + 1) * sizeof *there.results);
  if (!there.results) return group->cell.count;
  memcpy(there.results, group->cell.results, there.count * sizeof *there.results);
  for (size_t i = 0; i < there.count; i++) {
    ethd__recording_name(&r->data.sheet, group->who[i].row, name);
    char *path = there.results[i].metrics.reason == ETHD_TAP_OK ? ethd__recording_path(recordings, name) : NULL;
    if (!path) there.results[i].metrics.reason = ETHD_TAP_REASON_COUNT;
    free(path);
  }
  size_t index = ethd__cell_valid(&there) ? ethd__cell_typical(&there) : there.count;
  free(there.results);
  return index;
}

/* The one that was asked for, if it is of this group. */
static size_t asked_for(const ethd__report *r, const ethd__group *group) {
  char name[ETHD_FILE_NAME_MAX];
  size_t i = 0;
  for (; i < group->cell.count; i++) {
    ethd__recording_name(&r->data.sheet, group->who[i].row, name);
    if (!strcmp(name, r->tap)) break;
  }
  return i;
}

/* False: no ticks to draw. */
static bool choose(const ethd__report *r, const ethd__group *group, const ethd__recordings *recordings, choice *out) {
  out->index = r->tap ? asked_for(r, group) : typical(r, group, recordings);
  if (out->index >= group->cell.count) return false;
  ethd__recording_name(&r->data.sheet, group->who[out->index].row, out->name);
  out->recording = ethd__recording_path(recordings, out->name);
  return out->recording != NULL;
}

static void trace_name(const ethd__group *group, const char *suffix, char out[ETHD_FILE_NAME_MAX]) {
  const char *parts[] = {"trace", group->cell.law, group->speed.word, NULL};
  ethd__file_name(parts, suffix, out);
}

static ethd_status write_trace(ethd__report *r, const ethd__group *group, size_t index, const char *recording,
                               const char *csv) {
  ethd__rows rows;
  ethd__view view;
  ethd_status status = view_of(r, group, &group->cell.results[index], &view);
  if (!status) status = ethd__ticks_read(recording, &rows, r->message);
  if (status) return status;
  status = ethd__trace_write(csv, &view, &rows, r->message);
  ethd__rows_free(&rows);
  return status;
}

static ethd_status draw(ethd__report *r, const ethd__group *group, const char *csv, const char *tap) {
  char caption[256], name[ETHD_FILE_NAME_MAX], title[96];
  const char *plant = r->folder->protocol.plant ? r->folder->protocol.plant : "n";
  trace_name(group, ".png", name);
  snprintf(title, sizeof title, "%s, %s speed", group->cell.law, group->speed.word);
  snprintf(caption, sizeof caption, "As figures 9 to 12 of the paper: %s, %s, tap %s%s.", group->cell.law,
           group->speed.word, tap,
           r->tap ? "" : ", of the valid ones that are recorded the one nearest to their means");
  const ethd__picture_value values[] = {{"in", csv, true},
                                        {"title", title, false},
                                        {"plant", ethd__report_measured(r) ? "" : plant, false},
                                        {NULL, NULL, false}};
  return ethd__report_picture(r, "tap.gp", name, caption, values);
}

/* What the picture of the states shows. */
typedef struct states {
  FILE *names, *titles;
  size_t count;
} states;

static ethd_status trace_group(ethd__report *r, const ethd__group *group, const ethd__recordings *recordings,
                               states *out) {
  char name[ETHD_FILE_NAME_MAX];
  choice tap;
  if (!choose(r, group, recordings, &tap)) return ETHD_OK;
  trace_name(group, ".csv", name);
  char *csv = ethd__report_path(r, name);
  ethd_status status = write_trace(r, group, tap.index, tap.recording, csv);
  if (!status) status = draw(r, group, name, tap.name);
  fprintf(out->names, "%s%s", out->count ? " " : "", name);
  fprintf(out->titles, "%s%s-%s", out->count ? " " : "", group->cell.law, group->speed.word);
  out->count++;
  free(csv);
  free(tap.recording);
  return status;
}

static ethd_status draw_states(ethd__report *r, const char *names, const char *titles) {
  const ethd__picture_value values[] = {
      {"in", names, false}, {"titles", titles, false}, {"note", "the taps above", false}, {NULL, NULL, false}};
  return ethd__report_picture(
      r, "report-states.gp", "states.png",
      "As figure 6 of the paper: the active state, and the weight of the tracking torque, which stays "
      "continuous while the wall moves. Where a strategy has no states, vo stands for the ring in the wall.",
      values);
}

ethd_status ethd__report_traces(ethd__report *r) {
  char *names = NULL, *titles = NULL;
  size_t length;
  ethd_status status = ETHD_OK;
  ethd__recordings recordings;
  states drawn = {.names = open_memstream(&names, &length)};
  drawn.titles = open_memstream(&titles, &length);
  ethd__html_heading(&r->page, "traces", "Traces of single taps");
  ethd__recordings_find(r->folder->path, &recordings);
  for (size_t i = 0; drawn.names && drawn.titles && !status && i < r->data.group_count; i++)
    status = trace_group(r, &r->data.group[i], &recordings, &drawn);
  if (drawn.names) fclose(drawn.names);
  if (drawn.titles) fclose(drawn.titles);
  if (!status && !drawn.count && r->tap)
    status = ethd__say(r->message, ETHD_E_RANGE, "--tap: no test tap %s is recorded here", r->tap);
  if (!status && drawn.count) status = draw_states(r, names, titles);
  if (!status && !drawn.count)
    ethd__html_markup(&r->page, "<p>No ticks were recorded: there is nothing to draw.</p>\n");
  ethd__recordings_free(&recordings);
  free(names);
  free(titles);
  return status;
}
