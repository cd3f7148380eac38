#include "screen/draw.h"

#include <math.h>

#define CONTOUR 0.07      /* of the room's height */
#define CUE 0.04          /* of it, half the cue's height */
#define START_LINE 0.0075 /* of it, half the start line's width */
#define REST 0.8          /* s between two runs of the cue */

const SDL_Color ethd__white = {255, 255, 255, 255}, ethd__grey = {150, 150, 150, 255}, ethd__green = {0, 190, 80, 255},
                ethd__red = {255, 110, 90, 255};

void ethd__draw_fit(ethd__screen *s) {
  const ethd__study *study = &s->desk->study;
  const ethd_setup *setup = &s->desk->loaded->config->setup;
  const ethd_vec start = {study->meet.x + study->plant.start, study->meet.y};
  double inner, outer, wall[ETHD_WALLS] = {study->meet.x - setup->ring_radius};
  ethd_arm_reach(&setup->arm, &inner, &outer);
  for (int i = ETHD_WALL_RIGHT; i < ETHD_WALLS; i++) {
    const ethd_vec towards = {i == ETHD_WALL_RIGHT, (i == ETHD_WALL_TOP) - (i == ETHD_WALL_BOTTOM)};
    ethd_vec x = start;
    ethd_nearest near;
    bool there = ethd__way_to_wall(study->config->scene, 0, towards, outer, &x, &near) > 0;
    wall[i] = !there ? NAN : i == ETHD_WALL_RIGHT ? x.x : x.y;
  }
  s->frame = ethd__room_of(wall, start, study->plant.finger_radius, s->window.width, s->window.height);
}

/* m, of a share of the room's height. */
static double share(const ethd__screen *s, double of) { return of * (s->frame.top - s->frame.bottom); }

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
  double way = f->start.x - f->left - f->finger, pass = way / s->speed.centre, high = share(s, CUE);
  double t = fmod(seconds, pass + REST), x = f->start.x - way * fmin(t / pass, 1), y = f->top + share(s, CONTOUR);
  box(s, f->start.x - way, y + 2.6 * high, f->start.x, y + 2.4 * high, ethd__grey);
  box(s, x - high / 3, y + 3.5 * high, x + high / 3, y + 1.5 * high, ethd__white);
}

void ethd__draw_room(ethd__screen *s, ethd_vec x, double seconds) {
  const ethd__room *f = &s->frame;
  double thick = share(s, CONTOUR), line = share(s, START_LINE);
  const double side[ETHD_WALLS][4] = {{f->left - thick, f->top + thick, f->left, f->bottom - thick},
                                      {f->right, f->top + thick, f->right + thick, f->bottom - thick},
                                      {f->left, f->bottom, f->right, f->bottom - thick},
                                      {f->left, f->top + thick, f->right, f->top}};
  for (int i = 0; i < ETHD_WALLS; i++)
    if (f->there[i]) box(s, side[i][0], side[i][1], side[i][2], side[i][3], ethd__green);
  box(s, f->start.x - line, f->top, f->start.x + line, f->bottom, ethd__grey);
  if (seconds >= 0) cue(s, seconds);
  s->avatar = ethd__room_avatar(f, x);
  ethd_vec at = ethd__room_pixel(f, s->avatar);
  ethd__window_disc(&s->window, at.x, at.y, f->scale * f->finger, ethd__white);
}

double ethd__draw_floor(const ethd__screen *s) {
  return ceil(ethd__room_pixel(&s->frame, (ethd_vec){s->frame.left, s->frame.bottom - share(s, CONTOUR)}).y) + 1;
}
