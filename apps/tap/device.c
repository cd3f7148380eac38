#include "tap/device.h"

#include <string.h>

#include "settings/config_parts.h"
#include "sim/settings.h"
#include "text/error_text.h"

static ethd_status check_driver(const ethd_config *config, char *message) {
  char quote[ETHD_QUOTE_MAX];
  const ethd_ini_key *key = ethd_ini_find(&ethd__config_whole(config)->ini, "device", "driver");
  if (!key || !strcmp(key->value, ethd_driver_sim.id)) return ETHD_OK;
  return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: device.driver: found %s, sim is allowed", config->path, key->line,
                   ethd__quote(key->value, strlen(key->value), quote));
}

ethd_status ethd__device_read(const ethd_config *config, ethd__sim_settings *out, char message[ETHD_MESSAGE_MAX]) {
  const ethd_device_def def = {
      &config->setup, config->settings, config->setting_count, config->folder, config->path, 1, NULL};
  ethd_status status = check_driver(config, message);
  if (status) return status;
  return status ? status : ethd__sim_settings_read(&def, out, message);
}
