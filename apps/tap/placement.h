/* A recorded movement as the hand's voluntary path: it is shifted, never bent.

       y ^    recording, moving to -x
         |        . - ' - .                      shifted in x and y so that at t_touch the finger's
         |      .           ' - . _              centre is where a finger touches the wall
      P  o<-- t_touch               start
     ////|      the first instant after the peak at which the speed toward the wall has fallen to
                the wanted one; the peak itself when it never was that fast

   Speed toward the wall at a sample: minus the slope in x of the least-squares line through the samples
   within 5 ms of it, at least one on either side (central differences below 200 Hz); between samples it
   is linear. Nothing filters the path. */
#ifndef ETHD__APPS_TAP_PLACEMENT_H
#define ETHD__APPS_TAP_PLACEMENT_H

#include <stdbool.h>

#include "ethd/sim.h"

#define ETHD_MOVEMENT_WINDOW 5e-3  /* s, either side */
#define ETHD_MOVEMENT_MOST 120.0   /* s of recording that are accepted */
#define ETHD_MOVEMENT_FASTEST 10.0 /* m/s: a faster hand is in another unit */

/* How a file writes a movement. */
typedef struct ethd__movement_form {
  const char *columns[3]; /* names of time, x and y; a '-' before a name reverses the axis */
  double time, length;    /* s and m in one unit of the file */
} ethd__movement_form;

extern const ethd__movement_form ethd__movement_si; /* t_s,x_m,y_m */

/* A movement in s and m. Its time starts at 0. */
typedef struct ethd__movement {
  ethd_path_sample *samples;
  size_t count;
} ethd__movement;

/* Reads a CSV file. Refuses, with file:line: a column that isn't there, cells empty or not finite, times that don't
   rise, fewer than 3 samples, more than ETHD_MOVEMENT_MOST, positions beyond 1 km, a hand faster than
   ETHD_MOVEMENT_FASTEST. Refuses also a movement away from the wall: its top speed to -x is below a fifth of that to +x
   (0.37 is the least of 336 recorded reaches and taps). */
ETHD_MUST_CHECK ethd_status ethd__movement_load(const char *path, const ethd__movement_form *form, ethd__movement *out,
                                                char message[ETHD_MESSAGE_MAX]);
void ethd__movement_free(ethd__movement *movement);

/* Returns the speed toward the wall at sample k, m/s. */
double ethd__movement_speed(const ethd__movement *movement, size_t k);

/* The point at which the movement has slowed to a speed. */
typedef struct ethd__touchdown {
  double t;        /* s of the movement */
  ethd_vec x;      /* m, as recorded */
  bool never_fast; /* it was never that fast; t is the peak's */
} ethd__touchdown;

void ethd__movement_touchdown(const ethd__movement *movement, double speed, ethd__touchdown *out);

/* Fills out[0..movement->count) with the samples shifted so that the finger's centre is at `centre` at the touchdown,
   from its last entry into the arm's reach before that to its next exit. Returns their number (the path is held at the
   end), or 0 if the touchdown is out of reach. Time starts at 0 with the first sample. */
size_t ethd__movement_place(const ethd__movement *movement, const ethd__touchdown *touchdown, ethd_vec centre,
                            const ethd_arm *arm, ethd_path_sample *out);

/* Lists the file alone, or every *.csv of a folder by name; ethd__movements_free frees the list. */
ETHD_MUST_CHECK ethd_status ethd__movements_list(const char *path, char ***files, size_t *count,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Lists the files of a folder, and refuses any other path. */
ETHD_MUST_CHECK ethd_status ethd__movements_in(const char *folder, char ***files, size_t *count,
                                               char message[ETHD_MESSAGE_MAX]);
void ethd__movements_free(char **files, size_t count);

#endif
