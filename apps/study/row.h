/* Rows of a study's tables. All [main]. */
#ifndef ETHD__APPS_STUDY_ROW_H
#define ETHD__APPS_STUDY_ROW_H

#include "study/source.h"

#define ETHD_STUDY_ID_MAX 16

/* Writes P01, P02, .. with as many digits as the number of participants needs, two at least. */
void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]);

/* Returns the row of taps.csv, its cells as ethd__table_header has them, without its line end. The caller frees it;
   NULL: no memory. */
char *ethd__tap_row(const ethd__protocol *protocol, const ethd__taken *taken);

/* The cells of a row of taps.csv that a resumed session and the table of participants need. */
typedef struct ethd__tap_key {
  uint32_t person, attempt;
  size_t number;
  bool training, valid;
  ethd__hand_source hand;
  char utc[ETHD_UTC_MAX];
} ethd__tap_key;

/* Returns whether this is a row of an earlier version, which lacks the last two cells, by_ring and by_finger. */
bool ethd__tap_row_is_short(const char *row);

/* Reads them; false: it is no row of this study. */
bool ethd__tap_row_key(const char *row, ethd__tap_key *out);

/* Takes the next cell of a row whose cells need no quotes, and advances *row past it; false at the end of the cells. */
bool ethd__row_cell(const char **row, char *out, size_t room);

#endif
