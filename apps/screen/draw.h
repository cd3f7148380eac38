/* What all pages of the study's screen show. All [main]. */
#ifndef ETHD_SCREEN_DRAW_H
#define ETHD_SCREEN_DRAW_H

#include "screen/screen.h"

extern const SDL_Color ethd__white, ethd__grey, ethd__green, ethd__red;

/* The walls, the start line, and the finger at x, kept within the free space. seconds < 0: no speed cue; else
   it runs from the start to the wall as fast as asked for. */
void ethd__draw_room(ethd__screen *screen, ethd_vec x, double seconds);

/* Where words may begin under the room, px. */
double ethd__draw_floor(const ethd__screen *screen);

/* The finger's centre, m: the device's, or the pointer. */
ethd_vec ethd__draw_finger(const ethd__screen *screen);

/* Fits the free space into the window. */
void ethd__draw_fit(ethd__screen *screen);

#endif
