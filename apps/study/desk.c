#include "study/desk.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "study/movements.h"
#include "study/people.h"
#include "text/error_text.h"

/* ---- the person ---- */

static bool parse_speed(const ethd__desk *desk, const ethd_plant *plant, const char *word, ethd__speed *out) {
  const ethd__protocol *p = desk->protocol;
  if (!ethd__speed_parse(word, plant, out)) return false;
  if (!strcmp(word, "low")) {
    if (!isnan(p->band_low)) out->band = p->band_low;
  } else if (!strcmp(word, "high")) {
    if (!isnan(p->band_high)) out->band = p->band_high;
  } else {
    out->commanded *= plant->speed_low / desk->loaded->plant.speed_low;
  }
  return true;
}

static void leave(ethd__desk *desk) {
  if (desk->open) ethd__stage_close(&desk->stage);
  ethd__movement_free(&desk->study.movement);
  desk->open = false;
}

static void seat(ethd__desk *desk, uint32_t person) {
  const ethd__protocol *p = desk->protocol;
  leave(desk);
  desk->person = person;
  desk->seated = true;
  desk->study.plant = p->hands == ETHD_HANDS_PEOPLE
                          ? desk->loaded->plant
                          : ethd__person_plant(&desk->loaded->plant, p->seed, person, p->between, p->hand_spread);
  desk->study.seed = ethd__person_seed(p->seed, person);
  for (size_t i = 0; i < p->speeds.count; i++)
    (void)parse_speed(desk, &desk->study.plant, p->speeds.word[i], &desk->speeds[i]);
}

/* ---- recorded fingers ---- */

/* The number of an attempt within its cell, from 0. Interleaved, the first attempts of all rounds come first, so that
   rounds meet different movements. */
static uint32_t before(const ethd__desk *desk, const ethd__turn *turn) {
  const bool is_interleaved = desk->protocol->order == ETHD_ORDER_INTERLEAVED;
  return (turn->attempt - 1) * (is_interleaved ? desk->protocol->taps : 1) + turn->block.round;
}

/* The movements are divided among the participants; every strategy gets the same ones. */
static size_t movement_of(const ethd__desk *desk, const ethd__turn *turn) {
  size_t k = turn->person + (size_t)desk->protocol->participants * before(desk, turn);
  return (k + (turn->block.training ? desk->movement_count / 2 : 0)) % desk->movement_count;
}

static const char *movement_name(const ethd__desk *desk) {
  if (!desk->movement_count) return NULL;
  const char *file = desk->movements[desk->movement], *slash = strrchr(file, '/');
  return slash ? slash + 1 : file;
}

static ethd_status take_movement(ethd__desk *desk, const ethd__turn *turn, char *message) {
  if (!desk->movement_count) return ETHD_OK;
  size_t movement = movement_of(desk, turn);
  if (desk->study.movement.count && desk->movement == movement) return ETHD_OK;
  leave(desk);
  ethd_status status =
      ethd__movement_load(desk->movements[movement], &ethd__movement_si, &desk->study.movement, message);
  desk->movement = movement;
  return status ? status : ethd__study_prepare(&desk->study, message);
}

/* ---- a tap ---- */

static ethd_status open_stage(ethd__desk *desk, size_t strategy, char *message) {
  if (desk->open && desk->strategy == strategy) return ETHD_OK;
  if (desk->open) ethd__stage_close(&desk->stage);
  desk->open = false;
  ethd_status status = ethd__stage_open(&desk->study, desk->protocol->strategies.word[strategy], &desk->stage, message);
  desk->open = !status;
  desk->strategy = strategy;
  return status;
}

/* Attempt k of a round has the same finger under every strategy. */
static uint64_t tap_of(const ethd__desk *desk, const ethd__turn *turn) {
  return (uint64_t)turn->block.training << 32 | (uint64_t)turn->block.speed << 24 | before(desk, turn);
}

ethd_status ethd__desk_prepare(ethd__desk *desk, const ethd__turn *turn, ethd__taken *out,
                               char message[ETHD_MESSAGE_MAX]) {
  if (!desk->seated || desk->person != turn->person) seat(desk, turn->person);
  ethd_status status = take_movement(desk, turn, message);
  if (!status) status = open_stage(desk, turn->block.strategy, message);
  if (status) return status;
  *out = (ethd__taken){.turn = *turn,
                       .hand = desk->movement_count ? ETHD_HAND_RECORDED : ETHD_HAND_SIMULATED,
                       .movement = movement_name(desk),
                       .seed = desk->study.seed,
                       .tap = tap_of(desk, turn),
                       .speed = &desk->speeds[turn->block.speed],
                       .stage = &desk->stage};
  return ETHD_OK;
}

const char *const ethd__hand_words[ETHD_HAND_SOURCES] = {"device", "mouse", "simulated", "recorded"};

/* Names a failing law once, not for each tap; all its taps are faults. */
static void tell_law(ethd__desk *desk, const ethd__law_fault *fault) {
  char text[ETHD_MESSAGE_MAX];
  if (!fault->law || fault->law == desk->told) return;
  desk->told = fault->law;
  fprintf(stderr, "%s: %s; its taps count as faults\n", program_invocation_short_name,
          ethd__law_fault_text(fault, text));
}

/* A simulated tap is over in less time than it has ticks. */
static void mark_touch(const ethd__desk *desk, const ethd__turn *turn, int64_t begin_ns) {
  const ethd__tap_rows *rows = &desk->stage.rows;
  size_t i = 0;
  while (i < rows->count && !(rows->truth[i].pad > 0)) i++;
  if (i < rows->count)
    ethd__markers_send(desk->markers, "contact", turn, begin_ns + llrint(1e9 * rows->truth[i].t), "-");
}

static ethd_status tap(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__desk *desk = self;
  int64_t begin_ns = ethd__clock_now();
  ethd_status status = ethd__desk_prepare(desk, turn, out, message);
  ethd__markers_send(desk->markers, "trial-begin", turn, begin_ns, "-");
  if (!status) status = ethd__stage_run(&desk->stage, out->speed, out->tap, &out->result, message);
  if (!status) mark_touch(desk, turn, begin_ns);
  if (!status) tell_law(desk, &out->result.law_fault);
  return status;
}

ethd__source ethd__desk_source(ethd__desk *desk) {
  return (ethd__source){
      .self = desk, .hand = desk->movement_count ? ETHD_HAND_RECORDED : ETHD_HAND_SIMULATED, .tap = tap};
}

/* ---- opening ---- */

void ethd__desk_point(ethd__desk *desk, size_t point) {
  const ethd__protocol *p = desk->protocol;
  for (size_t i = 0; i < p->axis_count; i++)
    desk->gains[i] = (ethd__gain){p->axes[i].key, ethd__protocol_value(p, point, i)};
  desk->study.gain_count = p->axis_count;
  desk->seated = false;
}

static ethd_status refuse(const ethd__protocol *p, int line, const char *key, const char *what, char *message) {
  char why[ETHD_MESSAGE_MAX / 2];
  snprintf(why, sizeof why, "%s", what);
  if (!line) return ethd__say(message, ETHD_E_RANGE, "%s: %s: %s", p->path, key, why);
  return ethd__say(message, ETHD_E_RANGE, "%s:%d: %s: %s", p->path, line, key, why);
}

/* Refuses a word of the study's strategies or speeds, with its place. */
static ethd_status refuse_word(const ethd__protocol *p, bool speed, size_t index, const char *what, char *message) {
  const ethd__word_list *words = speed ? &p->speeds : &p->strategies;
  size_t i = 0;
  if (!p->conditions) return refuse(p, words->line, speed ? "study.speeds" : "study.strategies", what, message);
  while ((speed ? p->condition[i].speed : p->condition[i].strategy) != index) i++;
  return ethd__say(message, ETHD_E_RANGE, "%s:%zu: %s: %.300s", p->condition_path, p->condition[i].line,
                   speed ? "speed" : "transition", what);
}

static ethd_status check_speeds(ethd__desk *desk, char *message) {
  const ethd__word_list *speeds = &desk->protocol->speeds;
  char what[ETHD_MESSAGE_MAX];
  for (size_t i = 0; i < speeds->count; i++) {
    snprintf(what, sizeof what, "found \"%s\"; low, high and numbers from 0.01 to 2 are allowed", speeds->word[i]);
    if (!parse_speed(desk, &desk->loaded->plant, speeds->word[i], &desk->speeds[i]))
      return refuse_word(desk->protocol, true, i, what, message);
  }
  return ETHD_OK;
}

static ethd_status check_strategies(ethd__desk *desk, char *message) {
  const ethd__word_list *strategies = &desk->protocol->strategies;
  char why[ETHD_MESSAGE_MAX];
  for (size_t i = 0; i < strategies->count; i++) {
    ethd_setup setup = desk->loaded->config->setup;
    if (ethd_config_transition(desk->loaded->config, strategies->word[i], &setup, why))
      return refuse_word(desk->protocol, false, i, why, message);
  }
  return ETHD_OK;
}

/* At least one strategy must have the parameter and accept the value. */
static ethd_status check_value(const ethd__desk *desk, size_t axis, const char *value, char *message) {
  const ethd__protocol *p = desk->protocol;
  const char *key = p->axes[axis].key;
  char why[ETHD_MESSAGE_MAX] = "", name[80];
  for (size_t i = 0; i < p->strategies.count; i++) {
    ethd_setup setup = desk->loaded->config->setup;
    if (ethd_config_transition(desk->loaded->config, p->strategies.word[i], &setup, why)) continue;
    if (!ethd_config_set(desk->loaded->config, key, value, &setup, why)) return ETHD_OK;
  }
  snprintf(name, sizeof name, "grid.%s", key);
  return refuse(p, p->axes[axis].values.line, name, why, message);
}

static ethd_status check_grid(const ethd__desk *desk, char *message) {
  const ethd__protocol *p = desk->protocol;
  ethd_status status = ETHD_OK;
  for (size_t axis = 0; !status && axis < p->axis_count; axis++)
    for (size_t i = 0; !status && i < p->axes[axis].values.count; i++)
      status = check_value(desk, axis, p->axes[axis].values.word[i], message);
  return status;
}

static ethd_status check_stages(ethd__desk *desk, char *message) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < desk->protocol->strategies.count; i++) status = open_stage(desk, i, message);
  leave(desk);
  return status;
}

ethd_status ethd__desk_open(const ethd__protocol *protocol, const ethd__loaded *loaded, const char *finger,
                            ethd__desk *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__desk){.protocol = protocol, .loaded = loaded};
  out->study = (ethd__study){.config = loaded->config,
                             .plant = loaded->plant,
                             .speeds = out->speeds,
                             .speed_count = protocol->speeds.count,
                             .gains = out->gains,
                             .validity = protocol->validity,
                             .graze = protocol->graze,
                             .single = true,
                             .lift = protocol->lift};
  ethd_status status = check_speeds(out, message);
  if (!status) status = check_strategies(out, message);
  if (!status) status = check_grid(out, message);
  if (!status) status = ethd__study_prepare(&out->study, message);
  if (!status) status = check_stages(out, message);
  if (!status && (protocol->hands == ETHD_HANDS_RECORDED || finger))
    status = ethd__movements_find(protocol, finger, &out->movements, &out->movement_count, message);
  if (status) ethd__desk_close(out);
  return status;
}

void ethd__desk_close(ethd__desk *desk) {
  leave(desk);
  ethd__movements_free(desk->movements, desk->movement_count);
  desk->movements = NULL;
  desk->movement_count = 0;
}
