/* Writes scenes in their normal form. Drawings are read by a program in Python, ethd_programs.drawing, which this one
   becomes. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "scene/scene.h"
#include "settings/scene_file.h"
#include "text/text.h"

static _Noreturn void start_reader(const ethd__scene_args *arg) {
  char *words[ETHD__DRAWING_OPTIONS + 2], *program = ethd__data_path("python/drawing");
  words[0] = program;
  memcpy(words + 1, arg->drawing, arg->drawing_count * sizeof *words);
  words[1 + arg->drawing_count] = NULL;
  fflush(NULL);
  execv(program, words);
  ethd__fail(ETHD_EXIT_FAILED,
             "%s: %s; drawings are read by Python 3 (Debian: python3-shapely python3-ezdxf librsvg2-bin)", program,
             strerror(errno));
}

static void write_scene(const ethd_scene *scene, const char *path) {
  char message[ETHD_MESSAGE_MAX];
  ethd_replace replace;
  ethd__must(ethd_replace_begin(path, &replace, message), message);
  if (ethd_scene_print(scene, replace.file) < 0 || ethd__stop) {
    ethd_replace_abandon(&replace);
    ethd__fail(ETHD_EXIT_FAILED, "%s: not written", path);
  }
  ethd__must(ethd_replace_commit(&replace, message), message);
}

int ethd__scene_convert(const ethd__scene_args *arg) {
  size_t n = strlen(arg->in);
  ethd_scene_info info;
  double seconds;
  if (n < 7 || strcmp(arg->in + n - 6, ".scene") != 0) start_reader(arg);
  if (arg->for_drawings || arg->plot)
    ethd__fail(ETHD_EXIT_INPUT,
               "--scale, --tolerance, --origin, --units, --page and --plot are for drawings, %s is none", arg->in);
  ethd_scene *scene = ethd__scene_load(arg->in, &seconds);
  ethd__refuse_input("--out", arg->out, "--in", arg->in);
  write_scene(scene, arg->out);
  ethd_scene_describe(scene, &info);
  printf("%s: %zu object%s, %zu segment%s, of %s\n", arg->out, info.objects, ethd__s(info.objects), info.segments,
         ethd__s(info.segments), arg->in);
  ethd_scene_destroy(scene);
  return ETHD_EXIT_DONE;
}
