/* Converts drawings and scenes to scenes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/cli.h"
#include "scene/scene.h"
#include "settings/scene_file.h"
#include "text/text.h"

#define SVG_BYTES_MAX ((size_t)1 << 30)

static bool ends_in(const char *path, const char *end) {
  size_t n = strlen(path), m = strlen(end);
  return n > m && strcasecmp(path + n - m, end) == 0;
}

static void say_page(const ethd__scene_args *arg, const ethd_svg_notes *n) {
  printf("  1 user unit = %.9g m; y up, the page's lower left corner at %.9g, %.9g m", n->scale, arg->svg.origin.x,
         arg->svg.origin.y);
  if (isfinite(n->width) && isfinite(n->height)) printf(", its size %.9g x %.9g m", n->width, n->height);
  printf("; curves within %.3g m\n", arg->svg.tolerance);
  if (n->skipped)
    printf("  skipped: %zu element%s (hidden, title, desc, metadata, defs, other namespaces)\n", n->skipped,
           ethd__s(n->skipped));
  if (n->blank) printf("  left out: %zu without length\n", n->blank);
}

static ethd_scene *read_drawing(const ethd__scene_args *arg, ethd_svg_notes *notes) {
  char message[ETHD_MESSAGE_MAX], *text;
  size_t length;
  ethd_scene *scene = NULL;
  ethd_status status = ethd_text_read(arg->in, SVG_BYTES_MAX, &text, &length, message);
  if (!status) status = ethd_svg_parse(text, length, arg->in, &arg->svg, &scene, notes, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  free(text);
  return scene;
}

static void write_scene(const ethd_scene *scene, const char *path) {
  char message[ETHD_MESSAGE_MAX];
  ethd_replace replace;
  if (ethd_replace_begin(path, &replace, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  if (ethd_scene_print(scene, replace.file) < 0 || ethd__stop) {
    ethd_replace_abandon(&replace);
    ethd__fail(ETHD_EXIT_FAILED, "%s: not written", path);
  }
  if (ethd_replace_commit(&replace, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

int ethd__scene_convert(const ethd__scene_args *arg) {
  bool drawing = ends_in(arg->in, ".svg");
  ethd_svg_notes notes;
  ethd_scene_info info;
  double seconds;
  if (!drawing && !ends_in(arg->in, ".scene"))
    ethd__fail(ETHD_EXIT_INPUT, "--in: found \"%s\", a file .svg or .scene is needed", arg->in);
  if (!drawing && arg->svg_given)
    ethd__fail(ETHD_EXIT_INPUT, "--scale, --tolerance and --origin are for drawings, %s is none", arg->in);
  ethd_scene *scene = drawing ? read_drawing(arg, &notes) : ethd__scene_load(arg->in, &seconds);
  ethd__refuse_input("--out", arg->out, "--in", arg->in);
  write_scene(scene, arg->out);
  ethd_scene_describe(scene, &info);
  printf("%s: %zu object%s, %zu segment%s, of %s\n", arg->out, info.objects, ethd__s(info.objects), info.segments,
         ethd__s(info.segments), arg->in);
  if (drawing) say_page(arg, &notes);
  ethd_scene_destroy(scene);
  return ETHD_EXIT_DONE;
}
