/* The study's screen: a black free space with a thick green contour, a white circle for the finger, a start
   line, a speed cue, and instructions. The mouse is the finger, on the simulated device; all other input is keys.
   Participants don't learn the strategy. All [main]. */
#ifndef ETHD__APPS_SCREEN_SCREEN_H
#define ETHD__APPS_SCREEN_SCREEN_H

#include "screen/live.h"
#include "screen/page.h"
#include "screen/view.h"
#include "study/desk.h"
#include "study/front.h"

#define ETHD_SCREEN_NEAR 0.004 /* m: a finger within this distance of a place counts as there */

typedef struct ethd__screen {
  ethd__window window;
  ethd__desk *desk;
  const ethd__source *device; /* has a finger of its own; NULL: the pointer is the finger, on the simulated device */
  const ethd__protocol *protocol;
  ethd__live *live; /* the tap that the pointer leads now, NULL: none */
  ethd__room frame;
  ethd_vec avatar;   /* as drawn last */
  ethd__speed speed; /* of the present block */
  char title[200];
  char feedback[200], achieved[250]; /* of the last tap: result, speed, and verdict; "": none yet */
  ethd_vec from;                     /* the finger's place at the tap's beginning */
  bool left;                         /* it has left the place since */
  int pending;                       /* a key that ended a tap and isn't handled yet */
  bool good, stop;
  uint64_t late; /* ticks */
} ethd__screen;

/* Opens the screen. device: the source of finger and taps; NULL: the mouse. It outlives the screen. */
ETHD_MUST_CHECK ethd_status ethd__screen_open(ethd__screen *screen, ethd__desk *desk, const ethd__source *device,
                                              int width, int height, char message[ETHD_MESSAGE_MAX]);

/* Describes the window, its display and the scale, in words for the study's record. */
void ethd__screen_describe(const ethd__screen *screen, char out[ETHD_MESSAGE_MAX]);

/* Returns the source of taps with the mouse. */
ethd__source ethd__screen_source(ethd__screen *screen);

/* Returns a watcher that shows a device's running taps. */
ethd__watcher ethd__screen_watcher(ethd__screen *screen);
ethd__front ethd__screen_front(ethd__screen *screen);

/* Shows the last page, then prints a line with the durations of frames. */
void ethd__screen_end(ethd__screen *screen, bool over);
void ethd__screen_close(ethd__screen *screen);

/* ---- within the screen ---- */

/* Begins a frame; returns false after a request to stop. */
bool ethd__screen_begin(ethd__screen *screen);

/* Shows the page frame by frame until one of the keys is pressed (SDLK_.., 0 ends the list) or somebody stops, which
   gives SDLK_ESCAPE. */
int ethd__screen_page(ethd__screen *screen, const ethd__page *page, const int *keys);

/* Returns words of the screen, in the study's language. */
const char *ethd__screen_words(const ethd__screen *screen, ethd__phrase_name name);

/* Returns whether the key is in the list, which ends with 0. */
bool ethd__key_is_one_of(int key, const int *keys);

/* Passes the pointer's motion to the tap that follows it, if any. */
void ethd__screen_moved(void *screen, int64_t ns);

/* Reads a typed line under the page's words. True: Enter ended it. False: Escape or F2, in window.key, or a request to
   stop. */
bool ethd__screen_type(ethd__screen *screen, const ethd__page *page, char *line, size_t room);

/* Shows a text of any length on pages; Space and Backspace change the page. Ends with one of the keys `ends`, on the
   last page, or with a request to stop, which gives SDLK_ESCAPE. */
int ethd__screen_read(ethd__screen *screen, const char *text, const char *title, const char *keys, const int *ends);

/* Parts of the front, see study/front.h. */
ethd__wish ethd__screen_meet(void *screen, const ethd__meeting *meeting);
int ethd__screen_ask(void *screen, const ethd__asked *asked);

/* Shows the room between taps, or after a block's last one (`over`): the last one's result, and the next action. */
void ethd__screen_waiting(ethd__screen *screen, bool over, ethd_vec finger, double seconds);

/* Their pages; `typed` is the line so far, `text` room for words. */
void ethd__page_of_hand_over(const ethd__questionnaire *q, const ethd__meeting *meeting, const char *typed,
                             ethd__page *out, char text[256]);
void ethd__page_of_question(const ethd__question *question, int chosen, ethd__page *out,
                            char text[ETHD_STUDY_ANSWERS][256]);
void ethd__page_of_answers(const ethd__questionnaire *q, const ethd__asked *asked, ethd__page *out,
                           char text[ETHD_STUDY_QUESTIONS][256]);

#endif
