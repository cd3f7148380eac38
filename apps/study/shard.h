/* Simulations: thousands of participants over a grid of gains, in shards that can be computed anywhere.

   Unit u = point N + person is one participant at one point of the grid; shard i of n does the units with
   u mod n = i - 1. A shard's bytes depend on study, N, i and n alone. While it is at work its rows stand in
   shard-i-of-n.part, from which it goes on when it was ended. All [main]. */
#ifndef ETHD__APPS_STUDY_SHARD_H
#define ETHD__APPS_STUDY_SHARD_H

#include "study/desk.h"
#include "study/folder.h"

typedef struct ethd__shard {
  uint32_t index, count; /* i from 1, n */
  bool record;           /* every tick of every tap, below taps-i-of-n */
} ethd__shard;

/* Simulates a shard; folder->protocol.participants is N. *taps becomes how many this program has done. Ends early, with
   ETHD_OK and *over false, once ethd__stop is set. */
ETHD_MUST_CHECK ethd_status ethd__shard_run(ethd__folder *folder, ethd__desk *desk, const ethd__shard *shard,
                                            uint64_t *taps, bool *over, char message[ETHD_MESSAGE_MAX]);

/* Merges all shards of the folder into taps.csv, in the order of the units, which gives the same bytes for every n. */
ETHD_MUST_CHECK ethd_status ethd__shards_merge(ethd__folder *folder, uint64_t *taps, char message[ETHD_MESSAGE_MAX]);

#define ETHD_STUDY_SHARDS_MAX 10000u

/* Returns the path of a shard's file, which the caller frees; exit 1 without memory. */
char *ethd__shard_path(const ethd__folder *folder, const ethd__shard *shard, const char *suffix);

/* Returns what the rows of a unit begin with, "hash,point,P01,". The caller frees it; exit 1 without memory. */
char *ethd__unit_prefix(const ethd__folder *folder, uint64_t unit);

uint64_t ethd__unit_count(const ethd__protocol *protocol);

#endif
