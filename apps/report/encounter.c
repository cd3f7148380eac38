#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "tap/study.h"
#include "text/file_name.h"

/* A hand that comes, stops behind the wall, waits, and goes back as it came: times in s, lengths in m. */
#define STEP 1e-3
#define BEFORE 0.05 /* of the way, at full speed, before the touch */
#define BEYOND 0.002
#define STOPPING 0.04
#define WAITING 0.12
#define SPEED 0.2 /* m/s */

static double speed_at(double t) {
  const double comes = (BEFORE + BEYOND) / SPEED, stands = comes + STOPPING, turns = stands + WAITING;
  if (t < comes) return SPEED;
  if (t < stands) return SPEED * (1 - (t - comes) / STOPPING);
  if (t < turns) return 0;
  if (t < turns + STOPPING) return -SPEED * (t - turns) / STOPPING;
  return t < turns + STOPPING + comes ? -SPEED : 0;
}

/* To the left, which is where the wall is; it touches after BEFORE. */
static void make_movement(ethd__study *study) {
  static ethd_path_sample samples[900];
  const size_t count = sizeof samples / sizeof *samples;
  double x = 0;
  for (size_t i = 0; i < count; i++) {
    samples[i] = (ethd_path_sample){STEP * (double)i, -x, 0};
    x += STEP * speed_at(STEP * (double)i);
  }
  study->movement = (ethd__movement){samples, count};
}

/* To the end of the movement: a tap would end a while after the touch. */
static ethd_status run(ethd__stage *stage, const ethd__rule *rule, const ethd_sim_tap *tap) {
  ethd__tapping tapping;
  ethd_status status = ethd__tapping_begin(stage->sim, stage->control, tap, rule, &stage->rows, &tapping);
  size_t end = (size_t)(ethd_path_end(&tap->path) / rule->period);
  for (; !status; status = ethd__tapping_step(&tapping)) tapping.last = end;
  return status < 0 ? status : ETHD_OK;
}

static ethd_status write_encounter(ethd__report *r, const char *law, const char *name) {
  ethd__speed speed;
  ethd__study study = {.config = r->folder->loaded.config, .plant = r->folder->loaded.plant, .seed = r->seed};
  ethd__stage stage;
  ethd_sim_tap tap;
  make_movement(&study);
  if (!ethd__speed_parse("0.2", &study.plant, &speed)) return ETHD_E_RANGE;
  study.speeds = &speed;
  study.speed_count = 1;
  ethd_status status = ethd__study_prepare(&study, r->message);
  if (!status) status = ethd__stage_open(&study, law, &stage, r->message);
  if (status) return status;
  speed.touchdown = (ethd__touchdown){BEFORE / SPEED, {-BEFORE, 0}, false};
  status = ethd__stage_draw(&stage, &speed, 0, &tap);
  const ethd__rule rule = ethd__stage_rule(&stage, &speed, tap.finger_radius);
  const ethd__view view = ethd__stage_view(&stage, &speed, tap.finger_radius);
  if (!status) status = run(&stage, &rule, &tap);
  char *path = ethd__report_path(r, name);
  if (!status) status = ethd__trace_write(path, &view, &stage.rows, r->message);
  free(path);
  ethd__stage_close(&stage);
  return status;
}

static bool seen_before(const ethd__data *data, size_t group) {
  for (size_t i = 0; i < group; i++)
    if (!strcmp(data->group[i].cell.law, data->group[group].cell.law)) return true;
  return false;
}

ethd_status ethd__report_encounter(ethd__report *r) {
  char names[ETHD_REPORT_CELLS * ETHD_FILE_NAME_MAX] = "", titles[ETHD_REPORT_CELLS * ETHD_FILE_NAME_MAX] = "";
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < r->data.group_count; i++) {
    const char *law = r->data.group[i].cell.law, *parts[] = {"encounter", law, NULL}, *space = *names ? " " : "";
    char name[ETHD_FILE_NAME_MAX];
    if (seen_before(&r->data, i)) continue;
    ethd__file_name(parts, ".csv", name);
    status = write_encounter(r, law, name);
    strcat(strcat(names, space), name);
    strcat(strcat(titles, space), law);
  }
  if (status) return status;
  const ethd__picture_value values[] = {
      {"in", names, false},
      {"titles", titles, false},
      {"note", "simulated for this picture; dashed: how far the ring's front is in the wall", false},
      {"from", "-60", false},
      {NULL, NULL, false}};
  return ethd__report_picture(
      r, "report-states.gp", "encounter.png",
      "As figure 6 of the paper, a whole encounter: approach at 0.2 m/s, touch, 0.12 s of pressing, retreat, until the "
      "ring follows the finger freely again. Simulated for this picture with the study's configuration and plant, no "
      "tap "
      "of the study, whose recordings end soon after the touch.",
      values);
}
