/* The search: rounds of ever fewer points and ever more taps (successive halving, Jamieson and Talwalkar 2016, with new
   points drawn about those that are left).

     round 1   points that fill the box evenly   taps / 20 at each speed
     round 2   the best, and some about each     taps / 10
     round 3   the best of these, some nearer    taps / 4
     round 4   the best that settle in time
               at their margins                  taps        the front, and the choice
   Every point of a round meets the same fingers, and so does the configuration's own point, which is number 0 of each
   round. A few of round 1's points that don't keep the margin are tapped too, for comparison; they never go on. All
   [main]. */
#ifndef ETHD__APPS_TUNE_SEARCH_H
#define ETHD__APPS_TUNE_SEARCH_H

#include "tune/score.h"

#define ETHD_TUNE_ROUNDS 4

typedef struct ethd__tune_entry {
  ethd__tune_point point;
  ethd__tune_score score;
  double goals[ETHD_TUNE_GOALS]; /* relative to the round's entry 0 */
  double total;                  /* the goals' weighted sum; a goal over a tenth worse than entry 0's counts more */
  bool keeps;
  int settled; /* settled in the simulation at its margins: 1 yes, 0 no, -1 not tried */
  bool front;  /* no other entry of its round is at least as good by every goal and better by one */
} ethd__tune_entry;

typedef struct ethd__tune_round {
  ethd__tune_entry *entries;
  size_t count;
  uint32_t taps;
} ethd__tune_round;

typedef struct ethd__tune_search {
  const ethd__tune_rig *rig;
  uint32_t points; /* how many points of round 1 keep the margin, beside the configuration's own */
  uint32_t taps;   /* taps of the last round at each speed; earlier rounds have at least 8 */
  double weights[ETHD_TUNE_GOALS];
  ethd__tune_round rounds[ETHD_TUNE_ROUNDS];
  uint64_t drawn, kept;       /* points that were drawn for round 1, and those of them that kept the margin */
  uint32_t asked;             /* points whose margins were simulated in time */
  ethd__tune_verdict verdict; /* the verdict on the last of them */
} ethd__tune_search;

/* Fills the rounds. ETHD_E_RANGE, with the reason: hardly any point of the box keeps the margin. The search ends early,
   with ETHD_OK, once ethd__stop is set; *over says whether it came to its end. */
ETHD_MUST_CHECK ethd_status ethd__search_run(ethd__tune_search *search, bool *over, char message[ETHD_MESSAGE_MAX]);

/* Returns the entry of the last round's front with the smallest total; NULL: none settled at its margins. */
const ethd__tune_entry *ethd__search_choice(const ethd__tune_search *search);

void ethd__search_free(ethd__tune_search *search);

#endif
