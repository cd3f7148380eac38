#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/forces.h"
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

/* The tap to draw; an index beyond the last tap means that there is none. */
typedef struct choice {
  size_t index;
  char name[ETHD_FILE_NAME_MAX], *recording;
} choice;

/* Returns the typical tap among those whose ticks were recorded. */
static size_t typical(const ethd__report *r, const ethd__group *group, const ethd__recordings *recordings) {
  char name[ETHD_FILE_NAME_MAX];
  ethd__cell there = group->cell;
  there.results = malloc((there.count + 1) * sizeof *there.results);
  if (!there.results) return group->cell.count;
  memcpy(there.results, group->cell.results, there.count * sizeof *there.results);
  for (size_t i = 0; i < there.count; i++) {
    ethd__recording_name(&r->data.sheet, group->row[i], name);
    char *path = there.results[i].metrics.reason == ETHD_TAP_OK ? ethd__recording_path(recordings, name) : NULL;
    if (!path) there.results[i].metrics.reason = ETHD_TAP_REASON_COUNT;
    free(path);
  }
  size_t index = ethd__cell_valid(&there) ? ethd__cell_typical(&there) : there.count;
  free(there.results);
  return index;
}

/* Returns the tap that was asked for, if it belongs to this group. */
static size_t asked_for(const ethd__report *r, const ethd__group *group) {
  char name[ETHD_FILE_NAME_MAX];
  size_t i = 0;
  for (; i < group->cell.count; i++) {
    ethd__recording_name(&r->data.sheet, group->row[i], name);
    if (!strcmp(name, r->tap)) break;
  }
  return i;
}

/* False if there are no ticks to draw. */
static bool choose(const ethd__report *r, const ethd__group *group, const ethd__recordings *recordings, choice *out) {
  out->index = r->tap ? asked_for(r, group) : typical(r, group, recordings);
  if (out->index >= group->cell.count) return false;
  ethd__recording_name(&r->data.sheet, group->row[out->index], out->name);
  out->recording = ethd__recording_path(recordings, out->name);
  return out->recording != NULL;
}

static void trace_name(const ethd__group *group, const char *suffix, char out[ETHD_FILE_NAME_MAX]) {
  const char *parts[] = {"trace", group->cell.law, group->speed.word, NULL};
  ethd__file_name(parts, suffix, out);
}

#define SHOWN 0.09 /* s after the ring meets the wall: what tap.gp shows */

/* Says in a sentence how far the ring went into the wall within the picture, and against which force; "" if it met no
   wall. */
static void say_depth(const ethd__report *r, const ethd__view *view, const ethd__tap_rows *rows, char out[256]) {
  size_t meeting = ethd__metrics_meeting(rows, &view->rule), ticks = (size_t)(SHOWN / view->rule.period);
  double deepest = 0;
  *out = 0;
  if (meeting == rows->count) return;
  ethd__tap_rows shown = *rows;
  if (shown.count > meeting + ticks) shown.count = meeting + ticks;
  for (size_t i = meeting; i < shown.count; i++) {
    const double *ring = rows->truth[i].ring;
    deepest = fmax(deepest, view->rule.n.x * ring[0] + view->rule.n.y * ring[1] + view->ring_radius - view->wall);
  }
  ethd__strongest s = ethd__strongest_of(&r->folder->loaded.config->setup.arm, &shown);
  snprintf(
      out, 256,
      " Within the picture the ring goes %.1f mm into the wall that is asked for: against the hand the laws ask for up "
      "to %.0f N at the ring, and the guard lets through at most %.1f N.",
      1e3 * deepest, s.asked_n, s.let_n);
}

static ethd_status write_trace(ethd__report *r, const ethd__group *group, const choice *tap, const char *csv,
                               char said[256]) {
  ethd__tap_rows rows;
  ethd__view view;
  ethd_status status = view_of(r, group, &group->cell.results[tap->index], &view);
  if (!status) status = ethd__ticks_read(tap->recording, &rows, r->message);
  if (status) return status;
  status = ethd__trace_write(csv, &view, &rows, r->message);
  say_depth(r, &view, &rows, said);
  ethd__tap_rows_free(&rows);
  return status;
}

static ethd_status draw(ethd__report *r, const ethd__group *group, const char *csv, const char *tap,
                        const char *depth) {
  char caption[640], name[ETHD_FILE_NAME_MAX], title[96];
  const char *plant = r->folder->protocol.plant ? r->folder->protocol.plant : "n";
  trace_name(group, ".png", name);
  snprintf(title, sizeof title, "%s, %s speed", group->cell.law, group->speed.word);
  snprintf(caption, sizeof caption, "As figures 9 to 12 of the paper: %s, %s, tap %s%s.%s", group->cell.law,
           group->speed.word, tap, r->tap ? "" : ", of the valid ones that are recorded the one nearest to their means",
           depth);
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
  char name[ETHD_FILE_NAME_MAX], depth[256];
  choice tap;
  if (!choose(r, group, recordings, &tap)) return ETHD_OK;
  trace_name(group, ".csv", name);
  char *csv = ethd__report_path(r, name);
  ethd_status status = write_trace(r, group, &tap, csv, depth);
  if (!status) status = draw(r, group, name, tap.name, depth);
  fprintf(out->names, "%s%s", out->count ? " " : "", name);
  fprintf(out->titles, "%s%s-%s", out->count ? " " : "", group->cell.law, group->speed.word);
  out->count++;
  free(csv);
  free(tap.recording);
  return status;
}

static ethd_status draw_states(ethd__report *r, const char *names, const char *titles) {
  const ethd__picture_value values[] = {
      {"in", names, false},
      {"titles", titles, false},
      {"note", "the taps above; dashed: how far the ring's front is in the wall", false},
      {NULL, NULL, false}};
  return ethd__report_picture(r, "report-states.gp", "states.png",
                              "Of the same taps: the active state, and the weight of the tracking torque, which stays "
                              "continuous while the wall "
                              "moves. Where a strategy has no states, vo stands for the ring in the wall. The "
                              "recordings end soon after the touch.",
                              values);
}

static const char into_the_wall[] =
    "<p>Ring and finger go on into the virtual wall after the touch; each caption says how far. That is no error of "
    "the "
    "drawing: the hand goes on pushing, and the ring holds against it only with what the limits of the device let "
    "through, while the spring of the wall asks for more. d<sub>max</sub> is the first rebound alone, from the ring's "
    "first peak to the valley after it; v<sub>r min</sub> is its smallest speed in the 0.1 s after the touch.</p>\n"
    "<p>In the pictures n points into the wall; x<sub>e</sub> is the wall that is asked for, x<sub>&epsilon;</sub> the "
    "one that is rendered once a strategy has braked behind it. A strategy is transparent while the ring follows the "
    "finger, brakes, and then renders the virtual wall (vo); &beta; is the share of the following that is left.</p>\n";

ethd_status ethd__report_traces(ethd__report *r) {
  char *names = NULL, *titles = NULL;
  size_t length;
  ethd_status status = ETHD_OK;
  ethd__recordings recordings;
  states drawn = {.names = open_memstream(&names, &length)};
  drawn.titles = open_memstream(&titles, &length);
  ethd__html_heading(&r->page, "traces", "Traces of single taps");
  ethd__html_markup(&r->page, into_the_wall);
  ethd__recordings_find(&r->stations, &recordings);
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
