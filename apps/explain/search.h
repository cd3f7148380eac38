/* The search for a plant: differential evolution (Storn and Price 1997) with JADE's step, x + F (p - x) + F (a - b), p
   one of the best (Zhang and Sanderson 2009). Every draw is a function of seed, generation and number, and a journal
   keeps what was judged, so that a search that was interrupted goes on and has the same result. All [main]. */
#ifndef ETHD__APPS_EXPLAIN_SEARCH_H
#define ETHD__APPS_EXPLAIN_SEARCH_H

#include "explain/judge.h"

#define ETHD_EXPLAIN_POPULATION_MAX 512

typedef struct ethd__explain_search {
  const ethd__explain_question *question;
  uint32_t population, generations;
  uint32_t
      still; /* generations: a search is at its end once the least total hasn't fallen by a hundredth for so many */
  const char *journal; /* a file; NULL: nothing is kept */
  ethd__explain_point point[ETHD_EXPLAIN_POPULATION_MAX];
  double total[ETHD_EXPLAIN_POPULATION_MAX];
  uint32_t done;    /* generations */
  uint32_t lowered; /* the last of them by which the least total had fallen by a hundredth, */
  double mark;      /* to this */
  uint64_t judged;  /* plants, those of an earlier run included */
} ethd__explain_search;

/* Ends early, with ETHD_OK, once ethd__stop is set. Refuses a journal of another search. */
ETHD_MUST_CHECK ethd_status ethd__explain_run(ethd__explain_search *search, char message[ETHD_MESSAGE_MAX]);

/* Whether the search came to its end: nothing is missed any more, or longer searching with this population has stopped
   to help. */
static inline bool ethd__explain_at_end(const ethd__explain_search *search) {
  return search->mark <= 0 || search->done - search->lowered >= search->still;
}

/* Returns the number of the point with the least total. */
uint32_t ethd__explain_best(const ethd__explain_search *search);

#endif
