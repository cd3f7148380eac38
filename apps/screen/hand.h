/* A hand that follows the pointer during the simulation: a recorded path whose samples are written shortly before they
   are reached. One thread.

        pointer's events   .    .      .   .                 the pointer's position between two of its events
                           |----\\----|                       is interpolated linearly
        hand's samples       x   x   x   x  x                a low-pass smooths the pointer's whole pixels

   Between the pointer and the hand lie ETHD_HAND_LEAD samples and ETHD_HAND_DELAY, 36 ms in all. A pointer that is led
   at a steady speed leads the hand at that speed: within 8 % at any instant if the mouse sends 60 events a
   second or more, up to 1 ms late, and a pixel is 0.3 mm or less; within 0.2 % over 0.4 s. */
#ifndef ETHD__APPS_SCREEN_HAND_H
#define ETHD__APPS_SCREEN_HAND_H

#include "ethd/sim.h"

#define ETHD_HAND_STEP 0.006  /* s between samples */
#define ETHD_HAND_LEAD 3      /* samples: those of the path's slopes, and one */
#define ETHD_HAND_DELAY 0.018 /* s: the pointer's next event has come by then, if it moves */
#define ETHD_HAND_EVENTS 32   /* of the pointer, the last ones */

typedef struct ethd__hand_event {
  double t; /* s of the tap; events before it count too */
  ethd_vec x;
} ethd__hand_event;

typedef struct ethd__hand {
  ethd_path_sample *samples;
  size_t count, written; /* written: later samples repeat the last one */
  ethd_vec smooth;
  ethd__hand_event event[ETHD_HAND_EVENTS]; /* a ring */
  size_t events;                            /* number of events so far */
} ethd__hand;

/* Creates a hand that stays at x for `seconds` unless led. ETHD_E_MEMORY. */
ETHD_MUST_CHECK ethd_status ethd__hand_create(ethd__hand *hand, ethd_vec x, double seconds);
void ethd__hand_free(ethd__hand *hand);

ethd_path ethd__hand_path(const ethd__hand *hand);

/* Adds the pointer's arrival at x at t, which never decreases. */
void ethd__hand_move(ethd__hand *hand, double t, ethd_vec x);

/* Leads the hand. Called before the step that begins at t, with all events up to t. */
void ethd__hand_lead(ethd__hand *hand, double t);

#endif
