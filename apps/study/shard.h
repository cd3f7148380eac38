/* Simulations: thousands of participants over a grid of gains, in shards that can be computed anywhere.

   Unit u = point N + person is one participant at one point of the grid; shard i of n does the units with
   u mod n = i - 1. A shard's rows depend on study, N, i and n alone. They stand in shard-i-of-n.sqlite, a store as a
   session's (store/store.h), a transaction for each unit, from which it goes on when it was ended. All [main]. */
#ifndef ETHD__APPS_STUDY_SHARD_H
#define ETHD__APPS_STUDY_SHARD_H

#include "study/desk.h"
#include "study/progress.h"

typedef struct ethd__shard {
  uint32_t index, count; /* i from 1, n */
  bool record;           /* every tick of every tap, below taps-i-of-n */
} ethd__shard;

/* Simulates a shard; folder->protocol.participants is N. *taps becomes how many this program has done. Ends early, with
   ETHD_OK and *over false, once ethd__stop is set. */
ETHD_MUST_CHECK ethd_status ethd__shard_run(ethd__folder *folder, ethd__desk *desk, const ethd__shard *shard,
                                            uint64_t *taps, bool *over, char message[ETHD_MESSAGE_MAX]);

/* Merges all shards of the folder into study.sqlite and taps.csv, which has the same bytes for every n. */
ETHD_MUST_CHECK ethd_status ethd__shards_merge(ethd__folder *folder, uint64_t *taps, char message[ETHD_MESSAGE_MAX]);

#define ETHD_STUDY_SHARDS_MAX 10000u
#define ETHD_SHARD_NAME_MAX 64

/* Writes the name of a shard's file. [any] */
void ethd__shard_name(const ethd__shard *shard, char out[ETHD_SHARD_NAME_MAX]);

/* Gives how many units of the shard are done; they are its first ones. Refuses a store with other rows. */
ETHD_MUST_CHECK ethd_status ethd__shard_done(ethd__study_store *store, const ethd__protocol *protocol,
                                             const ethd__shard *shard, uint64_t *units, char message[ETHD_MESSAGE_MAX]);

/* Returns how many units the shard has. [any] */
uint64_t ethd__shard_units(const ethd__protocol *protocol, const ethd__shard *shard);

#endif
