#include "screen/window.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "text/error_text.h"

#define RATE 60 /* frames a second */
#define NO_DISPLAY "no display (DISPLAY or WAYLAND_DISPLAY; without --screen the study needs none)"
#define FONT "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

/* ---- open ---- */

static ethd_status refuse(ethd__window *w, const char *what, const char *why, char *message) {
  char line[ETHD_MESSAGE_MAX / 2];
  snprintf(line, sizeof line, "%s", why);
  ethd__window_close(w);
  return ethd__say(message, ETHD_E_DEVICE, "%s: %s", what, line);
}

static int points_of(const ethd__window *w, int size) {
  static const int points[ETHD_TEXTS] = {18, 30}; /* of 720 px */
  int high = points[size] * w->height / 720;
  high = (int)((high > 8 ? high : 8) * w->shrink);
  return high > 4 ? high : 4;
}

static ethd_status open_fonts(ethd__window *w, char *message) {
  const char *font = getenv("ETHD_FONT") ? getenv("ETHD_FONT") : FONT;
  if (TTF_Init()) return refuse(w, "fonts", TTF_GetError(), message);
  for (int i = 0; i < ETHD_TEXTS; i++) {
    w->font[i] = TTF_OpenFont(font, points_of(w, i));
    if (!w->font[i])
      return refuse(w, "the screen's font (Debian: fonts-dejavu-core; ETHD_FONT names another)", TTF_GetError(),
                    message);
    TTF_SetFontWrappedAlign(w->font[i], TTF_WRAPPED_ALIGN_CENTER);
  }
  return ETHD_OK;
}

/* Without a display SDL would draw invisibly; that needs an explicit request. */
static bool choose_display(void) {
  const char *x = getenv("DISPLAY"), *wayland = getenv("WAYLAND_DISPLAY");
  if (getenv("SDL_VIDEODRIVER")) return true;
  if (x || wayland) SDL_SetHint(SDL_HINT_VIDEODRIVER, x && wayland ? "x11,wayland" : x ? "x11" : "wayland");
  return x || wayland;
}

/* X takes pixels as they are. SDL would send them through OpenGL, which, without a graphics card, computes on all
   cores: four times as long a frame, and late ticks. */
static void keep_off_gl(void) {
  if (!strcmp(SDL_GetCurrentVideoDriver(), "x11")) SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
}

ethd_status ethd__window_open(ethd__window *w, const char *title, int width, int height,
                              char message[ETHD_MESSAGE_MAX]) {
  memset(w, 0, sizeof *w);
  w->width = width;
  w->height = height;
  w->shrink = 1;
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  if (!choose_display()) return refuse(w, NO_DISPLAY, "neither is set", message);
  if (SDL_Init(SDL_INIT_VIDEO)) return refuse(w, NO_DISPLAY, SDL_GetError(), message);
  keep_off_gl();
  w->window =
      SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, width, height, SDL_WINDOW_RESIZABLE);
  if (!w->window) return refuse(w, "the window", SDL_GetError(), message);
  if (!SDL_GetWindowSurface(w->window)) return refuse(w, "the window's pixels", SDL_GetError(), message);
  SDL_ShowCursor(SDL_DISABLE);
  SDL_StartTextInput();
  w->pointer[0] = 0.75 * width;
  w->pointer[1] = 0.5 * height;
  w->due = SDL_GetPerformanceCounter();
  w->resized = true;
  return open_fonts(w, message);
}

void ethd__window_close(ethd__window *w) {
  ethd__window_forget(w);
  for (int i = 0; i < ETHD_TEXTS; i++)
    if (w->font[i]) TTF_CloseFont(w->font[i]);
  if (TTF_WasInit()) TTF_Quit();
  if (w->window) SDL_DestroyWindow(w->window);
  SDL_Quit();
  memset(w, 0, sizeof *w);
}

/* ---- frames ---- */

static void take(ethd__window *w, const SDL_Event *e) {
  if (e->type == SDL_QUIT) w->closed = true;
  if (e->type == SDL_KEYDOWN && !e->key.repeat) w->key = e->key.keysym.sym;
  if (e->type == SDL_TEXTINPUT) SDL_strlcat(w->typed, e->text.text, sizeof w->typed);
  if (e->type == SDL_WINDOWEVENT) {
    w->resized |= e->window.event == SDL_WINDOWEVENT_SIZE_CHANGED;
    w->covered |= e->window.event == SDL_WINDOWEVENT_EXPOSED;
  }
  if (e->type == SDL_MOUSEMOTION) {
    w->pointer[0] = e->motion.x;
    w->pointer[1] = e->motion.y;
    if (w->moved) w->moved(w->mover, ethd__clock_now());
  }
}

/* An event's time stamp is the time of its reading from the system, so events are read every millisecond. */
static void take_motions(ethd__window *w) {
  SDL_Event e;
  SDL_PumpEvents();
  while (SDL_PeepEvents(&e, 1, SDL_GETEVENT, SDL_MOUSEMOTION, SDL_MOUSEMOTION) > 0) take(w, &e);
}

static void await_frame(ethd__window *w) {
  uint64_t rate = SDL_GetPerformanceFrequency(), now;
  while ((now = SDL_GetPerformanceCounter()) < w->due) {
    take_motions(w);
    SDL_Delay(1);
  }
  w->due = (now > w->due + rate / RATE ? now : w->due) + rate / RATE;
  w->begun = now;
}

void ethd__window_shrink(ethd__window *w, double factor) {
  w->shrink = factor;
  for (int i = 0; i < ETHD_TEXTS; i++) (void)TTF_SetFontSize(w->font[i], points_of(w, i));
  ethd__window_forget(w);
}

/* Texts grow with the window. */
static void fit(ethd__window *w) {
  SDL_GetWindowSize(w->window, &w->width, &w->height);
  ethd__window_shrink(w, 1);
  w->resized = false;
}

void ethd__window_begin(ethd__window *w) {
  SDL_Event e;
  await_frame(w);
  w->key = 0;
  w->typed[0] = 0;
  while (!w->key && SDL_PollEvent(&e)) take(w, &e); /* a key a frame: none is lost, nor its place between letters */
  if (w->resized) fit(w);
  w->covered |= w->shape_count > 0; /* the frame before wasn't ended */
  w->shape_count = w->changed_count = 0;
}

void ethd__window_end(ethd__window *w) {
  SDL_Surface *pixels = SDL_GetWindowSurface(w->window);
  if (!pixels) return; /* in the midst of a resize */
  ethd__window_draw(w, pixels);
  if (!w->changed_count) return;
  SDL_UpdateWindowSurfaceRects(w->window, w->changed, (int)w->changed_count);
  uint64_t spent = SDL_GetPerformanceCounter() - w->begun;
  ethd_histogram_add(&w->frames, (int64_t)(1e9 * (double)spent / (double)SDL_GetPerformanceFrequency()));
}
