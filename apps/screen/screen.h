/* The study's screen: a black free space with a thick green contour, a white circle for the finger, a start
   line, a speed cue, and what to do. The mouse is the finger, on the simulated device; everything else is
   keys. Participants aren't told which strategy it is. All [main]. */
#ifndef ETHD_SCREEN_SCREEN_H
#define ETHD_SCREEN_SCREEN_H

#include "screen/live.h"
#include "screen/view.h"
#include "screen/window.h"
#include "study/desk.h"
#include "study/front.h"

typedef struct ethd__screen {
  ethd__window window;
  ethd__desk *desk;
  const ethd__source *device; /* has a finger of its own; NULL: the pointer is it, on the simulated device */
  const ethd__protocol *protocol;
  ethd__room frame;
  ethd_vec avatar;   /* as drawn last */
  ethd__speed speed; /* of the present block */
  char title[96], feedback[160];
  bool good, stop, told; /* told: the block's page was read */
  size_t blocks;         /* of the participant */
  uint64_t late;         /* ticks */
} ethd__screen;

/* device: where the finger and the taps come from; NULL: the mouse. It outlives the screen. */
ETHD_MUST_CHECK ethd_status ethd__screen_open(ethd__screen *screen, ethd__desk *desk, const ethd__source *device,
                                              int width, int height, char message[ETHD_MESSAGE_MAX]);

/* Taps with the mouse. */
ethd__source ethd__screen_source(ethd__screen *screen);

/* Shows a device's taps while they are done. */
ethd__watcher ethd__screen_watcher(ethd__screen *screen);
ethd__front ethd__screen_front(ethd__screen *screen);

/* The last page; then how long frames took, as a line on stdout. */
void ethd__screen_end(ethd__screen *screen, bool over);
void ethd__screen_close(ethd__screen *screen);

#endif
