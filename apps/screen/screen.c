#include "screen/screen.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "screen/draw.h"
#include "study/dictionary.h"
#include "text/error_text.h"

#define SECONDS_MAX 6.0 /* s of a tap */
#define NEAR 0.004      /* m from the start line, and from the middle */
#define STILL 0.5       /* s there */
#define SETTLED 0.02    /* m/s */
#define KEYS "P pause   N note   A end this participant   Esc stop"

/* ---- frames ---- */

static bool begin(ethd__screen *s) {
  ethd__window_begin(&s->window);
  ethd__draw_fit(s);
  if (s->window.closed || s->window.key == SDLK_ESCAPE || ethd__stop) s->stop = true;
  return !s->stop;
}

static double now(void) { return (double)SDL_GetPerformanceCounter() / (double)SDL_GetPerformanceFrequency(); }

/* A page of lines until a key is pressed. */
static void page(ethd__screen *s, const char *first, const char *second, const char *keys) {
  ethd__window *w = &s->window;
  do {
    if (!begin(s)) return;
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.02 * w->height, s->title, ethd__grey);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.36 * w->height, first, ethd__white);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.46 * w->height, second, ethd__grey);
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.95 * w->height, keys, ethd__grey);
    ethd__window_end(w);
  } while (w->key != SDLK_SPACE && w->key != SDLK_RETURN);
}

/* ---- blocks ---- */

static void block(void *self, const char *participant, const ethd__turn *turn) {
  ethd__screen *s = self;
  char speed[96];
  ethd__taken taken;
  char message[ETHD_MESSAGE_MAX];
  if (!ethd__desk_prepare(s->desk, turn, &taken, message)) s->speed = *taken.speed;
  snprintf(s->title, sizeof s->title, "%s   part %zu%s", participant, turn->number,
           turn->block.training ? ", practice" : "");
  snprintf(speed, sizeof speed, "as fast as the white mark will move: %.2g m/s", s->speed.centre);
  s->feedback[0] = 0;
  page(s, "Tap once on the green wall at the left", speed, "Space goes on   Esc stops");
}

/* ---- before a tap ---- */

/* Removes one letter, which may be several bytes. */
static size_t shorter(const char *line, size_t n) {
  while (n && (line[--n] & 0xc0) == 0x80) continue;
  return n;
}

/* A line of text; Enter ends it, Escape forgets it. */
static bool write_note(ethd__screen *s, char words[ETHD_MESSAGE_MAX]) {
  ethd__window *w = &s->window;
  char line[200] = "";
  for (bool first = true;; first = false) {
    ethd__window_begin(w);
    size_t n = strlen(line);
    if (w->closed || w->key == SDLK_ESCAPE) return false;
    if (w->key == SDLK_RETURN) break;
    if (w->key == SDLK_BACKSPACE) line[n = shorter(line, n)] = 0;
    if (!first && w->typed[0]) snprintf(line + n, sizeof line - n, "%s", w->typed);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.36 * w->height, "A note", ethd__grey);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.46 * w->height, line, ethd__white);
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.95 * w->height, "Enter keeps it   Esc forgets it",
                      ethd__grey);
    ethd__window_end(w);
  }
  snprintf(words, ETHD_MESSAGE_MAX, "%s", line);
  return *line;
}

static bool sure(ethd__screen *s) {
  ethd__window *w = &s->window;
  do {
    ethd__window_begin(w);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.42 * w->height, "End for this participant?", ethd__white);
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.95 * w->height, "Y yes   any other key goes back",
                      ethd__grey);
    ethd__window_end(w);
  } while (!w->key && !w->closed);
  return w->key == SDLK_y;
}

/* How long the finger has stood at the start line, s. */
typedef struct waiting {
  ethd_vec last;
  double since, before;
} waiting;

static bool at_start(const ethd__screen *s, waiting *wait) {
  ethd_vec x = ethd__draw_finger(s);
  double t = now(), middle = (s->frame.bottom + s->frame.top) / 2;
  double speed = ethd_vec_norm(ethd_vec_sub(x, wait->last)) / fmax(t - wait->before, 1e-3);
  bool there = fabs(x.x - s->frame.start) < NEAR && fabs(x.y - middle) < NEAR && speed < SETTLED;
  wait->last = x;
  wait->before = t;
  if (!there) wait->since = t;
  return t - wait->since > STILL;
}

static ethd__wish wish(void *self, char words[ETHD_MESSAGE_MAX]) {
  ethd__screen *s = self;
  waiting wait = {.since = now(), .before = now()};
  double start = now();
  while (begin(s)) {
    SDL_Keycode key = s->window.key;
    if (key == SDLK_a && sure(s)) return ETHD_WISH_ABORT;
    if (key == SDLK_n && write_note(s, words)) return ETHD_WISH_NOTE;
    if (key == SDLK_p) {
      page(s, "Pause", "", "Space goes on   Esc stops");
      return s->stop ? ETHD_WISH_STOP : ETHD_WISH_PAUSE;
    }
    ethd__draw_room(s, ethd__draw_finger(s), now() - start);
    ethd__draw_words(s, s->feedback[0] ? s->feedback : "Bring the circle to the grey line, and wait",
                     s->feedback[0] && !s->good ? ethd__red : ethd__white, s->device ? "Space now   " KEYS : KEYS);
    ethd__window_end(&s->window);
    if (s->device && key == SDLK_SPACE) return ETHD_WISH_GO;
    bool stopped = s->device && s->device->stopped(s->device->self);
    if (stopped || at_start(s, &wait)) return ETHD_WISH_GO;
  }
  return ETHD_WISH_STOP;
}

/* ---- a tap ---- */

static void show(ethd__screen *s, double t, ethd_vec finger) {
  ethd__draw_room(s, finger, t);
  ethd__draw_words(s, "Tap", ethd__green, "");
  ethd__window_end(&s->window);
}

static bool show_tap(void *self, double t, ethd_vec finger) {
  ethd__screen *s = self;
  if (begin(s)) show(s, t, finger);
  return !s->stop;
}

ethd__watcher ethd__screen_watcher(ethd__screen *s) { return (ethd__watcher){s, show_tap}; }

static void follow(ethd__screen *s, ethd__live *live, ethd_vec from) {
  ethd__glimpse g = {.finger = from};
  while (ethd__live_look(live, &g)) {
    (void)begin(s);
    if (s->stop) break;
    ethd__live_lead(live, ethd__draw_finger(s));
    show(s, g.t, g.finger);
  }
}

static ethd_status tap(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__screen *s = self;
  ethd__live live;
  ethd_vec from = {s->frame.start, (s->frame.bottom + s->frame.top) / 2};
  ethd_status status = ethd__desk_prepare(s->desk, turn, out, message);
  if (status) return status;
  status = ethd__live_start(&live, &s->desk->stage, out->speed, out->tap, from, SECONDS_MAX);
  if (!status) {
    follow(s, &live, from);
    status = ethd__live_join(&live);
  }
  if (status) return ethd__say(message, status, "the tap: %s", ethd_status_sentence(status));
  s->late += live.late;
  ethd__stage_judge(&s->desk->stage, &live.rule, &live.tap, &out->result);
  return ETHD_OK;
}

static void verdict(void *self, const char *participant, const ethd__taken *taken, uint32_t valid, uint32_t wanted) {
  ethd__screen *s = self;
  ethd__reason reason = taken->result.metrics.reason;
  (void)participant;
  s->good = reason == ETHD_TAP_OK;
  snprintf(s->feedback, sizeof s->feedback, wanted ? "%s   (%u of %u)" : "%s", ethd__advice(reason), valid, wanted);
}

/* ---- a device that has stopped itself ---- */

static bool stopped(void *self, const char *why) {
  ethd__screen *s = self;
  page(s, "The device has stopped itself", why, "Space: I have seen to it   Esc stops");
  return !s->stop;
}

/* ---- the survey ---- */

/* "Question? 1 this, 2 that, ..": the question above, a line for each answer. */
static void draw_question(ethd__window *w, const char *question) {
  char text[256], next[8];
  const char *from = strchr(question, '?') + 1;
  snprintf(text, sizeof text, "%.*s", (int)(from - question), question);
  ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, 0.2 * w->height, text, ethd__white);
  for (int k = 1; k <= 5; k++) {
    snprintf(next, sizeof next, ", %d ", k + 1);
    const char *to = strstr(from, next);
    snprintf(text, sizeof text, "%d   %.*s", k, (int)(to ? to - from - 3 : 200), from + 3);
    ethd__window_text(w, ETHD_TEXT_LARGE, w->width / 2.0, (0.38 + 0.08 * k) * w->height, text, ethd__green);
    from = to ? to + 1 : from;
  }
}

static bool ask(ethd__screen *s, int number, int *answer) {
  ethd__window *w = &s->window;
  for (;;) {
    if (!begin(s)) return false;
    if (w->key >= SDLK_1 && w->key <= SDLK_5) return *answer = (int)(w->key - SDLK_0), true;
    if (w->key >= SDLK_KP_1 && w->key <= SDLK_KP_5) return *answer = (int)(w->key - SDLK_KP_1) + 1, true;
    if (w->key == SDLK_BACKSPACE) return false;
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.02 * w->height, s->title, ethd__grey);
    draw_question(w, ethd__questions[number]);
    ethd__window_text(w, ETHD_TEXT_SMALL, w->width / 2.0, 0.95 * w->height, "1 to 5   Backspace: no answer",
                      ethd__grey);
    ethd__window_end(w);
  }
}

static bool survey(void *self, const ethd__turn *turn, int answers[3]) {
  (void)turn;
  for (int i = 0; i < 3; i++)
    if (!ask(self, i, &answers[i])) return false;
  return true;
}

/* ---- open and close ---- */

ethd_status ethd__screen_open(ethd__screen *s, ethd__desk *desk, const ethd__source *device, int width, int height,
                              char message[ETHD_MESSAGE_MAX]) {
  memset(s, 0, sizeof *s);
  s->desk = desk;
  s->device = device;
  s->protocol = desk->protocol;
  ethd_status status = ethd__window_open(&s->window, "ethd-study", width, height, message);
  if (status) return status;
  ethd__draw_fit(s);
  const ethd__room *f = &s->frame;
  ethd_vec zero = ethd__room_pixel(f, (ethd_vec){0, 0});
  printf("screen %d x %d: x_px = %.6g + %.6g x_m, y_px = %.6g - %.6g y_m; start %.6g %.6g, wall %.6g\n", f->width,
         f->height, zero.x, f->scale, zero.y, f->scale, f->start, (f->bottom + f->top) / 2, f->left);
  fflush(stdout);
  return ETHD_OK;
}

ethd__source ethd__screen_source(ethd__screen *s) { return (ethd__source){.self = s, .tap = tap}; }
ethd__front ethd__screen_front(ethd__screen *s) { return (ethd__front){s, block, verdict, wish, stopped, survey}; }

void ethd__screen_end(ethd__screen *s, bool over) {
  const ethd_histogram *h = &s->window.frames;
  if (over) {
    s->stop = false;
    page(s, "That was all. Thank you!", "", "Space ends");
  }
  printf("frames     p50 %7.3f  p99 %7.3f  max %7.3f ms, %llu shown, %llu late ticks\n",
         1e-6 * (double)ethd_histogram_at(h, 0.5), 1e-6 * (double)ethd_histogram_at(h, 0.99), 1e-6 * (double)h->max,
         (unsigned long long)h->count, (unsigned long long)s->late);
}

void ethd__screen_close(ethd__screen *s) { ethd__window_close(&s->window); }
