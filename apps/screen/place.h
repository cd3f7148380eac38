/* A session's resources: its folder, its device, its screen. All [main]. */
#ifndef ETHD__APPS_SCREEN_PLACE_H
#define ETHD__APPS_SCREEN_PLACE_H

#include "screen/console.h"
#include "screen/screen.h"
#include "study/session.h"
#include "study/station.h"

typedef struct ethd__place_options {
  const char *path;    /* the session's folder */
  int64_t first, last; /* only these participants, from 1; 0: all */
  bool ask, quiet, is_virtual;
  int width, height; /* px of the screen; 0: none */
} ethd__place_options;

typedef struct ethd__screen_place {
  ethd__folder folder;
  ethd__desk desk;
  ethd__station station;
  ethd__screen screen;
  ethd__console console;
  ethd__sitting sitting;
  ethd__markers markers;
  ethd__source device; /* the one with people's fingers; without it `self` is NULL */
  bool has_screen;
} ethd__screen_place;

/* Opens everything but the markers, which are open before a new folder is made. Ends the program before any motion, on
   bad input or if device or window can't be opened. */
void ethd__place_open(const ethd__place_options *options, ethd__screen_place *out);

/* Runs until all is done or somebody stops it; on return the device is at rest and closed. */
ETHD_MUST_CHECK ethd_status ethd__place_run(ethd__screen_place *place, bool *over, char message[ETHD_MESSAGE_MAX]);

void ethd__place_close(ethd__screen_place *place);

#endif
