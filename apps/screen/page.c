#include "screen/page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "screen/draw.h"

#define WIDE 0.88   /* of the window that a line may take */
#define MARGIN 0.02 /* of its height, above and below */
#define GAP 0.35    /* of a line, between paragraphs */
#define STEP 0.92   /* factor of the letters' size at each step */
#define LEAST 0.3   /* to which they do */

void ethd__page_add(ethd__page *page, int size, const char *text, SDL_Color colour) {
  if (page->count < ETHD_PAGE_PARAGRAPHS && *text)
    page->paragraph[page->count++] = (ethd__paragraph){size, text, colour};
}

/* ---- lines ---- */

/* Bytes of the first `letters` letters. */
static size_t bytes_of(const char *text, int letters) {
  size_t n = 0;
  for (; letters > 0 && text[n]; letters--) {
    n++;
    while ((text[n] & 0xc0) == 0x80) n++;
  }
  return n;
}

/* Bytes of the text's first line, at most what a shape holds: it ends at a newline, between words, or within one that is
   longer than a line. */
static size_t line_of(const ethd__window *w, int size, const char *text) {
  char head[sizeof w->shape->text];
  int extent, letters = 0;
  size_t most = strcspn(text, "\n"), room = sizeof head - 1;
  if (most > room)
    for (most = room; most && (text[most] & 0xc0) == 0x80;) most--;
  snprintf(head, sizeof head, "%.*s", (int)most, text);
  if (TTF_MeasureUTF8(w->font[size], head, (int)(WIDE * w->width), &extent, &letters)) return most;
  size_t fits = bytes_of(head, letters > 0 ? letters : 1), n = fits;
  if (!text[fits] || text[fits] == '\n') return fits;
  while (n && text[n] != ' ') n--;
  return n ? n : fits;
}

/* A picture of letters with accents can be a pixel higher than the font says. */
static double line_height(const ethd__window *w, int size) {
  return fmax(TTF_FontLineSkip(w->font[size]), TTF_FontHeight(w->font[size])) + 1;
}

/* Goes behind a line of n bytes. Returns its height, px, with the gap to the next paragraph. */
static double pass_line(const ethd__window *w, int size, const char **at, size_t n) {
  double height = line_height(w, size);
  *at += n;
  *at += strspn(*at, " ");
  if (**at != '\n') return height;
  ++*at;
  return (1 + GAP) * height;
}

/* Breaks the text into lines from y down; draws them where `draws`. The text's height, px. */
static double put(ethd__window *w, const ethd__paragraph *p, double y, bool draws) {
  char line[sizeof w->shape->text];
  double height = 0;
  for (const char *at = p->text; *at;) {
    size_t n = line_of(w, p->size, at);
    snprintf(line, sizeof line, "%.*s", (int)n, at);
    if (draws) ethd__window_text(w, p->size, w->width / 2.0, y + height, line, p->colour);
    height += pass_line(w, p->size, &at, n);
  }
  return height;
}

/* ---- the page ---- */

static ethd__paragraph small(const char *text) { return (ethd__paragraph){ETHD_TEXT_SMALL, text, ethd__grey}; }

/* The room for the paragraphs, and the part that they use. */
typedef struct page_room {
  double top, bottom, height;
} page_room;

static page_room measure(ethd__window *w, const ethd__page *page) {
  const ethd__paragraph title = small(page->title), keys = small(page->keys);
  double margin = MARGIN * w->height;
  page_room room = {.bottom = w->height - margin};
  room.top = fmax(margin + put(w, &title, 0, false), page->below);
  room.bottom -= put(w, &keys, 0, false);
  for (size_t i = 0; i < page->count; i++) {
    room.height += put(w, &page->paragraph[i], 0, false);
    room.height += GAP * line_height(w, page->paragraph[i].size);
  }
  return room;
}

size_t ethd__page_room(ethd__window *w, const ethd__page *page, const char *text) {
  const char *at = text;
  if (w->shrink != 1) ethd__window_shrink(w, 1);
  page_room room = measure(w, page);
  double line = line_height(w, ETHD_TEXT_SMALL), left = room.bottom - room.top - room.height - 2 * GAP * line;
  do left -= pass_line(w, ETHD_TEXT_SMALL, &at, line_of(w, ETHD_TEXT_SMALL, at));
  while (*at && left >= line);
  return (size_t)(at - text);
}

static uint64_t mix(uint64_t sum, const char *text) {
  do sum = (sum ^ (unsigned char)*text) * 1099511628211u;
  while (*text++);
  return sum;
}

/* Distinguishes pages and windows (FNV-1a). */
static uint64_t sum_of(const ethd__window *w, const ethd__page *page) {
  uint64_t sum = 14695981039346656037u ^ (uint64_t)w->width << 32 ^ (uint64_t)w->height ^ (uint64_t)page->below << 16;
  sum = mix(mix(sum, page->title), page->keys);
  for (size_t i = 0; i < page->count; i++) sum = mix(sum ^ (uint64_t)page->paragraph[i].size, page->paragraph[i].text);
  return sum;
}

static void fit(ethd__window *w, const ethd__page *page) {
  uint64_t sum = sum_of(w, page);
  if (w->fitted == sum) return;
  double was = w->shrink;
  if (was != 1) ethd__window_shrink(w, 1);
  for (page_room room = measure(w, page); room.top + room.height > room.bottom && w->shrink > LEAST;
       room = measure(w, page))
    ethd__window_shrink(w, fmax(STEP * w->shrink, LEAST));
  w->fitted = sum;
}

void ethd__page_draw(ethd__window *w, const ethd__page *page) {
  const ethd__paragraph title = small(page->title), keys = small(page->keys);
  fit(w, page);
  page_room room = measure(w, page);
  double free = fmax(room.bottom - room.top - room.height, 0), y = room.top + (page->below > 0 ? free : free / 2);
  put(w, &title, MARGIN * w->height, true);
  for (size_t i = 0; i < page->count; i++) {
    y += put(w, &page->paragraph[i], y, true);
    y += GAP * line_height(w, page->paragraph[i].size);
  }
  put(w, &keys, room.bottom, true);
}
