#include "describe/describe.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "sim/plant.h"
#include "study/columns.h"
#include "study/stations.h"
#include "tap/device.h"
#include "tap/study.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- study.json ---- */

static json_t *number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_t *words(const ethd__word_list *list) {
  json_t *out = json_array();
  for (size_t i = 0; i < list->count; i++) json_array_append_new(out, json_string(list->word[i]));
  return out;
}

/* The name in the study's file or the configuration: the folder holds a copy. */
static const char *plant_name(const ethd__folder *folder) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd__sim_settings device;
  if (folder->protocol.plant) return folder->protocol.plant;
  return !ethd__device_read(folder->loaded.config, &device, unsaid) && device.plant ? device.plant->value : ETHD__PLANT;
}

static json_t *protocol(const ethd__folder *folder) {
  static const char *const hands[] = {"simulated", "recorded", "people", "mouse"};
  const ethd__protocol *p = &folder->protocol;
  const char *device = folder->loaded.config->device;
  return json_pack("{s:s, s:s, s:s, s:s, s:s?, s:b, s:s, s:s, s:b, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:s?}",
                   "name", p->name, "hash", folder->hash, "version", ETHD_VERSION, "hands", hands[p->hands], "motion",
                   p->motion, "follows_movement", folder->finger != NULL, "plant", plant_name(folder), "device", device,
                   "is_simulated", !strcmp(device, ethd_driver_sim.id), "valid_by_finger",
                   p->validity == ETHD_TAP_BY_FINGER, "band_low_mps", number(p->band_low), "band_high_mps",
                   number(p->band_high), "slack_m", number(p->slack), "margin_d_max_m", number(p->margin_d_max),
                   "margin_v_of_mps", number(p->margin_v_of), "margin_v_rmin_mps", number(p->margin_v_rmin),
                   "strategies", words(&p->strategies), "primary", words(&p->primary), "exclusions", p->exclusions);
}

static json_t *speeds(const ethd_plant *plant) {
  static const char *const names[] = {"low", "high"};
  json_t *out = json_object();
  for (int i = 0; i < 2; i++) {
    ethd__speed speed;
    (void)!ethd__speed_parse(names[i], plant, &speed);
    json_object_set_new(out, names[i],
                        json_pack("{s:o, s:o}", "centre_mps", number(speed.centre), "band_mps", number(speed.band)));
  }
  return out;
}

static json_t *questions(const ethd__protocol *p) {
  const ethd__question *list = p->questionnaire.question[ETHD_ASK_BLOCK];
  json_t *out = json_array();
  for (size_t i = 0; i < ethd__question_count(list); i++) {
    json_t *answers = json_array();
    char text[256];
    for (int k = 1; k <= (int)ethd__answer_count(&list[i]); k++) {
      ethd__answer_words(&list[i], k, text, sizeof text);
      json_array_append_new(answers, json_string(text));
    }
    json_array_append_new(out, json_pack("{s:s, s:b, s:o}", "text", list[i].text, "has_words", list[i].answers != NULL,
                                         "answers", answers));
  }
  return out;
}

static json_t *grid(const ethd__protocol *p) {
  json_t *out = json_array();
  for (size_t i = 0; i < p->axis_count; i++)
    json_array_append_new(out, json_pack("{s:s, s:o}", "key", p->axes[i].key, "values", words(&p->axes[i].values)));
  return out;
}

static json_t *sight(const ethd_setup *setup, const ethd__view *view) {
  return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:b, s:o, s:o, s:o}", "mechanism",
                   ethd_arm_name(setup->arm.mechanism), "link1_m", number(setup->arm.link1), "link2_m",
                   number(setup->arm.link2), "period_s", number(view->rule.period), "ring_radius_m",
                   number(view->ring_radius), "d_beta_m", number(view->rule.d_beta), "speed_of_motor_side",
                   view->rule.side, "normal_x", number(view->rule.n.x), "normal_y", number(view->rule.n.y), "wall_m",
                   number(view->wall));
}

/* Returns NULL where a text isn't UTF-8, or without memory. */
static json_t *study(const ethd__folder *folder, const ethd__view *view) {
  const ethd__protocol *p = &folder->protocol;
  json_t *out = protocol(folder), *seen = sight(&folder->loaded.config->setup, view),
         *asked = json_pack("{s:o, s:b, s:b, s:o, s:o}", "speeds", speeds(&folder->loaded.plant), "survey", p->survey,
                            "own_questions", p->questionnaire.own, "questions", questions(p), "grid", grid(p));
  bool whole = !json_object_update(out, asked) && !json_object_update(out, seen);
  json_decref(asked);
  json_decref(seen);
  if (whole) return out;
  json_decref(out);
  return NULL;
}

/* ---- files ---- */

static ethd_status find_view(const ethd__folder *folder, ethd__view *out, char *message) {
  const ethd__speed any = {.centre = 0};
  ethd__study study = {.config = folder->loaded.config, .plant = folder->loaded.plant};
  ethd_status status = ethd__study_prepare(&study, message);
  const ethd__stage stage = {.study = &study, .setup = study.config->setup};
  if (!status) *out = ethd__stage_view(&stage, &any, 0);
  return status;
}

static ethd_status write_study(const ethd__folder *folder, const char *out, char *message) {
  ethd__view view;
  ethd_status status = find_view(folder, &view, message);
  if (status) return status;
  json_t *facts = study(folder, &view);
  ETHD__FREED char *text = json_dumps(facts, JSON_INDENT(2) | JSON_REAL_PRECISION(17)),
                   *path = ethd__folder_path(out, "study.json");
  status = text ? ethd_text_write(path, text, strlen(text), message)
                : ethd__say(message, ETHD_E_SYNTAX, "%s: a text isn't UTF-8", folder->protocol.path);
  json_decref(facts);
  return status;
}

static ethd_status write_tables(char *const text[ETHD_TABLES], const char *out, char *message) {
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < ETHD_TABLES; i++) {
    char name[40];
    if (!text[i]) continue;
    snprintf(name, sizeof name, "%s.csv", ethd__table_names[i]);
    ETHD__FREED char *path = ethd__folder_path(out, name);
    status = ethd_text_write(path, text[i], strlen(text[i]), message);
  }
  return status;
}

static ethd_status write_files(const ethd__folder *folder, char *const tables[ETHD_TABLES], const char *out,
                               char *message) {
  static const char *const any[] = {"*", NULL};
  ethd__claim claim;
  ethd_status status = ethd__claim_folder(out, any, false, &claim, message);
  if (status) return status;
  status = write_study(folder, out, message);
  if (!status) status = write_tables(tables, out, message);
  for (size_t i = 0; !status && i < folder->protocol.strategies.count; i++)
    status = ethd__encounter_write(folder, folder->protocol.strategies.word[i], out, message);
  ethd__claim_release(&claim);
  return status;
}

ethd_status ethd__describe(const char *const *folders, size_t count, bool plugins, const char *out, bool *job,
                           char message[ETHD_MESSAGE_MAX]) {
  ethd__folder folder;
  char *tables[ETHD_TABLES] = {NULL};
  *job = false;
  ethd_status status = ethd__folder_open(folders[0], plugins, &folder, message);
  if (status) return status;
  if (count > 1) status = ethd__stations_fit(folders, count, message);
  if (!status && count > 1) status = ethd__stations_tables(folders, count, tables, message);
  *job = !status;
  if (!status) status = write_files(&folder, tables, out, message);
  for (int i = 0; i < ETHD_TABLES; i++) free(tables[i]);
  ethd__folder_close(&folder);
  return status;
}
