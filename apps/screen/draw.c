#include "screen/draw.h"

#include <math.h>

#define CONTOUR 0.0028 /* m */
#define CUE 0.0016     /* m, half the cue's height */
#define REST 0.8       /* s between two runs of the cue */

const SDL_Color ethd__white = {255, 255, 255, 255}, ethd__grey = {150, 150, 150, 255}, ethd__green = {0, 190, 80, 255},
                ethd__red = {255, 110, 90, 255};

void ethd__draw_fit(ethd__screen *s) {
  const ethd__study *study = &s->desk->study;
  const ethd_setup *setup = &s->desk->loaded->config->setup;
  double wall = study->meet.x - setup->ring_radius;
  s->frame = ethd__room_of(wall, study->meet.x + study->plant.start, study->meet.y, study->plant.finger_radius,
                           s->window.width, s->window.height);
}

ethd_vec ethd__draw_finger(const ethd__screen *s) {
  if (s->device) return s->device->finger(s->device->self);
  return ethd__room_point(&s->frame, s->window.pointer[0], s->window.pointer[1]);
}

static void box(ethd__screen *s, double left, double top, double right, double bottom, SDL_Color colour) {
  ethd_vec a = ethd__room_pixel(&s->frame, (ethd_vec){left, top}),
           b = ethd__room_pixel(&s->frame, (ethd_vec){right, bottom});
  ethd__window_box(&s->window, a.x, a.y, b.x - a.x, b.y - a.y, colour);
}

static void cue(ethd__screen *s, double seconds) {
  const ethd__room *f = &s->frame;
  double way = f->start - f->left - f->finger, pass = way / s->speed.centre;
  double t = fmod(seconds, pass + REST), x = f->start - way * fmin(t / pass, 1);
  box(s, f->start - way, f->top + CONTOUR + 2.6 * CUE, f->start, f->top + CONTOUR + 2.4 * CUE, ethd__grey);
  box(s, x - CUE / 3, f->top + CONTOUR + 3.5 * CUE, x + CUE / 3, f->top + CONTOUR + 1.5 * CUE, ethd__white);
}

void ethd__draw_room(ethd__screen *s, ethd_vec x, double seconds) {
  const ethd__room *f = &s->frame;
  box(s, f->left - CONTOUR, f->top + CONTOUR, f->right + CONTOUR, f->bottom - CONTOUR, ethd__green);
  box(s, f->left, f->top, f->right, f->bottom, (SDL_Color){0, 0, 0, 255});
  box(s, f->start - 0.0003, f->top, f->start + 0.0003, f->bottom, ethd__grey);
  if (seconds >= 0) cue(s, seconds);
  s->avatar = ethd__room_avatar(f, x);
  ethd_vec at = ethd__room_pixel(f, s->avatar);
  ethd__window_disc(&s->window, at.x, at.y, f->scale * f->finger, ethd__white);
}

double ethd__draw_floor(const ethd__screen *s) {
  return ceil(ethd__room_pixel(&s->frame, (ethd_vec){s->frame.left, s->frame.bottom - CONTOUR}).y) + 1;
}
