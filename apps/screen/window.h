/* A window on pixels of SDL2's: shapes, text, keys, the pointer, 60 frames a second. A frame is a list of shapes;
   those equal to the frame before keep their pixels, so a text is set once and only differences are drawn and
   sent. All [main]. */
#ifndef ETHD__APPS_SCREEN_WINDOW_H
#define ETHD__APPS_SCREEN_WINDOW_H

#include <SDL2/SDL.h>
#include <SDL2/SDL_ttf.h>
#include <stdbool.h>

#include "ethd/config.h"
#include "ethd/loop.h"

#define ETHD_SHAPES_MAX 64 /* of a frame; further ones aren't drawn */

enum { ETHD_TEXT_SMALL, ETHD_TEXT_LARGE, ETHD_TEXTS };

typedef struct ethd__window_shape {
  int kind, size;             /* size: of a text, ETHD_TEXT_SMALL .. */
  double x, y, width, height; /* px, as requested; width: a disc's radius */
  SDL_Color colour;
  char text[256];
  SDL_Rect at;          /* px that it may touch */
  SDL_Surface *picture; /* of a text, a disc */
} ethd__window_shape;

typedef struct ethd__window {
  SDL_Window *window;
  TTF_Font *font[ETHD_TEXTS];
  int width, height;                     /* px */
  double shrink;                         /* factor of text size, for a page with too much text */
  uint64_t fitted;                       /* the page of this choice, see page.h */
  double pointer[2];                     /* px */
  void (*moved)(void *user, int64_t ns); /* each motion of the pointer as it comes, between frames too; NULL: nobody */
  void *mover;
  int key;        /* SDLK_* pressed since the last frame, 0: none */
  char typed[64]; /* text that was typed since then */
  bool closed, resized;
  bool covered;          /* the window's contents may be lost */
  uint64_t begun;        /* of the present frame, in SDL's performance counts */
  uint64_t due;          /* due time of the next one */
  ethd_histogram frames; /* ns from a frame's begin to its end on the screen, of frames with a change */
  ethd__window_shape shape[ETHD_SHAPES_MAX];
  size_t shape_count, shape_before; /* of this frame so far, of the one before */
  SDL_Rect changed[ETHD_SHAPES_MAX];
  size_t changed_count;
} ethd__window;

/* Opens a window. Without a display or a font the message names in one line the missing part. */
ETHD_MUST_CHECK ethd_status ethd__window_open(ethd__window *window, const char *title, int width, int height,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__window_close(ethd__window *window);

/* Sets the factor of text size from here on: 1 is the size for the window's height, 0.3 the least. */
void ethd__window_shrink(ethd__window *window, double factor);

/* Waits until a frame is due, reads keys and pointer, and begins with black. */
void ethd__window_begin(ethd__window *window);

/* Shows the frame. */
void ethd__window_end(ethd__window *window);

void ethd__window_box(ethd__window *window, double x, double y, double width, double height, SDL_Color colour);
void ethd__window_disc(ethd__window *window, double x, double y, double radius, SDL_Color colour);

/* Adds a text, centred at x with its top at y, broken into lines if the window is too narrow; an empty text adds
   nothing. */
void ethd__window_text(ethd__window *window, int size, double x, double y, const char *text, SDL_Color colour);

/* Ends the list: draws the changes since the last one, or everything if it was covered; their boxes are then
   in window->changed. */
void ethd__window_draw(ethd__window *window, SDL_Surface *onto);

/* Forgets all shapes; the next frame is drawn as a whole. */
void ethd__window_forget(ethd__window *window);

#endif
