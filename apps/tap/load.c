#include "tap/load.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "settings/config_parts.h"
#include "sim/plant.h"
#include "tap/device.h"

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

static char *had(char *text) {
  if (!text) ethd__fail_memory();
  return text;
}

static char *joined(const char *a, const char *b) {
  char *text;
  return had(asprintf(&text, "%s%s", a, b) < 0 ? NULL : text);
}

static bool came_along(const char *plant) { return strlen(plant) == 1 && strchr("qnbp", *plant); }

/* "n" and ".ini" to the file installed with the programs; "my/dev", "my/dev.plant" to my/dev.ini. */
static char *beside_plant(const char *plant, const char *suffix) {
  size_t length = strlen(plant);
  if (length > 6 && !strcmp(plant + length - 6, ".plant")) length -= 6;
  char *stem = had(strndup(plant, length)), *name = joined(stem, suffix);
  free(stem);
  if (!came_along(plant)) return name;
  char *path = ethd__data_path(name);
  free(name);
  return path;
}

static void load_plant(const char *plant, bool simulated, ethd__loaded *out) {
  char message[ETHD_MESSAGE_MAX];
  ethd__sim_settings device = {.plant = NULL};
  if (simulated) check(ethd__device_read(out->config, &device, message), message);
  if (plant) {
    out->plant_path = beside_plant(plant, ".plant");
  } else {
    plant = device.plant ? device.plant->value : ETHD__PLANT;
    out->plant_path = had(ethd__plant_path(plant, out->config->folder));
  }
  out->plant_name = had(strdup(plant));
  check(ethd_plant_load(out->plant_path, &out->plant, message), message);
  if (simulated) ethd__sim_settings_finger(&device, &out->plant);
}

/* Returns the text with its line replaced by `own`; line 0: `own` after it, in a section. */
static char *with_line(const char *text, int line, const char *own) {
  char *out = NULL;
  const char *after = line ? text : text + strlen(text);
  for (int i = 1; i < line; i++) after += strcspn(after, "\n") + 1;
  int n = asprintf(&out, "%.*s%s%s%s", (int)(after - text), text, line ? "" : "\n[scene]\n", own,
                   after + strcspn(after, "\n"));
  return had(n < 0 ? NULL : out);
}

void ethd__load_scene(ethd__loaded *loaded, const char *scene) {
  ethd_config *own = loaded->config, *with;
  const ethd_ini_key *key = ethd_ini_find(&ethd__config_whole(own)->ini, "scene", "file");
  char message[ETHD_MESSAGE_MAX], *absolute = realpath(scene, NULL);
  if (!absolute) ethd__fail(ETHD_EXIT_INPUT, "%s: %s", scene, strerror(errno));
  char *value = joined("file = ", absolute), *text = with_line(own->text ? own->text : "", key ? key->line : 0, value);
  check(ethd_config_parse(text, strlen(text), loaded->path, own->folder, &with, message), message);
  ethd_config_free(own);
  loaded->config = with;
  free(text);
  free(value);
  free(absolute);
}

/* A configuration without a scene gets the paper's wall. */
static void take_wall(ethd__loaded *loaded) {
  char *wall = ethd__data_path("wall.scene");
  ethd__load_scene(loaded, wall);
  free(wall);
}

static void load_config(const char *config, const char *plant, bool plugins, ethd__loaded *out) {
  char message[ETHD_MESSAGE_MAX];
  out->path = config ? had(strdup(config)) : beside_plant(plant ? plant : ETHD__PLANT, ".ini");
  if (!config && access(out->path, F_OK))
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: %s; the plant \"%s\" needs this configuration: put it there, or name another one; q, n, b and p "
               "have theirs",
               out->path, strerror(errno), plant);
  check((plugins ? ethd_config_load : ethd_config_load_received)(out->path, &out->config, message), message);
  ethd__need_plane(out->config);
  if (!out->config->scene) take_wall(out);
}

void ethd__load(const char *config, const char *plant, bool simulated, bool plugins, ethd__loaded *out) {
  *out = (ethd__loaded){0};
  load_config(config, plant, plugins, out);
  load_plant(plant || config ? plant : ETHD__PLANT, simulated, out);
}

void ethd__loaded_free(ethd__loaded *loaded) {
  ethd_config_free(loaded->config);
  free(loaded->path);
  free(loaded->plant_name);
  free(loaded->plant_path);
  *loaded = (ethd__loaded){0};
}
