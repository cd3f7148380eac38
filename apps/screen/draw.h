/* Draws the common parts of the study's screen. All [main]. */
#ifndef ETHD__APPS_SCREEN_DRAW_H
#define ETHD__APPS_SCREEN_DRAW_H

#include "screen/screen.h"

extern const SDL_Color ethd__white, ethd__grey, ethd__green, ethd__red;

/* Draws the walls, the start line, and the finger at x, kept within the free space. The speed cue runs from the start
   to the wall at the commanded speed; seconds < 0: no cue. */
void ethd__draw_room(ethd__screen *screen, ethd_vec x, double seconds);

/* Returns the top of the words under the room, px. */
double ethd__draw_floor(const ethd__screen *screen);

/* Returns the finger's centre, m: the device's finger, or the pointer. */
ethd_vec ethd__draw_finger(const ethd__screen *screen);

/* Fits the free space into the window. */
void ethd__draw_fit(ethd__screen *screen);

#endif
