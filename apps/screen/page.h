/* A page of words: title above, keys below, and between them paragraphs that never overlap, in any window: the letters
   shrink if the room is too small. A newline ends a line. All [main]. */
#ifndef ETHD__APPS_SCREEN_PAGE_H
#define ETHD__APPS_SCREEN_PAGE_H

#include "screen/window.h"

#define ETHD_PAGE_PARAGRAPHS 16

typedef struct ethd__paragraph {
  int size; /* ETHD_TEXT_SMALL .. */
  const char *text;
  SDL_Color colour;
} ethd__paragraph;

typedef struct ethd__page {
  const char *title, *keys; /* "": none */
  ethd__paragraph paragraph[ETHD_PAGE_PARAGRAPHS];
  size_t count;
  double below; /* px: paragraphs are below this line, next to the keys; 0: in the middle of the page */
} ethd__page;

/* Adds a paragraph; an empty text, or one without room, is left out. */
void ethd__page_add(ethd__page *page, int size, const char *text, SDL_Color colour);

/* Returns the number of a text's bytes, in small letters of full size, that fit on a page with this title and keys:
   whole lines, at least one. */
size_t ethd__page_room(ethd__window *window, const ethd__page *page, const char *text);

/* Adds its texts to the frame's shapes. */
void ethd__page_draw(ethd__window *window, const ethd__page *page);

#endif
