/* Where things are drawn: metres of R_0 and pixels of the window, the free space and what may not leave it.

      +=====================+   thick green contour: four walls
      |                     |
      |  <--      o    |    |   the finger's circle; the start line
      |                     |
      +=====================+                                           All [any], pure. */
#ifndef ETHD__APPS_SCREEN_VIEW_H
#define ETHD__APPS_SCREEN_VIEW_H

#include "ethd/maths.h"

typedef struct ethd__room {
  int width, height;               /* px of the window */
  double scale;                    /* px/m */
  double left, right, bottom, top; /* m: free space */
  double start;                    /* m: x of the start line, where the finger's centre waits */
  double finger;                   /* m: radius of the circle */
} ethd__room;

/* Returns a room with the wall at x = wall on the left and the start at x = start on its right, centred on y. */
ethd__room ethd__room_of(double wall, double start, double y, double finger, int width, int height);

/* Return where a point is drawn, px, y down; which point a pixel is. */
ethd_vec ethd__room_pixel(const ethd__room *frame, ethd_vec x);
ethd_vec ethd__room_point(const ethd__room *frame, double px, double py);

/* Returns the circle's centre for a finger at x, which never leaves the free space, wherever finger and ring go. */
ethd_vec ethd__room_avatar(const ethd__room *frame, ethd_vec x);

#endif
