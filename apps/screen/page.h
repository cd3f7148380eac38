/* A page of words: title above, keys below, and between them paragraphs that never overlap, in any window: where there
   is too little room for them the letters shrink. A newline ends a line. All [main]. */
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
  const char *title, *keys; /* "" where there is none */
  ethd__paragraph paragraph[ETHD_PAGE_PARAGRAPHS];
  size_t count;
  double below; /* px: paragraphs stand under this line, down at the keys; 0: in the middle of the page */
} ethd__page;

/* Adds a paragraph; an empty text, or one more than there is room for, is left out. */
void ethd__page_add(ethd__page *page, int size, const char *text, SDL_Color colour);

/* Returns how many bytes of a text, small letters in full size, have room on a page with this title and these keys: whole
   lines, at least one. */
size_t ethd__page_room(ethd__window *window, const ethd__page *page, const char *text);

/* Adds its texts to the frame's shapes. */
void ethd__page_draw(ethd__window *window, const ethd__page *page);

#endif
