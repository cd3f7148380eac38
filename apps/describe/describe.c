#include "describe/describe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/json.h"
#include "ethd/ethd.h"
#include "sim/plant.h"
#include "study/columns.h"
#include "study/stations.h"
#include "tap/device.h"
#include "tap/study.h"
#include "text/claim.h"
#include "text/text.h"

/* ---- study.json ---- */

static void put_key(FILE *file, const char *key) { fprintf(file, ",\n  \"%s\": ", key); }

static void put_word(FILE *file, const char *key, const char *word) {
  put_key(file, key);
  ethd__json_word(file, word);
}

static void put_number(FILE *file, const char *key, double value) {
  put_key(file, key);
  ethd__json_number(file, value);
}

static void put_truth(FILE *file, const char *key, bool truth) {
  put_key(file, key);
  fputs(truth ? "true" : "false", file);
}

static void put_words(FILE *file, const char *key, const ethd__word_list *list) {
  put_key(file, key);
  putc('[', file);
  for (size_t i = 0; i < list->count; i++) {
    if (i) fputs(", ", file);
    ethd__json_word(file, list->word[i]);
  }
  putc(']', file);
}

/* The name in the study's file or the configuration: the folder holds a copy. */
static const char *plant_name(const ethd__folder *folder) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd__sim_settings device;
  if (folder->protocol.plant) return folder->protocol.plant;
  return !ethd__device_read(folder->loaded.config, &device, unsaid) && device.plant ? device.plant->value : ETHD__PLANT;
}

static void put_protocol(FILE *file, const ethd__folder *folder) {
  static const char *const hands[] = {"simulated", "recorded", "people", "mouse"};
  const ethd__protocol *p = &folder->protocol;
  put_word(file, "hands", hands[p->hands]);
  put_word(file, "motion", p->motion);
  put_truth(file, "follows_movement", folder->finger);
  put_word(file, "plant", plant_name(folder));
  put_word(file, "device", folder->loaded.config->device);
  put_truth(file, "is_simulated", !strcmp(folder->loaded.config->device, ethd_driver_sim.id));
  put_truth(file, "valid_by_finger", p->validity == ETHD_TAP_BY_FINGER);
  put_number(file, "band_low_mps", p->band_low);
  put_number(file, "band_high_mps", p->band_high);
  put_number(file, "slack_m", p->slack);
  put_number(file, "margin_d_max_m", p->margin_d_max);
  put_number(file, "margin_v_of_mps", p->margin_v_of);
  put_number(file, "margin_v_rmin_mps", p->margin_v_rmin);
  put_words(file, "strategies", &p->strategies);
  put_words(file, "primary", &p->primary);
  put_word(file, "exclusions", p->exclusions);
}

static void put_speeds(FILE *file, const ethd_plant *plant) {
  static const char *const words[] = {"low", "high"};
  put_key(file, "speeds");
  for (int i = 0; i < 2; i++) {
    ethd__speed speed;
    (void)!ethd__speed_parse(words[i], plant, &speed);
    fprintf(file, "%s\"%s\": {\"centre_mps\": ", i ? ", " : "{", words[i]);
    ethd__json_number(file, speed.centre);
    fputs(", \"band_mps\": ", file);
    ethd__json_number(file, speed.band);
    putc('}', file);
  }
  putc('}', file);
}

static void put_question(FILE *file, const ethd__question *question) {
  char words[256];
  fputs("{\"text\": ", file);
  ethd__json_word(file, question->text);
  fprintf(file, ", \"has_words\": %s, \"answers\": [", question->answers ? "true" : "false");
  for (int k = 1; k <= (int)ethd__answer_count(question); k++) {
    ethd__answer_words(question, k, words, sizeof words);
    if (k > 1) fputs(", ", file);
    ethd__json_word(file, words);
  }
  fputs("]}", file);
}

static void put_questionnaire(FILE *file, const ethd__protocol *p) {
  put_truth(file, "survey", p->survey);
  put_truth(file, "own_questions", p->questionnaire.own);
  put_key(file, "questions");
  putc('[', file);
  for (size_t i = 0; i < ethd__question_count(p->questionnaire.question[ETHD_ASK_BLOCK]); i++) {
    fputs(i ? ",\n    " : "\n    ", file);
    put_question(file, &p->questionnaire.question[ETHD_ASK_BLOCK][i]);
  }
  putc(']', file);
}

static void put_grid(FILE *file, const ethd__protocol *p) {
  put_key(file, "grid");
  putc('[', file);
  for (size_t i = 0; i < p->axis_count; i++) {
    fputs(i ? ", {\"key\": " : "{\"key\": ", file);
    ethd__json_word(file, p->axes[i].key);
    fputs(", \"values\": [", file);
    for (size_t k = 0; k < p->axes[i].values.count; k++) {
      if (k) fputs(", ", file);
      ethd__json_word(file, p->axes[i].values.word[k]);
    }
    fputs("]}", file);
  }
  putc(']', file);
}

static void put_view(FILE *file, const ethd_setup *setup, const ethd__view *view) {
  put_word(file, "mechanism", ethd_arm_name(setup->arm.mechanism));
  put_number(file, "link1_m", setup->arm.link1);
  put_number(file, "link2_m", setup->arm.link2);
  put_number(file, "period_s", view->rule.period);
  put_number(file, "ring_radius_m", view->ring_radius);
  put_number(file, "d_beta_m", view->rule.d_beta);
  put_truth(file, "speed_of_motor_side", view->rule.side);
  put_number(file, "normal_x", view->rule.n.x);
  put_number(file, "normal_y", view->rule.n.y);
  put_number(file, "wall_m", view->wall);
}

static void put_study(FILE *file, const ethd__folder *folder, const ethd__view *view) {
  fputs("{\n  \"name\": ", file);
  ethd__json_word(file, folder->protocol.name);
  put_word(file, "hash", folder->hash);
  put_word(file, "version", ETHD_VERSION);
  put_protocol(file, folder);
  put_speeds(file, &folder->loaded.plant);
  put_questionnaire(file, &folder->protocol);
  put_grid(file, &folder->protocol);
  put_view(file, &folder->loaded.config->setup, view);
  fputs("\n}\n", file);
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
  ethd_replace replace;
  ethd_status status = find_view(folder, &view, message);
  if (status) return status;
  char *path = ethd__folder_path(out, "study.json");
  status = ethd_replace_begin(path, &replace, message);
  free(path);
  if (status) return status;
  put_study(replace.file, folder, &view);
  return ethd_replace_commit(&replace, message);
}

static ethd_status write_tables(char *const text[ETHD_TABLES], const char *out, char *message) {
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < ETHD_TABLES; i++) {
    char name[40];
    if (!text[i]) continue;
    snprintf(name, sizeof name, "%s.csv", ethd__table_names[i]);
    char *path = ethd__folder_path(out, name);
    status = ethd_text_write(path, text[i], strlen(text[i]), message);
    free(path);
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
