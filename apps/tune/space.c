#include "tune/space.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bounds/loops.h"
#include "sim/random.h"
#include "text/error_text.h"
#include "text/text.h"

static const struct {
  const char *name;
  double low, high;
} known[] = {
#define ROW(name, low, high, buys) {name, low, high},
    ETHD_TUNE_KNOWN(ROW)
#undef ROW
};

#define KNOWN (sizeof known / sizeof *known)

const char *ethd__space_text(double value, char out[ETHD_TUNE_VALUE_MAX]) {
  snprintf(out, ETHD_TUNE_VALUE_MAX, "%.4g", value);
  return out;
}

static double rounded(double value) {
  char text[ETHD_TUNE_VALUE_MAX];
  return strtod(ethd__space_text(value, text), NULL);
}

/* ---- making it ---- */

/* Every point would keep a margin that can't be computed. */
static ethd_status refuse_unjudged(const ethd_setup *setup, char *message) {
  for (int kind = 0; kind < ETHD_LOOP_KINDS; kind++) {
    const ethd_law *law = ethd__bounds_unjudged(setup, (ethd__bounds_kind)kind);
    if (law)
      return ethd__say(message, ETHD_E_ARGUMENT,
                       "%s: the law %s doesn't name its gains, so no margin of it can be kept",
                       ethd__bounds_names[kind], law->id);
  }
  return ETHD_OK;
}

static ethd_status base_setup(const ethd__tune_space *s, ethd_setup *out, char *message) {
  *out = s->config->setup;
  return ethd_config_transition(s->config, s->law, out, message);
}

ethd_status ethd__space_open(const ethd_config *config, const char *law, ethd__tune_space *out,
                             char message[ETHD_MESSAGE_MAX]) {
  ethd_setup setup;
  *out = (ethd__tune_space){.config = config, .law = law};
  ethd_status status = base_setup(out, &setup, message);
  if (!status) status = refuse_unjudged(&setup, message);
  if (status) return status;
  for (size_t i = 0; i < KNOWN; i++) {
    double own = ethd_setup_get(&setup, known[i].name);
    if (!(own > 0 && isfinite(own))) continue;
    ethd__tune_key *key = &out->keys[out->count++];
    snprintf(key->name, sizeof key->name, "%s", known[i].name);
    key->own = own;
    key->low = rounded(own * known[i].low);
    key->high = rounded(own * known[i].high);
  }
  if (out->count) return ETHD_OK;
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: nothing to tune: its laws have no gains that ethd-tune knows",
                   config->path ? config->path : "the configuration");
}

void ethd__space_lower(ethd__tune_space *s, const char *name, double share) {
  for (size_t i = 0; i < s->count; i++)
    if (!strcmp(s->keys[i].name, name)) {
      s->keys[i].low = rounded(s->keys[i].own * share);
      s->keys[i].high = rounded(s->keys[i].own);
    }
}

/* ---- ranges by hand ---- */

static bool takes(const ethd__tune_space *s, const char *name, double value, ethd_setup *setup, char *message) {
  char text[ETHD_TUNE_VALUE_MAX];
  return !ethd_config_set(s->config, name, ethd__space_text(value, text), setup, message);
}

static ethd__tune_key *key_of(ethd__tune_space *s, const char *name) {
  for (size_t i = 0; i < s->count; i++)
    if (!strcmp(s->keys[i].name, name)) return &s->keys[i];
  return s->count < ETHD_TUNE_KEYS_MAX ? &s->keys[s->count++] : NULL;
}

static ethd_status bad_range(const char *text, char *message) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(message, ETHD_E_SYNTAX, "--range: found %s, section.key=LOW:HIGH or section.key=VALUE is allowed",
                   ethd__quote(text, strlen(text), quote));
}

/* LOW:HIGH, or one value for both. */
static bool read_range(const char *text, double *low, double *high) {
  const char *colon = strchr(text, ':');
  if (!ethd__number(text, colon ? (size_t)(colon - text) : strlen(text), low)) return false;
  *high = *low;
  return (!colon || ethd__number(colon + 1, strlen(colon + 1), high)) && *low > 0 && *high >= *low && isfinite(*high);
}

ethd_status ethd__space_range(ethd__tune_space *s, const char *text, char message[ETHD_MESSAGE_MAX]) {
  char name[ETHD_TUNE_KEY_MAX];
  const char *equals = strchr(text, '=');
  double low, high;
  ethd_setup setup;
  if (!equals || equals == text || (size_t)(equals - text) >= sizeof name || !read_range(equals + 1, &low, &high))
    return bad_range(text, message);
  snprintf(name, sizeof name, "%.*s", (int)(equals - text), text);
  ethd_status status = base_setup(s, &setup, message);
  if (status) return status;
  double own = ethd_setup_get(&setup, name);
  if (!takes(s, name, low, &setup, message) || !takes(s, name, high, &setup, message)) return ETHD_E_RANGE;
  if (!(own > 0)) return ethd__say(message, ETHD_E_RANGE, "--range: %s isn't a positive number here", name);
  ethd__tune_key *key = key_of(s, name);
  if (!key) return ethd__say(message, ETHD_E_RANGE, "--range: at most %d keys are allowed", ETHD_TUNE_KEYS_MAX);
  memcpy(key->name, name, sizeof name);
  key->own = own;
  key->low = rounded(low);
  key->high = rounded(high);
  return ETHD_OK;
}

/* ---- points ---- */

ethd__tune_point ethd__space_own(const ethd__tune_space *s) {
  ethd__tune_point p = {{0}};
  for (size_t k = 0; k < s->count; k++) p.value[k] = s->keys[k].own;
  return p;
}

static double within(const ethd__tune_key *key, double share) {
  return rounded(key->low * exp(share * log(key->high / key->low)));
}

/* Finds the root above 1 of x^(d+1) = x + 1 as a fixed point. */
static double root(size_t d) {
  double x = 1.5;
  for (int i = 0; i < 60; i++) x = pow(1 + x, 1 / (double)(d + 1));
  return x;
}

ethd__tune_point ethd__space_at(const ethd__tune_space *s, uint64_t i) {
  ethd__tune_point p = {{0}};
  double step = 1, base = 1 / root(s->count);
  for (size_t k = 0; k < s->count; k++) {
    double turns = 0.5 + (double)(i + 1) * (step *= base);
    p.value[k] = within(&s->keys[k], turns - floor(turns));
  }
  return p;
}

ethd__tune_point ethd__space_near(const ethd__tune_space *s, const ethd__tune_point *about, double spread,
                                  uint64_t number) {
  ethd__tune_point p = {{0}};
  const ethd__sim_key random = {.seed = 0, .tap = number};
  for (size_t k = 0; k < s->count; k++) {
    const ethd__tune_key *key = &s->keys[k];
    double range = log(key->high / key->low);
    double share = range > 0 ? log(about->value[k] / key->low) / range : 0;
    share += spread * (2 * ethd__uniform(random, ETHD__STREAM_SPEED, (uint32_t)k) - 1);
    p.value[k] = within(key, fmin(1, fmax(0, share)));
  }
  return p;
}

/* ---- setups ---- */

void ethd__space_gains(const ethd__tune_space *s, const ethd__tune_point *p, ethd__tune_gains *out) {
  for (size_t k = 0; k < s->count; k++)
    out->gains[k] = (ethd__gain){s->keys[k].name, ethd__space_text(p->value[k], out->text[k])};
}

ethd_status ethd__space_setup(const ethd__tune_space *s, const ethd__tune_point *p, ethd_setup *out,
                              char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = base_setup(s, out, message);
  for (size_t k = 0; !status && k < s->count; k++)
    if (!takes(s, s->keys[k].name, p->value[k], out, message)) status = ETHD_E_RANGE;
  return status;
}
