#include "screen/screen.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "screen/console.h"
#include "screen/draw.h"
#include "screen/letters.h"
#include "text/error_text.h"

#define STILL 0.5    /* s at the start line */
#define SETTLED 0.02 /* m/s */

static const int goes_on[] = {SDLK_SPACE, SDLK_RETURN, 0};

const char *ethd__screen_words(const ethd__screen *s, ethd__phrase_name name) {
  return ethd__phrase_of(&s->protocol->questionnaire, name);
}

#define WORDS(name) ethd__screen_words(s, ETHD_PHRASE_##name)

/* The phrase with these numbers in its places. */
static void fill(const ethd__screen *s, ethd__phrase_name name, const char *format, const double *numbers, size_t count,
                 char *out, size_t room) {
  char text[3][24];
  const char *values[3];
  for (size_t i = 0; i < count; i++) {
    snprintf(text[i], sizeof text[i], format, numbers[i]);
    values[i] = text[i];
  }
  ethd__phrase_fill(out, room, ethd__screen_words(s, name), values, count);
}

/* ---- frames ---- */

bool ethd__screen_begin(ethd__screen *s) {
  ethd__window_begin(&s->window);
  ethd__draw_fit(s);
  if (s->window.closed || s->window.key == SDLK_ESCAPE || ethd__stop) s->stop = true;
  return !s->stop;
}

static double now(void) { return (double)SDL_GetPerformanceCounter() / (double)SDL_GetPerformanceFrequency(); }

bool ethd__key_is_one_of(int key, const int *keys) {
  while (*keys && *keys != key) keys++;
  return *keys != 0;
}

int ethd__screen_page(ethd__screen *s, const ethd__page *page, const int *keys) {
  do {
    if (!ethd__screen_begin(s)) return SDLK_ESCAPE;
    ethd__page_draw(&s->window, page);
    ethd__window_end(&s->window);
  } while (!ethd__key_is_one_of(s->window.key, keys));
  return s->window.key;
}

/* Removes one letter, which may be several bytes. */
static size_t shorter(const char *line, size_t n) {
  while (n && (line[--n] & 0xc0) == 0x80) continue;
  return n;
}

/* The first frame's letters belong to the key that brought the line. */
bool ethd__screen_type(ethd__screen *s, const ethd__page *page, char *line, size_t room) {
  ethd__window *w = &s->window;
  for (bool first = true;; first = false) {
    ethd__window_begin(w);
    size_t n = strlen(line);
    if (w->closed || ethd__stop) s->stop = true;
    if (s->stop || w->key == SDLK_ESCAPE || w->key == SDLK_F2) return false;
    if (!first && (w->key == SDLK_RETURN || w->key == SDLK_KP_ENTER)) return true;
    if (w->key == SDLK_BACKSPACE) line[n = shorter(line, n)] = 0;
    if (!first && w->typed[0]) snprintf(line + n, room - n, "%s", w->typed);
    ethd__page with = *page;
    ethd__page_add(&with, ETHD_TEXT_LARGE, *line ? line : "_", ethd__green);
    ethd__page_draw(w, &with);
    ethd__window_end(w);
  }
}

/* ---- blocks ---- */

static void block(void *self, const char *participant, const ethd__turn *turn, bool rest) {
  ethd__screen *s = self;
  char part[96], speed[200], message[ETHD_MESSAGE_MAX];
  ethd__taken taken;
  if (!ethd__desk_prepare(s->desk, turn, &taken, message)) s->speed = *taken.speed;
  fill(s, ETHD_PHRASE_PART, "%.0f", (const double[]){(double)turn->number, (double)turn->of}, 2, part, sizeof part);
  snprintf(s->title, sizeof s->title, "%s   %s%s%s", participant, part, turn->block.training ? ", " : "",
           turn->block.training ? WORDS(PRACTICE) : "");
  fill(s, ETHD_PHRASE_SPEED, "%.2g", &s->speed.centre, 1, speed, sizeof speed);
  size_t first = s->protocol->training ? s->protocol->speeds.count + 1 : 1;
  if (s->protocol->order == ETHD_ORDER_INTERLEAVED && turn->number > first && !rest) return; /* the cue has the speed */
  s->feedback[0] = s->achieved[0] = 0;
  s->good = false;
  ethd__page page = {.title = s->title, .keys = WORDS(KEYS_GO)};
  if (rest) ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(REST), ethd__green);
  ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(TASK), ethd__white);
  ethd__page_add(&page, ETHD_TEXT_LARGE, speed, ethd__grey);
  (void)ethd__screen_page(s, &page, goes_on);
}

/* ---- before a tap ---- */

static bool write_words(ethd__screen *s, const char *what, char words[ETHD_MESSAGE_MAX]) {
  ethd__page page = {.title = s->title, .keys = WORDS(KEYS_NOTE)};
  char line[200] = "";
  ethd__page_add(&page, ETHD_TEXT_LARGE, what, ethd__grey);
  if (!ethd__screen_type(s, &page, line, sizeof line)) return false;
  snprintf(words, ETHD_MESSAGE_MAX, "%s", line);
  return *line;
}

static bool sure(ethd__screen *s) {
  ethd__page page = {.title = s->title, .keys = WORDS(KEYS_SURE)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(END_ONE), ethd__white);
  return ethd__screen_page(s, &page, (const int[]){SDLK_y, SDLK_n, SDLK_SPACE, 0}) == SDLK_y;
}

/* How long the finger has stood at the start line, s. */
typedef struct waiting {
  ethd_vec last;
  double since, before;
} waiting;

static bool at_start(const ethd__screen *s, waiting *wait) {
  ethd_vec x = ethd__draw_finger(s);
  double t = now();
  double speed = ethd_vec_norm(ethd_vec_sub(x, wait->last)) / fmax(t - wait->before, 1e-3);
  bool there = fabs(x.x - s->frame.start.x) < ETHD_SCREEN_NEAR && fabs(x.y - s->frame.start.y) < ETHD_SCREEN_NEAR &&
               speed < SETTLED;
  wait->last = x;
  wait->before = t;
  if (!there) wait->since = t;
  return t - wait->since > STILL;
}

void ethd__screen_waiting(ethd__screen *s, bool over, ethd_vec finger, double seconds) {
  const char *now = over ? WORDS(KEYS_GO) : s->device ? WORDS(KEYS_NOW) : "", *check = s->good ? WORDS(KEYS_CHECK) : "";
  char keys[800];
  snprintf(keys, sizeof keys, "%s%s%s%s%s", now, *now ? "   " : "", check, *check ? "   " : "",
           over ? "" : WORDS(KEYS_WAIT));
  ethd__page page = {.title = s->title, .keys = keys, .below = ethd__draw_floor(s)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, s->feedback, s->good ? ethd__green : ethd__red);
  ethd__page_add(&page, ETHD_TEXT_SMALL, s->achieved, s->good ? ethd__green : ethd__red);
  if (!over) ethd__page_add(&page, ETHD_TEXT_SMALL, WORDS(READY), ethd__white);
  ethd__page_draw(&s->window, &page);
  ethd__draw_room(s, finger, seconds);
}

static ethd__wish pause_page(ethd__screen *s) {
  ethd__page page = {.title = s->title, .keys = WORDS(KEYS_GO)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(PAUSE), ethd__white);
  (void)ethd__screen_page(s, &page, goes_on);
  return s->stop ? ETHD_WISH_STOP : ETHD_WISH_PAUSE;
}

/* The action of the experimenter's key on the latest tap; GO: none. */
static ethd__wish check(ethd__screen *s, int key, char words[ETHD_MESSAGE_MAX]) {
  if (key == SDLK_u) return ETHD_WISH_UNDO;
  if (!s->good || (key != SDLK_v && key != SDLK_r) || !write_words(s, WORDS(CHECK), words)) return ETHD_WISH_GO;
  return key == SDLK_v ? ETHD_WISH_ACCEPT : ETHD_WISH_REJECT;
}

static ethd__wish wish(void *self, bool over, char words[ETHD_MESSAGE_MAX]) {
  ethd__screen *s = self;
  waiting wait = {.since = now(), .before = now()};
  double start = now();
  while (ethd__screen_begin(s)) {
    int key = s->window.key ? s->window.key : s->pending;
    s->pending = 0;
    if (key == SDLK_a && sure(s)) return ETHD_WISH_ABORT;
    if (key == SDLK_n && write_words(s, WORDS(NOTE), words)) return ETHD_WISH_NOTE;
    ethd__wish wanted = check(s, key, words);
    if (wanted != ETHD_WISH_GO) return wanted;
    if (key == SDLK_p) return pause_page(s);
    if (s->stop) break;
    ethd__screen_waiting(s, over, ethd__draw_finger(s), over ? -1 : now() - start);
    ethd__window_end(&s->window);
    if ((s->device && key == SDLK_SPACE) || (over && ethd__key_is_one_of(key, goes_on))) return ETHD_WISH_GO;
    if (over) continue;
    bool stopped = s->device && s->device->stopped(s->device->self);
    if (stopped || at_start(s, &wait)) return ETHD_WISH_GO;
  }
  return ETHD_WISH_STOP;
}

/* ---- after a tap ---- */

/* The commanded speed of the tap, and the band of valid speeds. */
static void verdict(void *self, const char *participant, const ethd__taken *taken, const ethd__tally *tally) {
  ethd__screen *s = self;
  const ethd__metrics *m = &taken->result.metrics;
  const ethd__speed *speed = taken->speed;
  double v = s->protocol->validity == ETHD_TAP_BY_FINGER ? m->v_hand : m->v_rvo;
  char count[96] = "";
  (void)participant;
  s->good = m->reason == ETHD_TAP_OK;
  const double done[] = {tally->wanted ? tally->valid : tally->taken,
                         tally->wanted ? tally->wanted : s->protocol->training};
  fill(s, ETHD_PHRASE_COUNT, "%.0f", done, 2, count, sizeof count);
  snprintf(s->feedback, sizeof s->feedback, "%s   %s", ethd__screen_words(s, ethd__advised(m->reason, tally->checked)),
           count);
  s->achieved[0] = 0;
  const double speeds[] = {v, speed->centre - speed->band, speed->centre + speed->band};
  if (isfinite(v)) fill(s, ETHD_PHRASE_ACHIEVED, "%.2f", speeds, 3, s->achieved, sizeof s->achieved);
  const double checked[] = {tally->accepted, tally->rejected};
  size_t n = strlen(strcat(s->achieved, *s->achieved ? "   " : ""));
  if (tally->accepted + tally->rejected)
    fill(s, ETHD_PHRASE_CHECKED, "%.0f", checked, 2, s->achieved + n, sizeof s->achieved - n);
}

/* ---- a device that has stopped itself ---- */

static bool stopped(void *self, const char *why) {
  ethd__screen *s = self;
  ethd__page page = {.title = s->title, .keys = WORDS(KEYS_SEEN)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(STOPPED), ethd__red);
  ethd__page_add(&page, ETHD_TEXT_LARGE, why, ethd__grey);
  (void)ethd__screen_page(s, &page, goes_on);
  return !s->stop;
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
  status = ethd__letters_check(&s->protocol->questionnaire, s->window.font[ETHD_TEXT_LARGE], message);
  if (status) {
    ethd__window_close(&s->window);
    return status;
  }
  s->window.moved = ethd__screen_moved;
  s->window.mover = s;
  ethd__draw_fit(s);
  const ethd__room *f = &s->frame;
  ethd_vec zero = ethd__room_pixel(f, (ethd_vec){0, 0});
  printf("screen %d x %d: x_px = %.6g + %.6g x_m, y_px = %.6g - %.6g y_m; start %.6g %.6g, wall %.6g\n", f->width,
         f->height, zero.x, f->scale, zero.y, f->scale, f->start.x, f->start.y, f->left);
  fflush(stdout);
  return ETHD_OK;
}

void ethd__screen_describe(const ethd__screen *s, char out[ETHD_MESSAGE_MAX]) {
  SDL_DisplayMode mode = {0};
  float dpi = 0;
  int display = SDL_GetWindowDisplayIndex(s->window.window);
  if (display >= 0) (void)SDL_GetCurrentDisplayMode(display, &mode);
  if (display >= 0) (void)SDL_GetDisplayDPI(display, NULL, &dpi, NULL);
  snprintf(out, ETHD_MESSAGE_MAX,
           "window %d x %d px; display %d x %d px at %d Hz by %s, %.1f px an inch as it says; %.6g px/m drawn; start "
           "%.6g %.6g m, wall %.6g m",
           s->frame.width, s->frame.height, mode.w, mode.h, mode.refresh_rate, SDL_GetCurrentVideoDriver(), (double)dpi,
           s->frame.scale, s->frame.start.x, s->frame.start.y, s->frame.left);
}

ethd__front ethd__screen_front(ethd__screen *s) {
  return (ethd__front){s, ethd__screen_meet, block, verdict, wish, stopped, ethd__screen_ask};
}

void ethd__screen_end(ethd__screen *s, bool over) {
  const ethd_histogram *h = &s->window.frames;
  if (over) {
    ethd__page page = {.title = "", .keys = WORDS(KEYS_THANKS)};
    ethd__page_add(&page, ETHD_TEXT_LARGE, WORDS(THANKS), ethd__white);
    s->stop = false;
    (void)ethd__screen_page(s, &page, goes_on);
  }
  printf("frames     p50 %7.3f  p99 %7.3f  max %7.3f ms, %llu shown, %llu late ticks\n",
         1e-6 * (double)ethd_histogram_at(h, 0.5), 1e-6 * (double)ethd_histogram_at(h, 0.99), 1e-6 * (double)h->max,
         (unsigned long long)h->count, (unsigned long long)s->late);
}

void ethd__screen_close(ethd__screen *s) { ethd__window_close(&s->window); }
