/* Frames of shapes: drawn bit by bit they look as drawn at once, and what stays costs nothing. No display is needed. */
#include <stdlib.h>
#include <string.h>

#include "screen/window.h"
#include "unit/draw.h"
#include "unit/suite.h"

enum { WIDTH = 320, HEIGHT = 200 };

static ethd__window fresh(void) {
  const char *font = getenv("ETHD_FONT") ? getenv("ETHD_FONT") : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  ethd__window w = {.width = WIDTH, .height = HEIGHT, .shrink = 1, .covered = true};
  ck_assert_int_eq(TTF_Init(), 0);
  for (int i = 0; i < ETHD_TEXTS; i++) ck_assert_ptr_nonnull(w.font[i] = TTF_OpenFont(font, 9 + 7 * i));
  return w;
}

static void end(ethd__window *w) {
  ethd__window_forget(w);
  for (int i = 0; i < ETHD_TEXTS; i++) TTF_CloseFont(w->font[i]);
  TTF_Quit();
}

static SDL_Surface *pixels(void) {
  SDL_Surface *s = SDL_CreateRGBSurfaceWithFormat(0, WIDTH, HEIGHT, 32, SDL_PIXELFORMAT_RGB888);
  ck_assert_ptr_nonnull(s);
  return s;
}

static SDL_Color colour(uint64_t k) {
  return (SDL_Color){(uint8_t)draw_bits(k), (uint8_t)draw_bits(k + 1), (uint8_t)draw_bits(k + 2), 255};
}

/* One of a few shapes at one of a few places, some of them over the edges. */
static void put(ethd__window *w, uint64_t k) {
  static const char *const texts[] = {"", "tap", "too slow: be a bit quicker, and then a word more than fits the line",
                                      "(2 of 5)"};
  double x = draw(k + 1, -40, WIDTH + 40), y = draw(k + 2, -40, HEIGHT + 40), size = draw(k + 3, 0, 60);
  switch (draw_bits(k) % 3) {
  case 0: ethd__window_box(w, x, y, size, draw(k + 4, -5, 40), colour(k + 5)); return;
  case 1: ethd__window_disc(w, x, y, size, colour(k + 5)); return;
  default: ethd__window_text(w, draw_bits(k + 4) & 1, x, y, texts[draw_bits(k + 8) % 4], colour(k + 5));
  }
}

/* Frame `number`: of each shape there are versions that last for a few frames; lists grow and shrink. */
static void list(ethd__window *w, uint64_t number) {
  uint64_t count = draw_bits(number / 5) % 40;
  w->changed_count = 0;
  for (uint64_t i = 0; i < count; i++) put(w, 1000 * (50 * i + (number + i) / (1 + i % 7)));
}

TEST(test_looks_as_if_drawn_at_once) {
  ethd__window w = fresh();
  SDL_Surface *kept = pixels(), *anew = pixels();
  size_t partly = 0;
  for (uint64_t number = 0; number < 150; number++) {
    list(&w, number);
    ethd__window_draw(&w, kept);
    ck_assert_uint_le(w.changed_count, ETHD_SHAPES_MAX);
    partly += number && w.changed_count && w.changed[0].w < WIDTH;
    w.covered = true;
    list(&w, number);
    ethd__window_draw(&w, anew);
    ck_assert_msg(!memcmp(kept->pixels, anew->pixels, (size_t)(kept->pitch * HEIGHT)), "frame %d", (int)number);
  }
  ck_assert_uint_gt(partly, 75);
  SDL_FreeSurface(kept);
  SDL_FreeSurface(anew);
  end(&w);
}

/* Nothing lies outside of the boxes that are said to have changed. */
TEST(test_says_what_changed) {
  ethd__window w = fresh();
  SDL_Surface *now = pixels(), *before = pixels();
  for (uint64_t number = 0; number < 80; number++) {
    memcpy(before->pixels, now->pixels, (size_t)(now->pitch * HEIGHT));
    list(&w, number);
    ethd__window_draw(&w, now);
    for (size_t i = 0; i < w.changed_count; i++) {
      SDL_Rect from = w.changed[i], to = from;
      ck_assert(from.x >= 0 && from.y >= 0 && from.w > 0 && from.h > 0 && from.x + from.w <= WIDTH &&
                from.y + from.h <= HEIGHT);
      SDL_BlitSurface(now, &from, before, &to);
    }
    ck_assert_msg(!memcmp(before->pixels, now->pixels, (size_t)(now->pitch * HEIGHT)), "frame %d", (int)number);
  }
  SDL_FreeSurface(now);
  SDL_FreeSurface(before);
  end(&w);
}

static void page(ethd__window *w, double x, const char *word, uint8_t red) {
  static const SDL_Color white = {255, 255, 255, 255};
  w->changed_count = 0;
  ethd__window_box(w, 10, 10, 50, 20, (SDL_Color){red, 0, 0, 255});
  ethd__window_disc(w, x, 100, 12, white);
  ethd__window_text(w, ETHD_TEXT_LARGE, 160, 150, word, white);
}

TEST(test_what_stays_costs_nothing) {
  ethd__window w = fresh();
  SDL_Surface *onto = pixels();
  page(&w, 50, "Tap", 255);
  ethd__window_draw(&w, onto);
  ck_assert(w.changed_count == 1 && w.changed[0].w == WIDTH && w.changed[0].h == HEIGHT);
  const SDL_Surface *text = w.shape[2].picture;
  page(&w, 50, "Tap", 255);
  ethd__window_draw(&w, onto);
  ck_assert_uint_eq(w.changed_count, 0);
  page(&w, 53.5, "Tap", 255);
  ethd__window_draw(&w, onto);
  ck_assert(w.changed_count == 1 && w.changed[0].w <= 33 && w.changed[0].h <= 29);
  ck_assert_ptr_eq(w.shape[2].picture, text);
  page(&w, 53.5, "", 255);
  ethd__window_draw(&w, onto);
  ck_assert(w.changed_count == 1 && w.changed[0].y == 150);
  page(&w, 53.5, "", 90);
  ethd__window_draw(&w, onto);
  ck_assert(w.changed_count == 1 && w.changed[0].w == 50 && w.changed[0].h == 20);
  w.covered = true;
  page(&w, 53.5, "", 90);
  ethd__window_draw(&w, onto);
  ck_assert(w.changed_count == 1 && w.changed[0].w == WIDTH);
  SDL_FreeSurface(onto);
  end(&w);
}

TEST(test_last_line_is_not_cut) {
  ethd__window w = fresh();
  SDL_Surface *onto = pixels();
  w.changed_count = 0;
  ethd__window_text(&w, ETHD_TEXT_SMALL, 160, HEIGHT - 4, "Space goes on", (SDL_Color){255, 255, 255, 255});
  ethd__window_draw(&w, onto);
  ck_assert_int_le(w.shape[0].at.y + w.shape[0].picture->h, HEIGHT);
  ck_assert_int_eq(w.shape[0].at.h, w.shape[0].picture->h);
  SDL_FreeSurface(onto);
  end(&w);
}

/* A disc weighs what its circle does, wherever between pixels it stands, and keeps within its radius. */
TEST(test_disc_is_round) {
  ethd__window w = fresh();
  SDL_Surface *onto = pixels();
  for (uint64_t k = 0; k < 50; k++) {
    double x = draw(2 * k, 90, 110), y = draw(2 * k + 1, 90, 110), r = draw(k + 900, 2, 60), sum = 0;
    w.changed_count = 0;
    ethd__window_disc(&w, x, y, r, (SDL_Color){255, 255, 255, 255});
    ethd__window_draw(&w, onto);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      unsigned light = ((uint32_t *)onto->pixels)[i / WIDTH * (onto->pitch / 4) + i % WIDTH] & 255;
      double dx = i % WIDTH + 0.5 - x, dy = i / WIDTH + 0.5 - y;
      sum += light / 255.0;
      ck_assert(!light || dx * dx + dy * dy <= (r + 0.5) * (r + 0.5));
    }
    ck_assert_double_eq_tol(sum, 3.14159265358979 * r * r, 0.02 * r * r + 0.5);
  }
  SDL_FreeSurface(onto);
  end(&w);
}
