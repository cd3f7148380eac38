#include <stdlib.h>

#include "cli/cli.h"
#include "clock.h"
#include "scene/scene.h"
#include "settings/scene_file.h"
#include "text/text.h"

#define SCENE_BYTES_MAX ((size_t)1 << 30)

ethd_scene *ethd__scene_load(const char *path, double *seconds) {
  char message[ETHD_MESSAGE_MAX], *text;
  size_t length;
  ethd_scene *scene;
  ethd_error error;
  ethd_status status = ethd_text_read(path, SCENE_BYTES_MAX, &text, &length, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  double start = 1e-9 * (double)ethd__clock_now();
  status = ethd_scene_parse(text, length, &scene, &error);
  *seconds = 1e-9 * (double)ethd__clock_now() - start;
  free(text);
  if (status >= 0) return scene;
  ethd__scene_refusal(path, &error, message);
  ethd__fail(ethd__exit_code(status), "%s", message);
}
