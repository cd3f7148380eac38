/* The places of drawn objects: metres of R_0 and pixels of the window, and the free space with its contents.

      +==============+   thick green contour: the scene's walls
      |              |
      |              |
      | <--  o   |   |   the finger's circle; the start line
      |              |
      |              |
      +==============+                                                  All [any], pure. */
#ifndef ETHD__APPS_SCREEN_VIEW_H
#define ETHD__APPS_SCREEN_VIEW_H

#include <stdbool.h>

#include "ethd/maths.h"

enum { ETHD_WALL_LEFT, ETHD_WALL_RIGHT, ETHD_WALL_BOTTOM, ETHD_WALL_TOP, ETHD_WALLS };

typedef struct ethd__room {
  int width, height;               /* px of the window */
  double scale;                    /* px/m */
  double left, right, bottom, top; /* m: free space */
  ethd_vec start;                  /* m: the waiting finger's centre, on the start line */
  bool there[ETHD_WALLS];
  double finger; /* m: radius of the circle */
} ethd__room;

/* Returns a room with these walls about the start, m: x of the left and right one, y of those below and above; NaN:
   none. */
ethd__room ethd__room_of(const double wall[ETHD_WALLS], ethd_vec start, double finger, int width, int height);

/* Return a point's pixel, y down; a pixel's point. */
ethd_vec ethd__room_pixel(const ethd__room *frame, ethd_vec x);
ethd_vec ethd__room_point(const ethd__room *frame, double px, double py);

/* Returns the circle's centre for a finger at x, which always stays in the free space. */
ethd_vec ethd__room_avatar(const ethd__room *frame, ethd_vec x);

#endif
