/* The bus between the boards: every board but 0 offers the block of its last reading, board 0 fetches them.

     offset  0        1               9
             | status | 4 x u16 counts | crc8 |     little endian; crc8: polynomial 0x07, start 0xFF */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stdint.h>

#define LINK_SIZE 10

/* status: a count of readings modulo 8, which tells a new block from an old one, and: */
#define LINK_COUNT 0x07u
#define LINK_FIRST 0x08u     /* the first since the board's reset */
#define LINK_RECOVERED 0x10u /* a sensor's bus was clocked free */

typedef struct link_block {
  uint8_t status;
  uint16_t counts[4];
} link_block;

typedef enum link_result { LINK_OK, LINK_SILENT, LINK_HELD } link_result;

void link_open(uint8_t board);

/* Boards 1..3: offers this block from now on. */
void link_offer(const link_block *block);

/* Returns whether the last block was fetched. */
bool link_fetched(void);

/* Board 0: fetches a block. SILENT: no answer, or not a whole block. HELD: the bus didn't move for 100 us; it was
   clocked free as far as possible, and asking other boards in this period is useless. */
link_result link_fetch(uint8_t board, link_block *out);

#endif
