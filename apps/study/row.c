#include "study/row.h"

#include <inttypes.h>
#include <stdio.h>

#include "store/schema.h"

void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]) {
  int digits = 2;
  for (uint32_t n = protocol->participants; n > 99; n /= 10) digits++;
  snprintf(out, ETHD_STUDY_ID_MAX, "P%0*" PRIu32, digits, person + 1);
}

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
