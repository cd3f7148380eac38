
#include "describe/describe.h"
#include "tap/study.h"
#include "text/file_name.h"

/* A hand that approaches, stops behind the wall, waits, and returns on the same path: times in s, lengths in m. */
#define STEP 1e-3
#define BEFORE 0.05 /* travelled at full speed before the touch */
#define BEYOND 0.002
#define STOPPING 0.04
#define WAITING 0.12
#define SPEED 0.4 /* m/s: at half of it the wall moves too little to be seen */

static double speed_at(double t) {
  const double comes = (BEFORE + BEYOND) / SPEED, stands = comes + STOPPING, turns = stands + WAITING;
  if (t < comes) return SPEED;
  if (t < stands) return SPEED * (1 - (t - comes) / STOPPING);
  if (t < turns) return 0;
  if (t < turns + STOPPING) return -SPEED * (t - turns) / STOPPING;
  return t < turns + STOPPING + comes ? -SPEED : 0;
}

/* Moves left, to the wall, and touches after BEFORE. */
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

/* Runs to the end of the movement; a tap would end a while after the touch. */
static ethd_status run(ethd__stage *stage, const ethd__rule *rule, const ethd_sim_tap *tap) {
  ethd__tapping tapping;
  ethd_status status = ethd__tapping_begin(stage->sim, stage->control, tap, rule, &stage->rows, &tapping);
  size_t end = (size_t)(ethd_path_end(&tap->path) / rule->period);
  for (; !status; status = ethd__tapping_step(&tapping)) tapping.last = end;
  return status < 0 ? status : ETHD_OK;
}

ethd_status ethd__encounter_write(const ethd__folder *folder, const char *law, const char *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  const char *words[] = {"encounter", law, NULL};
  char name[ETHD_FILE_NAME_MAX];
  ethd__speed speed;
  ethd__study study = {.config = folder->loaded.config, .plant = folder->loaded.plant, .seed = folder->protocol.seed};
  ethd__stage stage;
  ethd_sim_tap tap;
  make_movement(&study);
  if (!ethd__speed_parse("0.4", &study.plant, &speed)) return ETHD_E_RANGE;
  study.speeds = &speed;
  study.speed_count = 1;
  ethd_status status = ethd__study_prepare(&study, message);
  if (!status) status = ethd__stage_open(&study, law, &stage, message);
  if (status) return status;
  speed.touchdown = (ethd__touchdown){BEFORE / SPEED, {-BEFORE, 0}, false};
  status = ethd__stage_draw(&stage, &speed, 0, &tap);
  const ethd__rule rule = ethd__stage_rule(&stage, &speed, tap.finger_radius);
  const ethd__view view = ethd__stage_view(&stage, &speed, tap.finger_radius);
  if (!status) status = run(&stage, &rule, &tap);
  ethd__file_name(words, ".csv", name);
  ETHD__FREED char *path = ethd__folder_path(out, name);
  if (!status) status = ethd__trace_write(path, &view, &stage.rows, message);
  ethd__stage_close(&stage);
  return status;
}
