
#include "record/recording_parts.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* The files of a recording, and those that programs add to its folder. */
static const char *const own[] = {ETHD_RECORDING_TICK,
                                  ETHD_RECORDING_CONFIG,
                                  ETHD_RECORDING_SCENE,
                                  ETHD_RECORDING_EVENTS,
                                  "truth.npy",
                                  "snapshot.npy",
                                  "taps.csv",
                                  "tap.csv",
                                  NULL};

bool ethd__recording_holds(const char *folder, const char *path) { return ethd__claim_holds(folder, own, path); }

/* Returns true if the configuration was read from a file that would be overwritten. */
static bool is_input(const char *folder, const ethd_config *config) {
  const char *scene = ethd__config_whole(config)->scene_path;
  bool held =
      (config->path && ethd__recording_holds(folder, config->path)) || (scene && ethd__recording_holds(folder, scene));
  for (uint32_t i = 0; !held && i < config->setting_count; i++) {
    ETHD__FREED char *path = ethd__path_join(config->folder, config->settings[i].value);
    held = path && ethd__recording_holds(folder, path);
  }
  return held;
}

static ethd_status remove_earlier(const char *folder, char *message) {
  ETHD__FREED char *ticks = ethd__path_join(folder, ETHD_RECORDING_TICK);
  bool is_recording = ticks && ethd__file_taken(ticks);
  if (!is_recording)
    return ethd__say(message, ETHD_E_ARGUMENT,
                     "%s: holds files named like those of a recording, but no recording; nothing is replaced", folder);
  return ethd__claim_empty(folder, own, message);
}

ethd_status ethd__recording_claim(const char *folder, const ethd_config *config, bool replace, ethd__claim *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  char unsaid[ETHD_MESSAGE_MAX];
  if (is_input(folder, config))
    return ethd__say(message, ETHD_E_ARGUMENT,
                     "%s: the recorded input comes from this folder; another folder is needed", folder);
  ethd_status status = ethd__claim_folder(folder, own, false, out, message);
  if (!status || !replace) return status;
  status = ethd__claim_folder(folder, own, true, out, unsaid);
  if (status) return status;
  return remove_earlier(folder, message);
}
