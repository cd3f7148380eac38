/* The files that ethd-tap writes: the CSV, a recording of every tick, traces of typical taps. */
#ifndef ETHD__APPS_TAP_OUTPUT_H
#define ETHD__APPS_TAP_OUTPUT_H

#include "tap/summary.h"
#include "tap/ticks.h"
#include "text/csv.h"

/* The CSV has a row per tap: `speed` as given, `valid` 1 or 0; an undefined figure is empty. */
#define ETHD_TAP_HEADER                                                                            \
  "tap,transition,speed,seed,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,delta_s_ms,eps_m," \
  "t_rvo_s,t_of_s,peak_force_n,v_hand_mps,touch_depth_m,eps_felt_m,v_of_tick_mps,d_max_ring_m"

/* The folder of the ticks holds taps.csv (ETHD_TAP_HEADER) too. */
typedef struct ethd__output {
  ethd_csv_out *csv, *taps;
  ethd__ticks ticks;
} ethd__output;

/* The paths of the files; NULL: not written. */
typedef struct ethd__output_paths {
  const char *csv, *folder;
  bool replace; /* a recording in the folder */
} ethd__output_paths;

ETHD_MUST_CHECK ethd_status ethd__output_open(const ethd__output_paths *paths, const ethd_config *config,
                                              ethd__output *out, char message[ETHD_MESSAGE_MAX]);

/* Announces the stage of the next taps. */
ETHD_MUST_CHECK ethd_status ethd__output_law(ethd__output *output, const ethd__stage *stage,
                                             char message[ETHD_MESSAGE_MAX]);

/* Writes the stage's last tap. */
ETHD_MUST_CHECK ethd_status ethd__output_tap(ethd__output *output, const ethd__stage *stage, const char *law,
                                             const ethd__speed *speed, uint64_t tap, const ethd__result *result,
                                             char message[ETHD_MESSAGE_MAX]);

/* Completes the files and moves them to their paths. */
ETHD_MUST_CHECK ethd_status ethd__output_close(ethd__output *output, char message[ETHD_MESSAGE_MAX]);

#endif
