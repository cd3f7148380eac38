/* A window on SDL2's software renderer: shapes, text, keys, the pointer, 60 frames a second. All [main]. */
#ifndef ETHD_SCREEN_WINDOW_H
#define ETHD_SCREEN_WINDOW_H

#include <SDL2/SDL.h>
#include <SDL2/SDL_ttf.h>
#include <stdbool.h>

#include "ethd/config.h"
#include "ethd/loop.h"

enum { ETHD_TEXT_SMALL, ETHD_TEXT_LARGE, ETHD_TEXTS };

typedef struct ethd__window {
  SDL_Window *window;
  SDL_Renderer *renderer;
  TTF_Font *font[ETHD_TEXTS];
  int width, height;    /* px */
  double pointer[2];    /* px */
  int key;              /* SDLK_* pressed since the last frame, 0: none */
  char typed[64];       /* text likewise */
  bool closed;
  uint64_t begun;       /* of the present frame, in SDL's performance counts */
  uint64_t due;         /* likewise, of the next */
  ethd_histogram frames; /* ns from a frame's begin to its end on the screen */
} ethd__window;

/* Without a display, a font: one line that says what is missing. */
ETHD_MUST_CHECK ethd_status ethd__window_open(ethd__window *window, const char *title, int width, int height,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__window_close(ethd__window *window);

/* Waits until a frame is due, takes what keys and pointer did, and clears to black. */
void ethd__window_begin(ethd__window *window);

/* Shows it. */
void ethd__window_end(ethd__window *window);

void ethd__window_box(ethd__window *window, double x, double y, double width, double height, SDL_Color colour);
void ethd__window_disc(ethd__window *window, double x, double y, double radius, SDL_Color colour);

/* Centred at x, its top at y, broken into lines where the window is too narrow; nothing for an empty text. */
void ethd__window_text(ethd__window *window, int size, double x, double y, const char *text, SDL_Color colour);

#endif
