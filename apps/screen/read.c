/* A text that people read on the screen before they tap, in pages. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "screen/draw.h"
#include "screen/screen.h"

/* Where each page of the text begins, and which one is shown. */
typedef struct reading {
  const char *text, *title, *keys;
  size_t *begin, count, now;
  int width, height; /* px of the window for which this holds */
} reading;

/* The title's and the keys' words are those that take most room. */
static ethd__page page_of(const ethd__screen *s, const reading *r, char title[256]) {
  char now[24], count[24], which[200];
  const char *values[] = {now, count};
  bool last = r->now + 1 == r->count;
  snprintf(now, sizeof now, "%zu", r->now + 1);
  snprintf(count, sizeof count, "%zu", r->count);
  ethd__phrase_fill(which, sizeof which, ethd__screen_words(s, ETHD_PHRASE_PAGE), values, 2);
  snprintf(title, 256, r->count > 1 ? "%s   %s" : "%s", r->title, which);
  return (ethd__page){.title = title, .keys = last ? r->keys : ethd__screen_words(s, ETHD_PHRASE_KEYS_PAGE)};
}

/* Divides the text again if the window's size has changed, and keeps the reader's place. */
static void divide(ethd__screen *s, reading *r) {
  const char *at = r->text;
  size_t reader = r->count ? r->begin[r->now] : 0;
  char title[256];
  if (r->width == s->window.width && r->height == s->window.height) return;
  r->width = s->window.width;
  r->height = s->window.height;
  r->count = r->now = 0;
  while (*at) {
    size_t *more = realloc(r->begin, (r->count + 2) * sizeof *more);
    if (!more) ethd__fail_memory();
    r->begin = more;
    r->begin[r->count] = (size_t)(at - r->text);
    if (r->begin[r->count] <= reader) r->now = r->count;
    r->count++;
    ethd__page page = page_of(s, &(reading){.title = r->title, .keys = r->keys, .count = 999, .now = 998}, title);
    at += ethd__page_room(&s->window, &page, at);
  }
  r->begin[r->count] = (size_t)(at - r->text);
}

static void draw(ethd__screen *s, const reading *r) {
  char title[256];
  ethd__page page = page_of(s, r, title);
  size_t from = r->begin[r->now];
  ETHD__FREED char *text = strndup(r->text + from, r->begin[r->now + 1] - from);
  if (!text) ethd__fail_memory();
  ethd__page_add(&page, ETHD_TEXT_SMALL, text, ethd__white);
  ethd__page_draw(&s->window, &page);
  ethd__window_end(&s->window);
}

int ethd__screen_read(ethd__screen *s, const char *text, const char *title, const char *keys, const int *ends) {
  static const int next[] = {SDLK_SPACE, SDLK_RETURN, SDLK_PAGEDOWN, 0}, before[] = {SDLK_BACKSPACE, SDLK_PAGEUP, 0};
  reading r = {.text = text, .title = title, .keys = keys};
  int key = SDLK_ESCAPE;
  while (ethd__screen_begin(s)) {
    divide(s, &r);
    key = s->window.key;
    bool last = r.now + 1 == r.count;
    if (last && ethd__key_is_one_of(key, ends)) break;
    if (!last && ethd__key_is_one_of(key, next)) r.now++;
    if (r.now && ethd__key_is_one_of(key, before)) r.now--;
    draw(s, &r);
    key = SDLK_ESCAPE;
  }
  free(r.begin);
  return key;
}
