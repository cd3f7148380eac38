/* Reads sequences: the keys step1, step2, ... of a section. */
#include <string.h>

#include "servo/map_parts.h"
#include "servo/words.h"
#include "text/error_text.h"
#include "text/text.h"

#define WORDS_MAX 5
#define WAIT_MAX 60.0

typedef struct words {
  const char *at[WORDS_MAX];
  size_t length[WORDS_MAX];
  uint32_t count; /* WORDS_MAX: that number or more */
} words;

static words split(const char *text) {
  words w = {.count = 0};
  for (text += strspn(text, " \t"); *text && w.count < WORDS_MAX; w.count++) {
    w.at[w.count] = text;
    w.length[w.count] = strcspn(text, " \t");
    text += w.length[w.count];
    text += strspn(text, " \t");
  }
  return w;
}

static bool is(const words *w, uint32_t i, const char *text) {
  return w->length[i] == strlen(text) && !memcmp(w->at[i], text, w->length[i]);
}

/* Reads the number at word i; `whole` demands a whole one. */
static bool number(const words *w, uint32_t i, bool whole, double *out) {
  char text[32];
  if (w->length[i] >= sizeof text) return false;
  memcpy(text, w->at[i], w->length[i]);
  text[w->length[i]] = 0;
  return whole ? ethd__whole(text, w->length[i], out) : ethd__number(text, w->length[i], out);
}

static ethd_status refuse_register(const ethd__key_file *s, const ethd_ini_key *key, const words *w) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(s->message, ETHD_E_UNKNOWN, "%s:%d: %s.%s: the map has no [register %.*s]: %s", s->name, key->line,
                   key->section, key->key, (int)(w->length[1] < 40 ? w->length[1] : 40), w->at[1],
                   ethd__quote(key->value, strlen(key->value), quote));
}

static ethd_status read_write(const ethd__key_file *s, const ethd_ini_key *key, const words *w,
                              const ethd__servo_map *map, ethd__servo_step *out) {
  double min, max;
  const ethd__servo_register *r = &map->registers[out->at];
  if (r->direction != ETHD__SERVO_WRITE) return ethd__servo_refuse(s, key, "a register with direction = write");
  ethd__servo_range(r, &min, &max);
  if (w->count != 3 || !number(w, 2, r->type != ETHD__SERVO_F32, &out->value) ||
      !(out->value >= min && out->value <= max))
    return ethd__servo_refuse(s, key, "write NAME RAW, with a number of the register's type,");
  return ETHD_OK;
}

static ethd_status read_wait(const ethd__key_file *s, const ethd_ini_key *key, const words *w,
                             const ethd__servo_map *map, ethd__servo_step *out) {
  double mask, bits, most = map->registers[out->at].type >= ETHD__SERVO_U32 ? 4294967295.0 : 65535;
  if (map->registers[out->at].direction != ETHD__SERVO_READ)
    return ethd__servo_refuse(s, key, "a register with direction = read");
  if (w->count != 5 || w->at[4][w->length[4]] || !number(w, 2, true, &mask) || !number(w, 3, true, &bits) ||
      !(mask >= 1 && mask <= most) || !(bits >= 0 && bits <= most) || ((uint32_t)bits & ~(uint32_t)mask) ||
      !number(w, 4, false, &out->value) || !(out->value > 0 && out->value <= WAIT_MAX))
    return ethd__servo_refuse(s, key, "wait NAME MASK BITS SECONDS, with bits within the mask and up to 60 s,");
  out->mask = (uint32_t)mask;
  out->bits = (uint32_t)bits;
  return ETHD_OK;
}

static ethd_status read_step(const ethd__key_file *s, const ethd_ini_key *key, const ethd__servo_map *map,
                             ethd__servo_step *out) {
  words w = split(key->value);
  *out = (ethd__servo_step){.line = key->line, .at = -1};
  if (is(&w, 0, "pause")) {
    out->kind = ETHD__SERVO_STEP_PAUSE;
    if (w.count == 2 && number(&w, 1, false, &out->value) && out->value > 0 && out->value <= WAIT_MAX) return ETHD_OK;
    return ethd__servo_refuse(s, key, "pause SECONDS, up to 60,");
  }
  bool is_write = is(&w, 0, "write");
  if (w.count < 2 || (!is_write && !is(&w, 0, "wait")))
    return ethd__servo_refuse(s, key, "write NAME RAW, wait NAME MASK BITS SECONDS or pause SECONDS");
  out->kind = is_write ? ETHD__SERVO_STEP_WRITE : ETHD__SERVO_STEP_WAIT;
  out->at = ethd__servo_find(map, w.at[1], w.length[1]);
  if (out->at < 0) return refuse_register(s, key, &w);
  return is_write ? read_write(s, key, &w, map, out) : read_wait(s, key, &w, map, out);
}

/* Returns N of a key "stepN", N from 1 and without leading zeros; 0 for any other key. */
static uint32_t step_number(const char *key) {
  uint32_t n = 0;
  if (strncmp(key, "step", 4) || key[4] == '0') return 0;
  for (key += 4; *key >= '0' && *key <= '9' && n < 1000; key++) n = 10 * n + (uint32_t)(*key - '0');
  return *key ? 0 : n;
}

ethd_status ethd__servo_read_steps(const ethd__key_file *s, const char *section, const ethd__servo_map *map,
                                   ethd__servo_steps *out) {
  out->count = 0;
  for (uint32_t i = 0; i < s->ini->count; i++) {
    const ethd_ini_key *key = &s->ini->keys[i];
    if (strcmp(key->section, section)) continue;
    uint32_t n = step_number(key->key);
    if (!n || n > ETHD__SERVO_STEPS_MAX)
      return ethd__say(s->message, ETHD_E_UNKNOWN, "%s:%d: %s.%s: step1 to step%u are allowed", s->name, key->line,
                       section, key->key, ETHD__SERVO_STEPS_MAX);
    if (n != out->count + 1)
      return ethd__say(s->message, ETHD_E_SYNTAX, "%s:%d: %s.%s: step%u comes here; steps stand in order", s->name,
                       key->line, section, key->key, out->count + 1);
    ethd_status status = read_step(s, key, map, &out->at[out->count++]);
    if (status) return status;
  }
  return ETHD_OK;
}
