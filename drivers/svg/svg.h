/* Drawings as scenes: a strict part of SVG, nothing guessed.

     taken     path (M L H V C S Q T A Z), rect, circle, ellipse, line, polyline, polygon, in svg and g;
               transform: matrix, translate, scale, rotate; fill and display, as attribute or in style
     skipped   title, desc, metadata, defs, other namespaces; what is hidden; what has no length
     refused   all else, with its line: text, image, use, style sheets, clip-path, mask, nested svg, ...

   What is filled and closed is solid, all else is a thin wall: open paths, lines, polylines, and closed ones
   with fill="none". Walls have no width, whatever the stroke's. Holes are refused: objects have none.
   y points up in a scene and down in a drawing: it is turned over, and the page's lower left corner goes to
   the origin. Curves become edges at most `tolerance` away; points nearer than 1e-9 m are one. */
#ifndef ETHD_FILE_SVG_H
#define ETHD_FILE_SVG_H

#include "ethd/config.h"

typedef struct ethd_svg_options {
  double tolerance; /* m, > 0 */
  double scale;     /* m per user unit; NaN: as width, height and viewBox say, 96 px an inch */
  ethd_vec origin;  /* m: of the page's lower left corner */
} ethd_svg_options;

typedef struct ethd_svg_notes {
  double scale;         /* m per user unit */
  double width, height; /* of the page, m; NaN: the drawing doesn't say */
  size_t skipped;       /* elements, with all that they hold counted as one */
  size_t blank;         /* paths and shapes without length */
} ethd_svg_notes;

/* `name` stands for the file in the message. [main] */
ETHD_MUST_CHECK ethd_status ethd_svg_parse(const char *text, size_t length, const char *name,
                                           const ethd_svg_options *options, ethd_scene **out, ethd_svg_notes *notes,
                                           char message[ETHD_MESSAGE_MAX]);

#endif
