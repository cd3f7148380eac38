#include "study/row.h"

#include <inttypes.h>
#include <stdio.h>

#include "store/schema.h"
#include "text/csv.h"

#define HASH_DIGITS 12 /* that tell a simulation's study */

void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]) {
  int digits = 2;
  for (uint32_t n = protocol->participants; n > 99; n /= 10) digits++;
  snprintf(out, ETHD_STUDY_ID_MAX, "P%0*" PRIu32, digits, person + 1);
}

/* ---- into the store ---- */

static void bind_figures(sqlite3_stmt *query, int first, const ethd__result *result) {
  const ethd__metrics *m = &result->metrics;
  const double figures[ETHD_STORE_FIGURE_COUNT] = {m->v_rvo,
                                                   m->v_of,
                                                   m->d_max,
                                                   m->v_rmin,
                                                   m->delta_s,
                                                   m->eps,
                                                   m->t_rvo,
                                                   m->t_of,
                                                   m->t_seen,
                                                   m->peak_force,
                                                   result->finger_radius,
                                                   result->commanded,
                                                   m->v_hand,
                                                   m->touch_depth,
                                                   m->eps_felt};
  for (int i = 0; i < ETHD_STORE_FIGURE_COUNT; i++) sqlite3_bind_double(query, first + i, figures[i]); /* NaN: NULL */
}

static void bind_word(sqlite3_stmt *query, int column, const char *word) {
  sqlite3_bind_text(query, column, word, -1, SQLITE_TRANSIENT);
}

ethd_status ethd__tap_put(ethd__study_store *store, size_t point, const ethd__taken *taken,
                          char message[ETHD_MESSAGE_MAX]) {
  static const char insert[] =
      "INSERT INTO tap (" ETHD_STORE_TAP ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, "
      "?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22, ?23, ?24, ?25, ?26, ?27, ?28)";
  const ethd__metrics *m = &taken->result.metrics;
  const ethd__turn *turn = &taken->turn;
  char seed[24], tap[24];
  sqlite3_stmt *query = ethd__store_query(store, insert);
  snprintf(seed, sizeof seed, "%" PRIu64, taken->seed);
  snprintf(tap, sizeof tap, "%" PRIu64, taken->tap);
  sqlite3_bind_int64(query, 1, (int64_t)point);
  sqlite3_bind_int64(query, 2, turn->person + 1);
  sqlite3_bind_int64(query, 3, (int64_t)turn->number);
  sqlite3_bind_int64(query, 4, turn->attempt);
  bind_word(query, 5, seed);
  bind_word(query, 6, tap);
  sqlite3_bind_int(query, 7, m->reason == ETHD_TAP_OK);
  bind_word(query, 8, ethd__reason_words[m->reason]);
  bind_figures(query, 9, &taken->result);
  bind_word(query, 24, ethd__hand_words[taken->hand]);
  bind_word(query, 25, taken->movement);
  bind_word(query, 26, taken->utc);
  bind_word(query, 27, ethd__reason_words[m->by_ring]);
  bind_word(query, 28, ethd__reason_words[m->by_finger]);
  return ethd__store_run(store, query, message);
}

/* ---- out of it ---- */

enum {
  POINT,
  PERSON,
  BLOCK,
  ATTEMPT,
  SEED,
  TAP,
  VALID,
  REASON,
  FIGURES,
  HAND = FIGURES + ETHD_STORE_FIGURE_COUNT,
  COLUMNS = HAND + 5
};

static void print_cells(FILE *file, const char *before, sqlite3_stmt *tap, int first, int end) {
  for (int i = first; i < end; i++) {
    fputs(before, file);
    if (i < FIGURES || i >= HAND)
      ethd__csv_put_word(file, ethd__store_text(tap, i));
    else if (sqlite3_column_type(tap, i) != SQLITE_NULL)
      fprintf(file, "%.17g", sqlite3_column_double(tap, i));
    before = ",";
  }
}

/* Prints a tap. `blocks` are its participant's. */
static void print_tap(FILE *file, const ethd__protocol *p, const ethd__study_block *blocks, sqlite3_stmt *tap) {
  char id[ETHD_STUDY_ID_MAX];
  int number = sqlite3_column_int(tap, BLOCK);
  const ethd__study_block *block = &blocks[number - 1];
  ethd__participant_id(p, (uint32_t)sqlite3_column_int64(tap, PERSON) - 1, id);
  fprintf(file, "%s,%d,%s,%" PRId64 ",%s,%s", id, number, block->training ? "training" : "test",
          (int64_t)sqlite3_column_int64(tap, ATTEMPT), p->strategies.word[block->strategy],
          p->speeds.word[block->speed]);
  print_cells(file, ",", tap, SEED, COLUMNS);
}

ethd_status ethd__taps_print(FILE *file, ethd__study_store *store, const ethd__folder *folder,
                             char message[ETHD_MESSAGE_MAX]) {
  const ethd__protocol *p = &folder->protocol;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  int64_t person = -1;
  sqlite3_stmt *tap = ethd__store_query(
      store, folder->simulated ? "SELECT " ETHD_STORE_TAP " FROM tap ORDER BY point, participant, block, attempt"
                               : "SELECT " ETHD_STORE_TAP " FROM tap ORDER BY id");
  while (ethd__store_next(tap)) {
    size_t point = (size_t)sqlite3_column_int64(tap, POINT);
    int64_t now = sqlite3_column_int64(tap, PERSON) - 1;
    if (now != person) (void)ethd__order_of(p, (uint32_t)(person = now), blocks);
    if (folder->simulated) fprintf(file, "%.*s,%zu,", HASH_DIGITS, folder->hash, point);
    print_tap(file, p, blocks, tap);
    for (size_t i = 0; folder->simulated && i < p->axis_count; i++)
      fprintf(file, ",%s", ethd__protocol_value(p, point, i));
    putc('\n', file);
  }
  return ethd__store_end(store, tap, message);
}
