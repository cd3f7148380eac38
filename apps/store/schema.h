/* The tables of study.sqlite in SQLite's stored text, which is compared with a received file's. Rows that fail a check
   can't be inserted; a reader repeats the checks, because SQLite ignores checks where it may not write. Figures have no
   type: as REAL they would lose the sign of a zero. Seeds are text, because integers end at 2^63. */
#ifndef ETHD__APPS_STORE_SCHEMA_H
#define ETHD__APPS_STORE_SCHEMA_H

#define ETHD_STORE_APPLICATION 0x65746864 /* "ethd" */
#define ETHD_STORE_VERSION 2              /* rises by 1 with each change of the tables */

#define ETHD_STORE_FIGURES                                                                                        \
  "v_rvo, v_of, d_max, v_rmin, delta_s, eps, t_rvo, t_of, t_seen, peak_force, finger_radius, commanded, v_hand, " \
  "touch_depth, eps_felt"
enum { ETHD_STORE_FIGURE_COUNT = 15 };

/* All columns of a tap but its id. */
#define ETHD_STORE_TAP                                                                \
  "point, participant, block, attempt, seed, tap, valid, reason, " ETHD_STORE_FIGURES \
  ", hand, movement, utc, by_ring, "                                                  \
  "by_finger"

#define ETHD_STORE_REASONS "('ok', 'fault', 'early-contact', 'too-slow', 'too-fast', 'no-contact', 'grazing', 'double')"

/* The rule of each hand and each tap. */
#define ETHD_STORE_HAND_RULE "word IN ('device', 'mouse', 'simulated', 'recorded')"
#define ETHD_STORE_TAP_RULE                                                                       \
  "seed || tap NOT GLOB '*[^0-9]*' AND valid = (reason = 'ok') AND reason IN " ETHD_STORE_REASONS \
  " AND by_ring IN " ETHD_STORE_REASONS " AND by_finger IN " ETHD_STORE_REASONS

extern const char ethd__schema[];

#endif
