#include "screen/window.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "file/error_text.h"

#define RATE 60 /* frames a second */
#define FONT "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

/* ---- open ---- */

static ethd_status refuse(ethd__window *w, const char *what, const char *why, char *message) {
  char line[ETHD_MESSAGE_MAX / 2];
  snprintf(line, sizeof line, "%s", why);
  ethd__window_close(w);
  return ethd__say(message, ETHD_E_DEVICE, "%s: %s", what, line);
}

static ethd_status open_fonts(ethd__window *w, char *message) {
  static const int points[ETHD_TEXTS] = {15, 30};
  const char *font = getenv("ETHD_FONT") ? getenv("ETHD_FONT") : FONT;
  if (TTF_Init()) return refuse(w, "fonts", TTF_GetError(), message);
  for (int i = 0; i < ETHD_TEXTS; i++) {
    w->font[i] = TTF_OpenFont(font, points[i] * w->height / 720 > 8 ? points[i] * w->height / 720 : 8);
    if (!w->font[i])
      return refuse(w, "the screen's font (Debian: fonts-dejavu-core; ETHD_FONT names another)", TTF_GetError(), message);
    TTF_SetFontWrappedAlign(w->font[i], TTF_WRAPPED_ALIGN_CENTER);
  }
  return ETHD_OK;
}

/* X takes pixels as they are. SDL would send them through OpenGL, which, without a graphics card, computes on all
   cores: four times as long a frame, and late ticks. */
static void keep_off_gl(void) {
  if (!strcmp(SDL_GetCurrentVideoDriver(), "x11")) SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
}

ethd_status ethd__window_open(ethd__window *w, const char *title, int width, int height, char message[ETHD_MESSAGE_MAX]) {
  memset(w, 0, sizeof *w);
  w->width = width;
  w->height = height;
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  if (SDL_Init(SDL_INIT_VIDEO))
    return refuse(w, "no display (DISPLAY or WAYLAND_DISPLAY; without --screen the study needs none)", SDL_GetError(), message);
  keep_off_gl();
  w->window = SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, width, height, SDL_WINDOW_RESIZABLE);
  if (!w->window) return refuse(w, "the window", SDL_GetError(), message);
  w->renderer = SDL_CreateRenderer(w->window, -1, SDL_RENDERER_SOFTWARE);
  if (!w->renderer) return refuse(w, "the window's renderer", SDL_GetError(), message);
  SDL_ShowCursor(SDL_DISABLE);
  SDL_StartTextInput();
  w->pointer[0] = 0.75 * width;
  w->pointer[1] = 0.5 * height;
  w->due = SDL_GetPerformanceCounter();
  return open_fonts(w, message);
}

void ethd__window_close(ethd__window *w) {
  for (int i = 0; i < ETHD_TEXTS; i++)
    if (w->font[i]) TTF_CloseFont(w->font[i]);
  if (TTF_WasInit()) TTF_Quit();
  if (w->renderer) SDL_DestroyRenderer(w->renderer);
  if (w->window) SDL_DestroyWindow(w->window);
  SDL_Quit();
  memset(w, 0, sizeof *w);
}

/* ---- frames ---- */

static void take(ethd__window *w, const SDL_Event *e) {
  if (e->type == SDL_QUIT) w->closed = true;
  if (e->type == SDL_KEYDOWN && !e->key.repeat) w->key = e->key.keysym.sym;
  if (e->type == SDL_TEXTINPUT) snprintf(w->typed, sizeof w->typed, "%s", e->text.text);
  if (e->type == SDL_MOUSEMOTION) {
    w->pointer[0] = e->motion.x;
    w->pointer[1] = e->motion.y;
  }
}

static void await_frame(ethd__window *w) {
  uint64_t rate = SDL_GetPerformanceFrequency(), now = SDL_GetPerformanceCounter();
  if (now < w->due) SDL_Delay((uint32_t)((w->due - now) * 1000 / rate));
  now = SDL_GetPerformanceCounter();
  w->due = (now > w->due + rate / RATE ? now : w->due) + rate / RATE;
  w->begun = now;
}

void ethd__window_begin(ethd__window *w) {
  SDL_Event e;
  await_frame(w);
  w->key = 0;
  w->typed[0] = 0;
  while (SDL_PollEvent(&e)) take(w, &e);
  (void)SDL_GetRendererOutputSize(w->renderer, &w->width, &w->height);
  SDL_SetRenderDrawColor(w->renderer, 0, 0, 0, 255);
  SDL_RenderClear(w->renderer);
}

void ethd__window_end(ethd__window *w) {
  SDL_RenderPresent(w->renderer);
  uint64_t spent = SDL_GetPerformanceCounter() - w->begun;
  ethd_histogram_add(&w->frames, (int64_t)(1e9 * (double)spent / (double)SDL_GetPerformanceFrequency()));
}

/* ---- shapes ---- */

void ethd__window_box(ethd__window *w, double x, double y, double width, double height, SDL_Color c) {
  const SDL_FRect box = {(float)x, (float)y, (float)width, (float)height};
  SDL_SetRenderDrawColor(w->renderer, c.r, c.g, c.b, c.a);
  SDL_RenderFillRectF(w->renderer, &box);
}

/* Row by row: many times as fast, in software, as triangles. */
void ethd__window_disc(ethd__window *w, double x, double y, double radius, SDL_Color c) {
  int top = (int)ceil(y - radius), bottom = (int)floor(y + radius);
  SDL_SetRenderDrawColor(w->renderer, c.r, c.g, c.b, c.a);
  for (int row = top; row <= bottom; row++) {
    double half = sqrt(fmax(radius * radius - (row - y) * (row - y), 0));
    SDL_RenderDrawLine(w->renderer, (int)lround(x - half), row, (int)lround(x + half), row);
  }
}

void ethd__window_text(ethd__window *w, int size, double x, double y, const char *text, SDL_Color c) {
  SDL_Surface *surface = *text ? TTF_RenderUTF8_Blended_Wrapped(w->font[size], text, c, (uint32_t)(0.9 * w->width)) : NULL;
  SDL_Texture *texture = surface ? SDL_CreateTextureFromSurface(w->renderer, surface) : NULL;
  if (texture) {
    const SDL_Rect at = {(int)(x - surface->w / 2.0), (int)y, surface->w, surface->h};
    SDL_RenderCopy(w->renderer, texture, NULL, &at);
    SDL_DestroyTexture(texture);
  }
  SDL_FreeSurface(surface);
}
