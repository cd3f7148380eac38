/* The order of a participant's blocks.

   A block is a strategy at a speed. Speeds come in the file's order, strategies counterbalanced: participant
   p (from 0) trains with strategy p mod K and taps in p+1, p+2, .. p mod K. For two strategies that is the
   paper's rule: train A, tap B, tap A; the next one train B, tap A, tap B; the same again at the next speed.
   `random`: all cells shuffled by (seed, participant). `latin`: a balanced Latin square over all cells
   (Williams 1949): over a multiple of the number of cells (twice that, if it is odd) each cell stands at
   each place and follows each other one equally often, and each strategy is equally often first and last at each
   speed; the seed shuffles the cells and the participants' rows. A speed's training comes before its first cell,
   with the strategy that comes last at it.
   `interleaved`: a block is one trial, repeated until it is valid. There are as many rounds of trials as a cell wants valid
   taps. A round has every cell once, in the order of a row of that square; the next round takes the next row. All trainings
   come before the first round. [any] */
#ifndef ETHD__APPS_STUDY_ORDER_H
#define ETHD__APPS_STUDY_ORDER_H

#include "study/protocol.h"

#define ETHD_STUDY_BLOCKS 1024

typedef struct ethd__study_block {
  bool training;
  size_t strategy, speed; /* of the protocol */
  uint32_t round;         /* of trials, from 0; 0 in a study of blocks */
} ethd__study_block;

/* Return a block's required number of valid taps, and its largest number of taps. */
uint32_t ethd__block_taps(const ethd__protocol *protocol);
uint32_t ethd__block_attempts(const ethd__protocol *protocol);

/* Fills a participant's blocks in order, and returns how many there are. */
size_t ethd__order_of(const ethd__protocol *protocol, uint32_t participant, ethd__study_block out[ETHD_STUDY_BLOCKS]);

#endif
