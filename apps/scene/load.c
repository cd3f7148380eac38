
#include "cli/cli.h"
#include "clock.h"
#include "scene/scene.h"
#include "settings/scene_file.h"
#include "text/text.h"

#define SCENE_BYTES_MAX ((size_t)1 << 30)

static double seconds_now(void) { return 1e-9 * (double)ethd__clock_now(); }

static char *read_text(const char *path, size_t *length) {
  char message[ETHD_MESSAGE_MAX], *text;
  ethd__need(ethd_text_read(path, SCENE_BYTES_MAX, &text, length, message), message);
  return text;
}

static _Noreturn void refuse(void (*say)(const char *, const ethd_error *, char *), const char *path,
                             const ethd_error *error) {
  char message[ETHD_MESSAGE_MAX];
  say(path, error, message);
  ethd__fail(ethd__exit_code(error->status), "%s", message);
}

ethd_scene *ethd__scene_load(const char *path, double *seconds) {
  ethd_solids *solids;
  ethd_scene *scene = ethd__world_load(path, &solids, seconds);
  if (!scene)
    ethd__fail(ETHD_EXIT_INPUT, "%s: holds solids of space; a scene of the plane is needed, ethd-scene info reads both",
               path);
  return scene;
}

/* If both readers refuse the file, the message of the one that reads farther is used. */
ethd_scene *ethd__world_load(const char *path, ethd_solids **solids, double *seconds) {
  size_t length;
  ethd_scene *scene;
  ethd_error error, other;
  ETHD__FREED char *text = read_text(path, &length);
  double start = seconds_now();
  *solids = NULL;
  if (ethd_scene_parse(text, length, &scene, &error) < 0) {
    start = seconds_now();
    const ethd_status status = ethd_solids_parse(text, length, solids, &other);
    if (status < 0 && other.line > error.line) refuse(ethd__solids_refusal, path, &other);
    if (status < 0) refuse(ethd__scene_refusal, path, &error);
  }
  *seconds = seconds_now() - start;
  return scene;
}
