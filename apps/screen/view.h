/* What stands where: metres of R_0 and pixels of the window, the free space and what may not leave it.

      +=====================+   thick green contour: four walls
      |                     |
      |  <--      o    |    |   the finger's circle; the start line
      |                     |
      +=====================+                                           All [any], pure. */
#ifndef ETHD_SCREEN_VIEW_H
#define ETHD_SCREEN_VIEW_H

#include "ethd/vec.h"

typedef struct ethd__room {
  int width, height;               /* px of the window */
  double scale;                    /* px/m */
  double left, right, bottom, top; /* m: free space */
  double start;                    /* m: x of the start line, where the finger's centre waits */
  double finger;                   /* m: radius of the circle */
} ethd__room;

/* The wall at x = wall on the left, the start at x = start on its right, about y = height. */
ethd__room ethd__room_of(double wall, double start, double y, double finger, int width, int height);

/* Where a point is drawn, px, y down; and back. */
ethd_vec ethd__room_pixel(const ethd__room *frame, ethd_vec x);
ethd_vec ethd__room_point(const ethd__room *frame, double px, double py);

/* The circle's centre for a finger at x: it never leaves the free space, wherever finger and ring go. */
ethd_vec ethd__room_avatar(const ethd__room *frame, ethd_vec x);

#endif
