#include "svg/svg.h"

#include <expat.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "svg/svg_parts.h"
#include "text/error_text.h"

#define DEPTH 64 /* elements within elements */
#define SVG "http://www.w3.org/2000/svg"
#define BETWEEN '|' /* a namespace and a name */

/* What an element inherits. */
typedef struct state {
  ethd__matrix m;
  bool filled;
} state;

typedef struct drawing {
  XML_Parser xml;
  const char *name; /* of the file */
  const ethd_svg_options *options;
  ethd_svg_notes *notes;
  char *message;
  ethd_status status;
  ethd__drawing drawing;
  state states[DEPTH];
  int depth;
  int within; /* how deep it is in an element that is skipped, counting that one; 0: in none */
} drawing;

/* Returns the line that is read. Expat 2.9 gives its number 64 bits, by another name. */
static unsigned long line_of(XML_Parser xml) {
#if XML_MAJOR_VERSION > 2 || (XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION >= 9)
  return (unsigned long)XML_GetCurrentLineNumber64(xml);
#else
  return (unsigned long)XML_GetCurrentLineNumber(xml);
#endif
}

static void refuse(drawing *r, const char *what, const char *found) {
  char quote[ETHD_QUOTE_MAX];
  if (r->status) return;
  r->status = ethd__say(r->message, ETHD_E_SYNTAX, "%s:%lu: %s%s%s", r->name, line_of(r->xml), what,
                        found ? ": found " : "", found ? ethd__quote(found, strlen(found), quote) : "");
  XML_StopParser(r->xml, XML_FALSE);
}

/* ---- the page ---- */

/* Returns a length of the page, m. */
static double page_length(drawing *r, ethd__attributes a, const char *name) {
  const char *text = ethd__svg_attribute(a, name);
  double v = NAN;
  if (!text || strcmp(text, "100%") == 0) return NAN;
  if (!ethd__svg_length(text, true, &v) || !(v > 0)) refuse(r, "the page's width and height are lengths over 0", text);
  return v;
}

static bool view_box(drawing *r, ethd__attributes a, double v[4]) {
  const char *text = ethd__svg_attribute(a, "viewBox"), *p;
  if (!text) return false;
  p = ethd__svg_space(text);
  for (int i = 0; i < 4; i++)
    if (!ethd__svg_number(&p, &v[i])) *v = NAN;
  if (*p || isnan(*v) || !(v[2] > 0 && v[3] > 0)) refuse(r, "viewBox: X Y WIDTH HEIGHT is needed", text);
  return true;
}

/* Converts user units to metres and turns y over. */
static void open_page(drawing *r, ethd__attributes a) {
  double w = page_length(r, a, "width"), h = page_length(r, a, "height");
  double v[4] = {0, 0, w / ETHD_SVG_PX, h / ETHD_SVG_PX}, scale = r->options->scale;
  bool view = view_box(r, a, v);
  double per_x = view ? w / v[2] : ETHD_SVG_PX * (w / w), per_y = view ? h / v[3] : ETHD_SVG_PX * (h / h);
  if (isnan(scale) && fabs(per_x - per_y) > 1e-3 * per_x)
    refuse(r, "width and height stretch the viewBox; --scale says how long a user unit is", NULL);
  if (isnan(scale)) scale = isnan(per_x) ? per_y : per_x;
  if (isnan(scale)) refuse(r, "no width or height says how long a user unit is; --scale does", NULL);
  *r->notes = (ethd_svg_notes){scale, scale * v[2], scale * v[3], 0, 0};
  ethd_vec o = r->options->origin;
  double low = v[1] + (isnan(v[3]) ? 0 : v[3]);
  r->states[0] = (state){{{scale, 0, 0, -scale, o.x - scale * v[0], o.y + scale * low}}, true};
}

/* ---- elements ---- */

static bool is_hidden(ethd__attributes a) {
  char v[64];
  if (ethd__svg_property(a, "display", v) && strcmp(v, "none") == 0) return true;
  return ethd__svg_property(a, "visibility", v) && (strcmp(v, "hidden") == 0 || strcmp(v, "collapse") == 0);
}

static void inherit(drawing *r, ethd__attributes a, state *s) {
  static const char *const cutters[] = {"clip-path", "mask"};
  char v[64];
  if (ethd__svg_property(a, "fill", v) && strcmp(v, "inherit") != 0)
    s->filled = strcmp(v, "none") != 0 && strcmp(v, "transparent") != 0;
  for (int i = 0; i < 2; i++)
    if (ethd__svg_property(a, cutters[i], v) && strcmp(v, "none") != 0)
      refuse(r, "clip-path and mask aren't supported", v);
  const char *transform = ethd__svg_attribute(a, "transform");
  if (transform && !ethd__svg_transform(transform, &s->m))
    refuse(r, "transform: matrix, translate, scale and rotate are supported, if they don't squeeze flat", transform);
}

static void skip(drawing *r) {
  r->within = 1;
  r->notes->skipped++;
}

static void take(drawing *r, const char *name, ethd__attributes a) {
  state s = r->states[r->depth - 1];
  ethd__svg_wrong wrong = {"", NULL};
  int which = ethd__svg_shape(name);
  if (which == ETHD_SVG_UNKNOWN) {
    refuse(r, "not supported; path, rect, circle, ellipse, line, polyline, polygon and g are", name);
  } else if (which == ETHD_SVG_SKIPPED || is_hidden(a)) {
    skip(r);
  } else if (r->depth == DEPTH) {
    refuse(r, "more than 64 elements within each other", NULL);
  } else {
    inherit(r, a, &s);
    r->states[r->depth++] = s;
    r->drawing.line = (int)line_of(r->xml);
    if (!r->status) ethd__svg_draw(which, &r->drawing, a, &s.m, s.filled, &wrong);
    if (wrong.what[0]) refuse(r, wrong.what, wrong.found);
    if (r->drawing.status == ETHD_E_FULL) refuse(r, "over 20 million points; a larger tolerance makes fewer", NULL);
  }
}

static void XMLCALL start(void *user, const char *name, const char **attributes) {
  drawing *r = user;
  const char *local = strrchr(name, BETWEEN);
  ethd__attributes a = (ethd__attributes)attributes;
  if (r->status) return;
  if (r->within) {
    r->within++;
    return;
  }
  bool ours = !local || (strncmp(name, SVG, sizeof SVG - 1) == 0 && local == name + sizeof SVG - 1);
  local = local ? local + 1 : name;
  if (r->depth) {
    if (ours)
      take(r, local, a);
    else
      skip(r);
  } else if (!ours || strcmp(local, "svg") != 0) {
    refuse(r, "a drawing must begin with svg", local);
  } else {
    open_page(r, a);
    r->depth = 1;
    inherit(r, a, &r->states[0]);
  }
}

static void XMLCALL stop(void *user, const char *name) {
  drawing *r = user;
  (void)name;
  if (r->within)
    r->within--;
  else if (r->depth)
    r->depth--;
}

static void XMLCALL entity(void *user, const char *name, int parameter, const char *value, int length, const char *base,
                           const char *system, const char *public, const char *notation) {
  (void)parameter, (void)value, (void)length, (void)base, (void)system, (void)public, (void)notation;
  refuse(user, "entities aren't supported", name);
}

/* ---- the whole ---- */

static ethd_status read_all(drawing *r, const char *text, size_t length) {
  XML_SetUserData(r->xml, r);
  XML_SetElementHandler(r->xml, start, stop);
  XML_SetEntityDeclHandler(r->xml, entity);
  bool good = XML_Parse(r->xml, text, (int)length, XML_TRUE) == XML_STATUS_OK;
  if (r->status) return r->status;
  if (r->drawing.status || XML_GetErrorCode(r->xml) == XML_ERROR_NO_MEMORY) return ethd__no_memory(r->message, r->name);
  if (good) return ETHD_OK;
  unsigned long line = line_of(r->xml);
  return ethd__say(r->message, ETHD_E_SYNTAX, "%s:%lu: no XML: %s", r->name, line,
                   XML_ErrorString(XML_GetErrorCode(r->xml)));
}

static ethd_status build(drawing *r, ethd_scene **out) {
  const ethd__drawing *d = &r->drawing;
  ethd_object_def *objects = malloc((d->object_count + 1) * sizeof *objects);
  ethd_error error;
  if (!objects) return ethd__no_memory(r->message, r->name);
  for (size_t i = 0; i < d->object_count; i++) {
    const ethd__drawn *o = &d->objects[i];
    objects[i] = (ethd_object_def){o->shape, -1, d->numbers + o->first, o->count, o->line};
  }
  ethd_scene_def def = {objects, d->object_count, NULL, 0};
  ethd_status status = ethd_scene_create(&def, out, &error);
  if (status) ethd_error_text(r->name, &error, r->message);
  free(objects);
  return status;
}

ethd_status ethd_svg_parse(const char *text, size_t length, const char *name, const ethd_svg_options *options,
                           ethd_scene **out, ethd_svg_notes *notes, char message[ETHD_MESSAGE_MAX]) {
  const char between[] = {BETWEEN, 0};
  drawing *r = calloc(1, sizeof *r);
  *out = NULL;
  *notes = (ethd_svg_notes){0};
  if (!r) return ethd__no_memory(message, name);
  r->name = name, r->options = options, r->notes = notes, r->message = message;
  r->drawing.tolerance = options->tolerance;
  r->xml = XML_ParserCreateNS(NULL, *between);
  ethd_status status = r->xml && length <= INT32_MAX ? read_all(r, text, length) : ethd__no_memory(r->message, r->name);
  notes->blank = r->drawing.blank;
  if (!status) status = build(r, out);
  if (r->xml) XML_ParserFree(r->xml);
  free(r->drawing.numbers);
  free(r->drawing.objects);
  free(r);
  return status;
}
