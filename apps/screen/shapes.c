/* A frame's shapes: each replaces the shape with its number in the frame before. */
#include <math.h>
#include <string.h>

#include "screen/window.h"

enum { BOX, DISC, TEXT };

/* ---- pictures ---- */

static SDL_Rect hull(double left, double top, double right, double bottom) {
  int x = (int)lround(left), y = (int)lround(top);
  return (SDL_Rect){x, y, (int)lround(right) - x, (int)lround(bottom) - y};
}

/* One row of a disc of radius r whose centre is dx to the right of its first pixel's, dy above it. The edge is as
   light as the share of each pixel that it covers. */
static void paint_row(uint32_t *pixel, int count, double dx, double dy, double r, uint32_t colour) {
  double inner = r - 0.5, outer = r + 0.5, rest = dy * dy;
  for (int i = 0; i < count; i++) {
    double square = (i - dx) * (i - dx) + rest;
    if (square >= outer * outer) continue;
    uint32_t alpha = inner > 0 && square <= inner * inner ? 255 : (uint32_t)(255 * (outer - sqrt(square)));
    pixel[i] = alpha << 24 | colour;
  }
}

static void paint_disc(ethd__window_shape *s) {
  double r = s->width;
  uint32_t colour = (uint32_t)s->colour.r << 16 | (uint32_t)s->colour.g << 8 | s->colour.b;
  s->at = hull(floor(s->x - r) - 1, floor(s->y - r) - 1, ceil(s->x + r) + 1, ceil(s->y + r) + 1);
  s->picture = SDL_CreateRGBSurfaceWithFormat(0, s->at.w, s->at.h, 32, SDL_PIXELFORMAT_ARGB8888);
  for (int row = 0; s->picture && row < s->at.h; row++)
    paint_row((uint32_t *)s->picture->pixels + row * (s->picture->pitch / 4), s->at.w, s->x - s->at.x - 0.5,
              s->y - s->at.y - 0.5 - row, r, colour);
}

static void paint_text(const ethd__window *w, ethd__window_shape *s) {
  if (!*s->text) return;
  s->picture = TTF_RenderUTF8_Blended_Wrapped(w->font[s->size], s->text, s->colour, (uint32_t)(0.9 * w->width));
  if (!s->picture) return;
  double low = w->height - s->picture->h; /* a small window's last line isn't cut */
  s->at = (SDL_Rect){(int)(s->x - s->picture->w / 2.0), (int)fmin(s->y, low), s->picture->w, s->picture->h};
}

static void paint(const ethd__window *w, ethd__window_shape *s) {
  if (s->kind == BOX) s->at = hull(s->x, s->y, s->x + s->width, s->y + s->height);
  if (s->kind == DISC) paint_disc(s);
  if (s->kind == TEXT) paint_text(w, s);
}

/* ---- the list ---- */

static bool same(const ethd__window_shape *a, const ethd__window_shape *b) {
  return a->kind == b->kind && a->size == b->size && a->x == b->x && a->y == b->y && a->width == b->width &&
         a->height == b->height && !memcmp(&a->colour, &b->colour, sizeof a->colour) && !strcmp(a->text, b->text);
}

static void drop(ethd__window_shape *s) {
  SDL_FreeSurface(s->picture);
  *s = (ethd__window_shape){0};
}

static void put(ethd__window *w, const ethd__window_shape *shape) {
  if (w->shape_count == ETHD_SHAPES_MAX) return;
  size_t i = w->shape_count++;
  ethd__window_shape *s = &w->shape[i];
  if (i < w->shape_before && same(s, shape)) return;
  SDL_Rect before = s->at;
  drop(s);
  *s = *shape;
  paint(w, s);
  SDL_UnionRect(&before, &s->at, &w->changed[w->changed_count++]);
}

void ethd__window_box(ethd__window *w, double x, double y, double width, double height, SDL_Color c) {
  put(w, &(ethd__window_shape){.kind = BOX, .x = x, .y = y, .width = width, .height = height, .colour = c});
}

void ethd__window_disc(ethd__window *w, double x, double y, double radius, SDL_Color c) {
  put(w, &(ethd__window_shape){.kind = DISC, .x = x, .y = y, .width = radius, .colour = c});
}

void ethd__window_text(ethd__window *w, int size, double x, double y, const char *text, SDL_Color c) {
  ethd__window_shape shape = {.kind = TEXT, .size = size, .x = x, .y = y, .colour = c};
  SDL_strlcpy(shape.text, text, sizeof shape.text);
  put(w, &shape);
}

void ethd__window_forget(ethd__window *w) {
  for (size_t i = 0; i < ETHD_SHAPES_MAX; i++) drop(&w->shape[i]);
  w->shape_count = w->shape_before = w->changed_count = 0;
  w->covered = true;
}

/* ---- drawing ---- */

/* Clears the remaining shapes of a longer list. */
static void end_list(ethd__window *w) {
  for (size_t i = w->shape_count; i < w->shape_before; i++) {
    w->changed[w->changed_count++] = w->shape[i].at;
    drop(&w->shape[i]);
  }
  w->shape_before = w->shape_count;
  w->shape_count = 0;
}

static void draw_shape(const ethd__window_shape *s, SDL_Surface *onto) {
  SDL_Rect at = s->at;
  if (s->picture)
    SDL_BlitSurface(s->picture, NULL, onto, &at);
  else if (s->kind == BOX)
    SDL_FillRect(onto, &at, SDL_MapRGB(onto->format, s->colour.r, s->colour.g, s->colour.b));
}

static void draw_within(const ethd__window *w, const SDL_Rect *within, SDL_Surface *onto) {
  SDL_SetClipRect(onto, within);
  SDL_FillRect(onto, within, SDL_MapRGB(onto->format, 0, 0, 0));
  for (size_t i = 0; i < w->shape_before; i++)
    if (SDL_HasIntersection(within, &w->shape[i].at)) draw_shape(&w->shape[i], onto);
}

void ethd__window_draw(ethd__window *w, SDL_Surface *onto) {
  const SDL_Rect whole = {0, 0, onto->w, onto->h};
  size_t n = 0;
  end_list(w);
  if (w->covered) w->changed[0] = whole, w->changed_count = 1;
  for (size_t i = 0; i < w->changed_count; i++)
    if (SDL_IntersectRect(&w->changed[i], &whole, &w->changed[n])) draw_within(w, &w->changed[n++], onto);
  SDL_SetClipRect(onto, NULL);
  w->changed_count = n;
  w->covered = false;
}
