#include "tap/load.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
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

/* "n" and ".ini" to the file that came with the programs; "my/dev", "my/dev.plant" to my/dev.ini. */
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

/* A configuration without a scene gets the paper's wall, as if it named it. */
static ethd_config *with_wall(ethd_config *config, const char *path) {
  char message[ETHD_MESSAGE_MAX], *wall = ethd__data_path("wall.scene"), *absolute = realpath(wall, NULL);
  char *scene =
      joined(config->text && *config->text ? "\n[scene]\nfile = " : "[scene]\nfile = ", absolute ? absolute : wall);
  char *text = joined(config->text ? config->text : "", scene);
  ethd_config *walled;
  check(ethd_config_parse(text, strlen(text), path, config->folder, &walled, message), message);
  ethd_config_free(config);
  free(text);
  free(scene);
  free(absolute);
  free(wall);
  return walled;
}

static void load_config(const char *config, const char *plant, bool plugins, ethd__loaded *out) {
  char message[ETHD_MESSAGE_MAX];
  out->path = config ? had(strdup(config)) : beside_plant(plant ? plant : ETHD__PLANT, ".ini");
  if (!config && access(out->path, F_OK))
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: %s; it is the configuration of the plant \"%s\": put it there, or name another one; q, n, b and "
               "p came with theirs",
               out->path, strerror(errno), plant);
  check((plugins ? ethd_config_load : ethd_config_load_received)(out->path, &out->config, message), message);
  if (!out->config->scene) out->config = with_wall(out->config, out->path);
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
