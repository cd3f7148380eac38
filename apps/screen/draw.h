/* What all pages of the study's screen show. All [main]. */
#ifndef ETHD_SCREEN_DRAW_H
#define ETHD_SCREEN_DRAW_H

#include "screen/screen.h"

extern const SDL_Color ethd__white, ethd__grey, ethd__green, ethd__red;

/* The walls, the start line, and the finger at x, kept within the free space. seconds < 0: no speed cue; else
   it runs from the start to the wall as fast as asked for. */
void ethd__draw_room(ethd__screen *screen, ethd_vec x, double seconds);

/* Title above, two lines below. */
void ethd__draw_words(ethd__screen *screen, const char *line, SDL_Color colour, const char *keys);

/* The finger's centre, m: the device's, or the pointer. */
ethd_vec ethd__draw_finger(const ethd__screen *screen);

/* Fits the free space into the window. */
void ethd__draw_fit(ethd__screen *screen);

#endif
