#include "study/row.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/csv.h"

void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]) {
  int digits = 2;
  for (uint32_t n = protocol->participants; n > 99; n /= 10) digits++;
  snprintf(out, ETHD_STUDY_ID_MAX, "P%0*" PRIu32, digits, person + 1);
}

char *ethd__tap_row(const ethd__protocol *protocol, const ethd__taken *taken) {
  const ethd__turn *turn = &taken->turn;
  const ethd__metrics *m = &taken->result.metrics;
  const double figures[] = {m->v_rvo,
                            m->v_of,
                            m->d_max,
                            m->v_rmin,
                            m->delta_s,
                            m->eps,
                            m->t_rvo,
                            m->t_of,
                            m->t_seen,
                            m->peak_force,
                            taken->result.finger_radius,
                            taken->result.commanded,
                            m->v_hand,
                            m->touch_depth,
                            m->eps_felt};
  char id[ETHD_STUDY_ID_MAX], *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) return NULL;
  ethd__participant_id(protocol, turn->person, id);
  fprintf(file, "%s,%zu,%s,%" PRIu32 ",%s,%s,%" PRIu64 ",%" PRIu64 ",%d,%s", id, turn->number,
          turn->block.training ? "training" : "test", turn->attempt, protocol->strategies.word[turn->block.strategy],
          protocol->speeds.word[turn->block.speed], taken->seed, taken->tap, m->reason == ETHD_TAP_OK,
          ethd__reason_words[m->reason]);
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
    if (isnan(figures[i]))
      fputc(',', file);
    else
      fprintf(file, ",%.17g", figures[i]);
  fprintf(file, ",%s,", ethd__hand_words[taken->hand]);
  ethd__csv_put_word(file, taken->movement ? taken->movement : "");
  fprintf(file, ",%s,%s,%s", taken->utc, ethd__reason_words[m->by_ring], ethd__reason_words[m->by_finger]);
  bool failed = ferror(file);
  if (fclose(file) == 0 && !failed) return text;
  free(text);
  return NULL;
}

bool ethd__row_cell(const char **row, char *out, size_t room) {
  size_t n = strcspn(*row, ",");
  if (!**row || n >= room) return false;
  memcpy(out, *row, n);
  out[n] = 0;
  *row += n + ((*row)[n] == ',');
  return true;
}

static bool count_of(const char *cell, unsigned long long most, unsigned long long *out) {
  *out = strtoull(cell, NULL, 10);
  return *cell && !cell[strspn(cell, "0123456789")] && *out >= 1 && *out <= most;
}

static bool is_reason(const char *cell) {
  for (int i = 0; i < ETHD_TAP_REASON_COUNT; i++)
    if (!strcmp(cell, ethd__reason_words[i])) return true;
  return false;
}

bool ethd__tap_row_is_short(const char *row) {
  const char *last = strrchr(row, ',');
  return !last || !is_reason(last + 1);
}

/* Copies the cell that ends at `end` and returns the comma before it; NULL if the cell doesn't fit. */
static const char *cell_before(const char *row, const char *end, char *out, size_t room) {
  const char *comma = end;
  while (comma > row && comma[-1] != ',') comma--;
  if (comma == row || (size_t)(end - comma) >= room) return NULL;
  snprintf(out, room, "%.*s", (int)(end - comma), comma);
  return comma - 1;
}

/* Reads hand,movement,utc,by_ring,by_finger, which follow the figures; rows of earlier versions lack the last two. Only
   the movement can have quotes, so the cells behind it are read from the end. False: there is no such hand. */
static bool read_end(const char *row, ethd__tap_key *out) {
  char word[24];
  int hand = 0;
  enum { FIGURES = 15 };
  for (int i = 0; i < FIGURES && *row; i++) row += strcspn(row, ",") + (row[strcspn(row, ",")] == ',');
  const char *end = row + strlen(row);
  for (int i = 0; end && i < 2 && !ethd__tap_row_is_short(row); i++) end = cell_before(row, end, word, sizeof word);
  if (!end || !cell_before(row, end, out->utc, sizeof out->utc)) return false;
  if (!ethd__row_cell(&row, word, sizeof word)) return false;
  while (hand < ETHD_HAND_SOURCES && strcmp(word, ethd__hand_words[hand])) hand++;
  out->hand = (ethd__hand_source)hand;
  return hand < ETHD_HAND_SOURCES;
}

bool ethd__tap_row_key(const char *row, ethd__tap_key *out) {
  enum { PARTICIPANT, BLOCK, PART, ATTEMPT, TRANSITION, SPEED, SEED, TAP, VALID, REASON, CELLS };
  char cell[CELLS][40];
  unsigned long long person, number, attempt;
  for (int i = 0; i < CELLS; i++)
    if (!ethd__row_cell(&row, cell[i], sizeof cell[i])) return false;
  if (cell[PARTICIPANT][0] != 'P' || !count_of(cell[PARTICIPANT] + 1, ETHD_STUDY_PEOPLE, &person) ||
      !count_of(cell[BLOCK], ETHD_STUDY_BLOCKS, &number) || !count_of(cell[ATTEMPT], UINT32_MAX, &attempt))
    return false;
  *out = (ethd__tap_key){.person = (uint32_t)person - 1,
                         .attempt = (uint32_t)attempt,
                         .number = (size_t)number,
                         .training = !strcmp(cell[PART], "training"),
                         .valid = cell[VALID][0] == '1'};
  return read_end(row, out);
}
