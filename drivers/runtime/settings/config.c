#include "ethd/config.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "settings/config_parts.h"
#include "settings/scene_file.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define SCENE_BYTES_MAX ((size_t)256 << 20)

typedef struct config_reading {
  ethd__config *whole;
  bool received;    /* the file comes from another person */
  const char *name; /* of the file */
  char *message;
} config_reading;

static ethd_status no_memory(const config_reading *r) { return ethd__no_memory(r->message, r->name); }

/* ---- the scene ---- */

static ethd_status parse_scene(ethd__config *whole, size_t length, char message[ETHD_MESSAGE_MAX]) {
  ethd_config *c = &whole->config;
  ethd_error error;
  const char *zero = memchr(c->scene_text, 0, length);
  if (zero) {
    int line = 1;
    for (const char *p = c->scene_text; p < zero; p++) line += *p == '\n';
    return ethd__say(message, ETHD_E_SYNTAX, "%s:%d: a byte 0: this isn't text", whole->scene_path, line);
  }
  ethd_status status = c->is_space ? ethd_solids_parse(c->scene_text, length, &c->solids, &error)
                                   : ethd_scene_parse(c->scene_text, length, &c->scene, &error);
  if (status) (c->is_space ? ethd__solids_refusal : ethd__scene_refusal)(whole->scene_path, &error, message);
  c->setup.scene = c->scene;
  return status;
}

ethd_status ethd__config_scene(ethd__config *whole, const ethd__key *key) {
  ethd_config *c = &whole->config;
  char what[ETHD_MESSAGE_MAX];
  size_t length;
  if (whole->received && *key->value == '/')
    return ethd__key_refuse(key, ETHD_E_FILE, "%s leads out of the folder; a file in it is needed", key->value);
  whole->scene_path = ethd__path_join(c->folder, key->value);
  if (!whole->scene_path) return ethd__no_memory(key->message, key->file);
  ethd_status status = ethd_text_read(whole->scene_path, SCENE_BYTES_MAX, &c->scene_text, &length, what);
  if (status) return ethd__key_refuse(key, status, "%s", what);
  return parse_scene(whole, length, key->message);
}

/* ---- keys together ---- */

static const ethd_ini_key *find_key(const config_reading *r, const char *name) {
  char section[64];
  const char *dot = strchr(name, '.');
  if (!dot || (size_t)(dot - name) >= sizeof section) return NULL;
  memcpy(section, name, (size_t)(dot - name));
  section[dot - name] = 0;
  return ethd_ini_find(&r->whole->ini, section, dot + 1);
}

/* Finds the key that causes a failure. A default fails only because of another key of the file. */
static const ethd_ini_key *find_cause(const config_reading *r, const char *name) {
  static const char *const by[][2] = {
      {"finger.radius", "ring.radius"},        {"finger.radius_max", "ring.radius"},
      {"space.finger_radius", "space.radius"}, {"space.finger_radius_max", "space.radius"},
      {"space.x_max", "space.x_min"},          {"space.y_max", "space.y_min"},
      {"space.z_max", "space.z_min"}};
  for (size_t i = 0; i < sizeof by / sizeof *by; i++)
    if (!strcmp(by[i][0], name)) return find_key(r, by[i][1]);
  return NULL;
}

/* Checks the setup. A failure's name is "section.key", or "material.NAME.key" with a line of the scene. */
static ethd_status check_setup(const config_reading *r) {
  ethd_error error;
  char what[ETHD_MESSAGE_MAX];
  ethd_config *c = &r->whole->config;
  void *setup = c->is_space ? (void *)&c->space : &c->setup;
  ethd_status status = ethd__config_check(c, ethd__front_of(c), setup, &error);
  if (!status) return ETHD_OK;
  bool material = strncmp(error.name, "material.", 9) == 0;
  const ethd_ini_key *own = material ? NULL : find_key(r, error.name), *cause = own ? NULL : find_cause(r, error.name);
  if (own || cause) error.line = own ? own->line : cause->line;
  ethd_error_text(material ? r->whole->scene_path : r->name, &error, what);
  if (!cause) return ethd__say(r->message, status, "%s", what);
  return ethd__say(r->message, status, "%s, by %s.%s = %s", what, cause->section, cause->key, cause->value);
}

/* Returns the longest range of all transition laws, since a swap may choose any of them. */
static double widest_range(const ethd_config *c) {
  double range = ethd_setup_range(&c->setup);
  for (const ethd_law *const *law = c->laws; *law; law++) {
    ethd_setup setup = c->setup;
    if ((*law)->kind != ETHD_TRANSITION) continue;
    ethd_setup_transition(&setup, (const ethd_transition_law *)(const void *)*law);
    range = fmax(range, ethd_setup_range(&setup));
  }
  return range;
}

/* Drops the parts of the scene that this arm's ring can never meet. */
static ethd_status drop_unreachable(const config_reading *r) {
  ethd_config *c = &r->whole->config;
  ethd_scene *pruned = NULL;
  ethd_error error;
  if (!c->scene) return ETHD_OK;
  ethd_status status = ethd_scene_prune(c->scene, &c->setup.arm, widest_range(c), &pruned, &error);
  if (status) ethd_error_text(r->whole->scene_path, &error, r->message);
  if (!pruned) return status;
  ethd_scene_destroy(c->scene);
  c->setup.scene = c->scene = pruned;
  return ETHD_OK;
}

/* Returns the section that makes the configuration one of space. */
static const ethd_ini_section *find_space(const ethd_ini *ini) {
  for (uint32_t i = 0; i < ini->section_count; i++)
    if (strcmp(ini->sections[i].name, "space") == 0) return &ini->sections[i];
  return NULL;
}

static ethd_status read_keys(const config_reading *r) {
  const ethd_ini *ini = &r->whole->ini;
  const ethd_ini_section *space = find_space(ini);
  ethd_status status = ETHD_OK;
  r->whole->config.is_space = space != NULL;
  for (uint32_t i = 0; !status && i < ini->section_count; i++)
    status = ethd__config_section_known(&ini->sections[i], space, r->name, r->message);
  for (int pass = 0; pass < ETHD__PASSES; pass++)
    for (uint32_t i = 0; !status && i < ini->count; i++) {
      const ethd_ini_key *k = &ini->keys[i];
      const ethd__key key = {r->name, k->line, k->section, k->key, k->value, r->message};
      status = ethd__config_read(r->whole, &key, (ethd__pass)pass);
    }
  if (!status) status = check_setup(r);
  return status ? status : drop_unreachable(r);
}

/* ---- whole configurations ---- */

static const ethd_law **copy_laws(void) {
  size_t n = 0;
  while (ethd_laws[n]) n++;
  const ethd_law **laws = malloc((n + 1) * sizeof *laws);
  if (laws) memcpy(laws, ethd_laws, (n + 1) * sizeof *laws);
  return laws;
}

static char *copy_text(const char *text, size_t length) {
  char *copy = malloc(length + 1);
  if (!copy) return NULL;
  if (length) memcpy(copy, text, length);
  copy[length] = 0;
  return copy;
}

static bool fill(ethd_config *c, const char *text, size_t length, const char *name, const char *folder) {
  c->setup = ethd_setup_default();
  c->space = ethd_space_setup_default();
  strcpy(c->device, "sim");
  c->path = name ? strdup(name) : NULL;
  c->text = copy_text(text, length);
  c->folder = strdup(folder ? folder : ".");
  c->settings = calloc(ETHD_INI_KEYS_MAX, sizeof *c->settings);
  c->laws = copy_laws();
  return (!name || c->path) && c->text && c->folder && c->settings && c->laws;
}

static ethd_status parse(config_reading r, const ethd_config_source *s, ethd_config **out) {
  r.whole = calloc(1, sizeof *r.whole);
  if (!r.whole) return no_memory(&r);
  r.whole->received = r.received;
  ethd_status status = fill(&r.whole->config, s->text, s->length, s->path, s->folder) ? ETHD_OK : no_memory(&r);
  if (!status) status = ethd_ini_parse(s->text, s->length, r.name, "plugins.file", NULL, &r.whole->ini, r.message);
  if (!status) status = read_keys(&r);
  if (status)
    ethd_config_free(&r.whole->config);
  else
    *out = &r.whole->config;
  return status;
}

static ethd_status load(config_reading r, ethd_config_source s, ethd_config **out) {
  ETHD__FREED char *text = NULL;
  ethd_status status = ethd_text_read(s.path, ETHD_INI_BYTES_MAX, &text, &s.length, r.message);
  if (status) return status;
  ETHD__FREED char *folder = ethd__path_folder(s.path);
  s.text = text;
  s.folder = folder;
  return folder ? parse(r, &s, out) : no_memory(&r);
}

static ethd_status check_sizes(const ethd_config_source *source, ethd_error *error) {
  const double own = sizeof(ethd_config);
  ethd_status status = ethd_sizes_check(&source->sizes, error);
  if (status || source->config == sizeof(ethd_config)) return status;
  *error = (ethd_error){ETHD_E_SIZE, 0, "ethd_config", source->config, own, own};
  return ETHD_E_SIZE;
}

ethd_status ethd_config_make(const ethd_config_source *source, ethd_config **out, char message[ETHD_MESSAGE_MAX]) {
  ethd_error error;
  *out = NULL;
  ethd_status status = check_sizes(source, &error);
  if (status) return ethd_error_text(NULL, &error, message), status;
  ethd_config_source s = *source;
  const config_reading r = {.received = s.received != 0, .name = s.path ? s.path : "configuration", .message = message};
  ETHD__FREED char *folder =
      s.path && !s.text ? ethd__path_folder(s.path) : strdup(s.folder && *s.folder ? s.folder : ".");
  ethd__received received;
  if (!folder) return no_memory(&r);
  if (r.received) ethd__received_enter(&received, folder);
  if (s.path && !s.text) {
    status = load(r, s, out);
  } else {
    if (!s.text) s.text = "";
    status = parse(r, &s, out);
  }
  if (r.received) ethd__received_leave(&received);
  return status;
}

void ethd_config_free(ethd_config *config) {
  if (!config) return;
  ethd__config *whole = (ethd__config *)config;
  ethd_scene_destroy(config->scene);
  ethd_solids_destroy(config->solids);
  for (uint32_t i = 0; i < config->plugin_count; i++) free(config->plugins[i]);
  free(config->plugins);
  free(config->laws);
  free(config->settings);
  free(config->folder);
  free(config->scene_text);
  free(config->text);
  free(config->path);
  free(whole->scene_path);
  ethd_ini_free(&whole->ini);
  free(whole);
}
