/* A tap on the screen: the pointer's on the simulated device, or a device's own. */
#include <math.h>

#include "clock.h"
#include "screen/draw.h"
#include "text/error_text.h"

#define SECONDS_MAX 6.0 /* s of a tap */

static void show(ethd__screen *s, double t, ethd_vec finger) {
  ethd__page page = {.title = s->title, .keys = "", .below = ethd__draw_floor(s)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, ethd__screen_words(s, ETHD_PHRASE_TAP), ethd__green);
  ethd__page_draw(&s->window, &page);
  ethd__draw_room(s, finger, t);
  ethd__window_end(&s->window);
}

static void begin_tap(ethd__screen *s, ethd_vec from) {
  s->from = from;
  s->left = false;
  s->pending = 0;
}

/* A frame of a tap. False: the tap must end, because somebody pressed a key for it, or because the finger hasn't moved
   and the time is over. Then there was no tap. */
static bool goes_further(ethd__screen *s, double t) {
  static const int keys[] = {SDLK_p, SDLK_n, SDLK_a, 0};
  if (!ethd__screen_begin(s)) return false;
  s->left |= ethd_vec_norm(ethd_vec_sub(ethd__draw_finger(s), s->from)) > ETHD_SCREEN_NEAR;
  if (ethd__key_is_one_of(s->window.key, keys)) s->pending = s->window.key;
  return !s->pending && (s->left || t < SECONDS_MAX - 0.2);
}

static bool show_tap(void *self, double t, ethd_vec finger) {
  ethd__screen *s = self;
  if (!(t > 0)) begin_tap(s, ethd__draw_finger(s));
  if (!goes_further(s, t)) return false;
  show(s, t, finger);
  return true;
}

ethd__watcher ethd__screen_watcher(ethd__screen *s) { return (ethd__watcher){s, show_tap}; }

void ethd__screen_moved(void *self, int64_t ns) {
  ethd__screen *s = self;
  if (s->live) ethd__live_lead(s->live, ns, ethd__draw_finger(s));
}

/* Marks the first touch once it is seen. */
static void mark_touch(const ethd__screen *s, const ethd__turn *turn, const ethd__live *live, const ethd__glimpse *g,
                       bool *marked) {
  if (*marked || isnan(g->touch)) return;
  *marked = true;
  ethd__markers_send(s->desk->markers, "contact", turn, live->began_ns + llrint(1e9 * g->touch), "-");
}

/* False: there was no tap. */
static bool follow(ethd__screen *s, const ethd__turn *turn, ethd__live *live, ethd_vec from) {
  ethd__glimpse g = {.finger = from, .touch = NAN};
  bool goes = true, marked = false;
  s->live = live;
  ethd__markers_send(s->desk->markers, "trial-begin", turn, live->began_ns, "-");
  ethd__live_lead(live, ethd__clock_now(), ethd__draw_finger(s));
  while (goes && ethd__live_look(live, &g)) {
    mark_touch(s, turn, live, &g, &marked);
    goes = goes_further(s, g.t);
    if (goes) show(s, g.t, g.finger);
  }
  s->live = NULL;
  return goes && s->left;
}

static ethd_status tap(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__screen *s = self;
  ethd__live live;
  const ethd_vec from = s->frame.start;
  bool done = false;
  ethd_status status = ethd__desk_prepare(s->desk, turn, out, message);
  if (status) return status;
  begin_tap(s, from);
  status = ethd__live_start(&live, &s->desk->stage, out->speed, out->tap, from, SECONDS_MAX);
  if (!status) {
    done = follow(s, turn, &live, from);
    status = ethd__live_join(&live);
  }
  if (status) return ethd__say(message, status, "the tap: %s", ethd_status_sentence(status));
  if (!done) return ETHD_STATUS_EMPTY;
  s->late += live.late;
  out->hand = ETHD_HAND_MOUSE;
  ethd__stage_judge(&s->desk->stage, &live.rule, &live.tap, &out->result);
  return ETHD_OK;
}

ethd__source ethd__screen_source(ethd__screen *s) {
  return (ethd__source){.self = s, .hand = ETHD_HAND_MOUSE, .tap = tap};
}
