/* Rows of a study's tables. All [main]. */
#ifndef ETHD_STUDY_ROW_H
#define ETHD_STUDY_ROW_H

#include "study/source.h"

#define ETHD_STUDY_TAPS_HEADER                                                                        \
  "participant,block,part,attempt,transition,speed,seed,tap,valid,reason,v_rvo_mps,v_of_mps,d_max_m," \
  "v_rmin_mps,delta_s_ms,eps_m,t_rvo_s,t_of_s,t_seen_s,peak_force_n,finger_radius_m,commanded_mps"
#define ETHD_STUDY_SURVEY_HEADER "participant,block,transition,speed,q1,q2,q3"
#define ETHD_STUDY_EVENTS_HEADER "utc,participant,block,event,detail"

#define ETHD_STUDY_ID_MAX 16

/* P01, P02, .. with as many digits as the number of participants needs, two at least. */
void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]);

/* The row of taps.csv without its line end; freed by the caller, NULL: no memory. */
char *ethd__tap_row(const ethd__protocol *protocol, const ethd__taken *taken);

/* The cells of a row of taps.csv that a resumed session needs. */
typedef struct ethd__tap_key {
  uint32_t person, attempt;
  size_t number;
  bool valid;
} ethd__tap_key;

/* False when it is no row of this study. */
bool ethd__tap_row_key(const char *row, ethd__tap_key *out);

/* "12,training," of P12's block and the like: false at the end of the cells. Advances *row past the cell. */
bool ethd__row_cell(const char **row, char *out, size_t room);

#endif
