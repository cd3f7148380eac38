/* The frame that the proximity ring sends, 300 times a second, over its UART (8N1, 500 or 400 kBd).

     offset  0     1      2      4       8                       40     42
             | type | flags | seq   | t_us    | counts[0] .. counts[15] | crc  |     little endian
               u8     u8      u16     u32       16 x u16                  u16

   seq counts frames, modulo 65536, and starts at 0 after a reset of board 0. t_us is the beginning of the sampling, in
   board 0's own clock, modulo 2^32; it starts near 0 too. counts[k] belongs to the sensor of ray k, at the angle 2 pi k
   / 16 round the ring. crc is CRC-16/MCRF4XX (polynomial 0x1021 reflected = 0x8408, start 0xFFFF, no final inversion;
   of "123456789": 0x6F91) of the 40 bytes before it. On the wire the 42 bytes are COBS-coded (43 bytes, no zero among
   them) and ended by a zero: 44. After a reset a zero of its own comes first, so that half a frame from before doesn't
   cost the first one.

   Board b has the sensors 4 b .. 4 b + 3. They measure one after another, so that only four of the 16 shine at
   a time: sensor k begins ETHD__FRAME_START_US + ETHD__FRAME_SLOT(k) * ETHD__FRAME_SLOT_US after t_us and takes some
   170 us. Boards 2 and 3 begin in the middle of their four, so that no sensor shines while the one that faces it
   measures: across an empty ring that light would be part of the dark, and a finger between them would block it.

   The firmware and the host both include this file: plain C, stdint alone. */
#ifndef ETHD__PROXIMITY_RING_FRAME_H
#define ETHD__PROXIMITY_RING_FRAME_H

#include <stdint.h>

#define ETHD__FRAME_RATE 300 /* Hz: three frames take exactly 10 ms */
#define ETHD__FRAME_BOARDS 4
#define ETHD__FRAME_LANES 4 /* sensors of one board */
#define ETHD__FRAME_SENSORS 16

#define ETHD__FRAME_TYPE 0x01 /* the only one yet */

/* Offsets and sizes in bytes. */
#define ETHD__FRAME_AT_TYPE 0
#define ETHD__FRAME_AT_FLAGS 1
#define ETHD__FRAME_AT_SEQ 2
#define ETHD__FRAME_AT_TIME 4
#define ETHD__FRAME_AT_COUNTS 8
#define ETHD__FRAME_AT_CRC 40
#define ETHD__FRAME_SIZE 42
#define ETHD__FRAME_WIRE 44 /* with COBS and delimiter */
#define ETHD__FRAME_DELIMITER 0x00

#define ETHD__FRAME_CRC_START 0xFFFFu
#define ETHD__FRAME_CRC_POLYNOMIAL 0x8408u /* bits reflected */
#define ETHD__FRAME_CRC_CHECK 0x6F91u

/* Counts: more is nearer. */
#define ETHD__FRAME_MISSING 0u        /* no answer, not ready in time, or its board missing */
#define ETHD__FRAME_SATURATED 0xFFFFu /* the sensor's own ceiling */

/* Flags; bits that aren't named here are 0. */
#define ETHD__FRAME_SENSOR_MISSING 0x01u /* at least one count is 0 */
#define ETHD__FRAME_BOARD_MISSING \
  0x02u                         /* board 1, 2 or 3 gave no block, a stale one or a broken one: four counts are 0 */
#define ETHD__FRAME_FIRST 0x04u /* the first frame since board 0's reset: seq and t_us begin anew */
#define ETHD__FRAME_BOARD_RESET 0x08u /* board 1, 2 or 3 began anew */
#define ETHD__FRAME_LATE 0x10u        /* board 0 lost at least one period before this frame; t_us went on, seq didn't */
#define ETHD__FRAME_BUS_RECOVERED 0x20u /* a bus was found held low and clocked free */
#define ETHD__FRAME_WATCHDOG 0x40u      /* with FIRST: it was the watchdog that reset board 0 */

/* When sensor k measures: see above. */
#define ETHD__FRAME_START_US 80u
#define ETHD__FRAME_SLOT_US 430u
#define ETHD__FRAME_SLOT(k) (((k) + (k) / 8 * 2) % ETHD__FRAME_LANES)

#endif
