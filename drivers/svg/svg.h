/* Makes scenes from drawings. A part of SVG is supported, and nothing is guessed:

     supported   path (M L H V C S Q T A Z), rect, circle, ellipse, line, polyline, polygon, in svg and g;
                 transform: matrix, translate, scale, rotate; fill and display, as attribute or in style
     skipped     title, desc, metadata, defs, other namespaces; what is hidden; what has no length
     refused     all else, with its line: text, image, use, style sheets, clip-path, mask, nested svg, ...

   A shape that is filled and closed is solid. All else is a thin wall: open paths, lines, polylines, and closed shapes
   with fill="none". Walls have no width, whatever the stroke's width is. Holes are refused, since objects have none.
   y points up in a scene and down in a drawing, so drawings are turned over; the page's lower left corner goes to
   the origin. Curves become edges at most `tolerance` away; points nearer than 1e-9 m are one. */
#ifndef ETHD__SVG_SVG_H
#define ETHD__SVG_SVG_H

#include "ethd/config.h"

typedef struct ethd_svg_options {
  double tolerance; /* m, > 0 */
  double scale;     /* m per user unit; NaN: what width, height and viewBox say, at 96 px per inch */
  ethd_vec origin;  /* m: of the page's lower left corner */
} ethd_svg_options;

typedef struct ethd_svg_notes {
  double scale;         /* m per user unit */
  double width, height; /* of the page, m; NaN: the drawing doesn't say */
  size_t skipped;       /* elements that were skipped; one with all that it holds counts once */
  size_t blank;         /* paths and shapes that have no length */
} ethd_svg_notes;

/* Parses a drawing, which the message calls `name`. [main] */
ETHD_MUST_CHECK ethd_status ethd_svg_parse(const char *text, size_t length, const char *name,
                                           const ethd_svg_options *options, ethd_scene **out, ethd_svg_notes *notes,
                                           char message[ETHD_MESSAGE_MAX]);

#endif
