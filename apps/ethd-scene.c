/* Describes a scene, measures distances to it, and converts drawings to scenes. */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "scene/scene.h"

static const char doc[] =
    "Describes a scene, calculates signed distances of points to it, or makes a scene from a drawing.\v"
    "query: IN needs the columns x_m,y_m; OUT gets distance_m,nx,ny,object, a row per point: the smallest signed "
    "distance over the objects, the normal into that object there, and the object's number in the file. Objects out of "
    "the arm's reach count too.\n"
    "info: counts, extent, build time, memory, and objects out of the arm's reach. A picture shows the objects, the "
    "boxes of the tree by depth, and the arm's reach. Solids of space are described too.\n"
    "convert: IN is a drawing (.svg or .dxf) or a scene (.scene), OUT a scene. A filled shape becomes a solid, a "
    "filled shape with holes becomes walls, and a shape with a stroke alone becomes a thin wall, whatever its width. "
    "Text, images and other content that a scene can't hold are left out and counted. y points up. Python, librsvg and "
    "ezdxf read the drawings.\n\n"
    "Example:\n"
    "  ethd-scene query --scene walls.scene --in points.csv --out distances.csv\n"
    "  ethd-scene info walls.scene --plot walls.png\n"
    "  ethd-scene convert --in drawing.svg --out walls.scene --origin 0.1,0.2\n\n"
    "A line of a scene is one of:";

static const struct argp_option options[] = {
    {"scene", 's', "F", 0, "query: the scene", 0},
    {"in", 'i', "IN", 0, "query: points; convert: .svg, .dxf or .scene", 0},
    {"out", 'o', "OUT", 0, "query: distances; convert: the scene", 0},
    {"config", 'c', "C.ini", 0, "info: configuration with the arm and the ring (default: built in)", 0},
    {"plot", 'p', "OUT.png", 0,
     "info: draw a picture, and keep its data in OUT.csv; convert: draw drawing and scene side by side", 0},
    {"tolerance", 't', "M", 0, "convert: largest distance of an edge from its curve, m (default: 1e-5)", 0},
    {"scale", 'l', "M", 0, "convert: SVG: m per user unit (default: by width, height and viewBox, 96 px an inch)", 0},
    {"units", 'u', "m|cm|mm|in|ft", 0, "convert: DXF: unit of the drawing, if the file has none", 0},
    {"origin", 'O', "X,Y", 0, "convert: position of the page's lower left corner, or of DXF's origin, m (default: 0,0)",
     0},
    {"page", 'g', "solid|background", 0, "convert: a filled shape that covers the page is a solid or a background", 0},
    {0},
};

static ethd__scene_args arg;

static const struct {
  const char *name;
  int (*run)(const ethd__scene_args *);
} commands[] = {{"query", ethd__scene_query}, {"info", ethd__scene_info}, {"convert", ethd__scene_convert}};
enum { QUERY, INFO, CONVERT, COMMANDS };

static int command_of(const char *word) {
  int i = 0;
  while (i < COMMANDS && word && strcmp(commands[i].name, word) != 0) i++;
  return word ? i : COMMANDS;
}

static void check_usage(struct argp_state *state) {
  int command = command_of(arg.command);
  if (command == COMMANDS) argp_error(state, "what to do: query, info or convert");
  if (command == QUERY && (!arg.scene || !arg.in || !arg.out)) argp_error(state, "query needs --scene, --in and --out");
  if (command == INFO && !arg.scene) argp_error(state, "info needs a scene file");
  if (command == CONVERT && (!arg.in || !arg.out)) argp_error(state, "convert needs --in and --out");
  if (command == INFO && (arg.in || arg.out)) argp_error(state, "--in and --out are for query and convert");
  if (command == CONVERT && arg.scene) argp_error(state, "--scene is for query");
  if (command != INFO && arg.config) argp_error(state, "--config is for info");
  if (command == QUERY && arg.plot) argp_error(state, "--plot is for info and convert");
  if (command == INFO && arg.plot) (void)ethd__option_picture("--plot", arg.plot);
  if (command == INFO && arg.for_drawings)
    argp_error(state, "--tolerance, --scale, --units, --origin and --page are for convert");
}

static void take_word(const char *word, struct argp_state *state) {
  if (!arg.command) {
    if (command_of(word) == COMMANDS) argp_error(state, "\"%s\": unknown; query, info or convert is allowed", word);
    arg.command = word;
  } else if (command_of(arg.command) == INFO && !arg.scene) {
    arg.scene = word;
  } else {
    argp_error(state, "\"%s\": no such argument", word);
  }
}

static bool is_one_of(const char *keys, int key) { return key > ' ' && key < 128 && strchr(keys, key); }

/* Keeps an option for the program that reads drawings. */
static void keep(int key, const char *text) {
  const struct argp_option *o = options;
  while (o->key != key) o++;
  if (arg.drawing_count == ETHD__DRAWING_OPTIONS) ethd__fail(ETHD_EXIT_INPUT, "--%s: too many options", o->name);
  if (asprintf(&arg.drawing[arg.drawing_count++], "--%s=%s", o->name, text) < 0) ethd__fail_memory();
}

static error_t parse(int key, char *text, struct argp_state *state) {
  if (is_one_of("iotluOgp", key)) keep(key, text);
  arg.for_drawings |= is_one_of("tluOg", key);
  switch (key) {
  case 's': arg.scene = text; return 0;
  case 'i': arg.in = text; return 0;
  case 'o': arg.out = text; return 0;
  case 'c': arg.config = text; return 0;
  case 'p': arg.plot = text; return 0;
  case 't':
  case 'l':
  case 'u':
  case 'O':
  case 'g': return 0;
  case ARGP_KEY_ARG: take_word(text, state); return 0;
  case ARGP_KEY_END: check_usage(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* The help's last lines come from the library's shapes. */
static char *help(int key, const char *text, void *input) {
  (void)input;
  if (key != ARGP_KEY_HELP_POST_DOC || !text) return (char *)(uintptr_t)text;
  ethd__printed out;
  FILE *to = ethd__print_begin(&out);
  fputs(text, to);
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++)
    fprintf(to, "\n  %s %s [material=NAME]", ethd_shape_name((ethd_shape)i), ethd_shape_form((ethd_shape)i));
  fputs("\n  material NAME [KEY=NUMBER...]", to);
  return ethd__print_end(&out);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "query\ninfo F\nconvert", doc, NULL, help, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__catch_interrupt();
  return ethd__end(commands[command_of(arg.command)].run(&arg));
}
