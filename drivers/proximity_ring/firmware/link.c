#include "link.h"

#include <avr/interrupt.h>
#include <string.h>
#include <util/twi.h>

#include "board.h"

#define GO ((1 << TWINT) | (1 << TWEN))
#define LISTEN (GO | (1 << TWEA) | (1 << TWIE))

static uint8_t offered[2][LINK_SIZE];
static volatile uint8_t newest;
static volatile bool fetched;

/* Polynomial x^8 + x^2 + x + 1, four bits at a time. */
static uint8_t crc8(const uint8_t *bytes) {
  static const uint8_t step[16] = {0x00, 0x07, 0x0E, 0x09, 0x1C, 0x1B, 0x12, 0x15,
                                   0x38, 0x3F, 0x36, 0x31, 0x24, 0x23, 0x2A, 0x2D};
  uint8_t crc = 0xFF;
  for (uint8_t n = 0; n < LINK_SIZE - 1; n++) {
    crc ^= bytes[n];
    crc = (uint8_t)(crc << 4) ^ step[crc >> 4];
    crc = (uint8_t)(crc << 4) ^ step[crc >> 4];
  }
  return crc;
}

/* ---- boards 1..3 ---- */

void link_offer(const link_block *block) {
  uint8_t *bytes = offered[!newest];
  bytes[0] = block->status;
  memcpy(bytes + 1, block->counts, sizeof block->counts);
  bytes[LINK_SIZE - 1] = crc8(bytes);
  fetched = false;
  newest = !newest;
  if (!(TWCR & (1 << TWEN))) TWCR = LISTEN; /* before its first block a board doesn't answer */
}

bool link_fetched(void) { return fetched; }

/* Sends a whole block, even if a newer one is offered meanwhile. What is written to this board is ignored. */
ISR(TWI_vect) {
  static const uint8_t *told;
  static uint8_t left;
  uint8_t status = TW_STATUS;
  if (status == TW_ST_DATA_NACK && told == offered[newest] + LINK_SIZE) fetched = true;
  if (status == TW_ST_SLA_ACK) {
    told = offered[newest];
    left = LINK_SIZE;
  }
  if (left && (status == TW_ST_SLA_ACK || status == TW_ST_DATA_ACK)) {
    TWDR = *told++;
    left--;
  }
  TWCR = status == TW_BUS_ERROR ? LISTEN | (1 << TWSTO) : LISTEN;
}

/* ---- board 0 ---- */

static void half_bit(void) { __builtin_avr_delay_cycles(40); }

/* A board that was interrupted in a byte holds SDA until it has been clocked through. */
static void clock_free(void) {
  TWCR = 0;
  for (uint8_t n = 9; n && !(LINK_PIN & LINK_SDA); n--) {
    LINK_DDR |= LINK_SCL;
    half_bit();
    LINK_DDR &= (uint8_t)~LINK_SCL;
    half_bit();
  }
  LINK_DDR |= LINK_SCL;
  LINK_DDR |= LINK_SDA;
  half_bit();
  LINK_DDR &= (uint8_t)~LINK_SCL;
  half_bit();
  LINK_DDR &= (uint8_t)~LINK_SDA;
  half_bit();
  TWCR = 1 << TWEN;
}

/* A byte takes 25 us and the other board's part in it 5 us; the 250 turns of this loop take over 100 us. */
static bool wait(uint8_t mask, uint8_t value) {
  for (uint8_t turn = 250; turn; turn--) {
    if ((TWCR & mask) == value) return true;
  }
  return false;
}

static bool step(uint8_t control) {
  TWCR = GO | control;
  return wait(1 << TWINT, 1 << TWINT);
}

/* Reads a board's block into `bytes`. Returns the status of the two-wire interface where it ended: TW_MR_DATA_NACK
   after the last byte; 0: the bus was held. */
static uint8_t fetch(uint8_t board, uint8_t *bytes) {
  if (!step(1 << TWSTA)) return 0;
  if (TW_STATUS != TW_START) return TW_STATUS;
  TWDR = (uint8_t)((LINK_ADDRESS + board - 1) << 1 | TW_READ);
  if (!step(0)) return 0;
  if (TW_STATUS != TW_MR_SLA_ACK) return TW_STATUS;
  for (uint8_t n = LINK_SIZE; n; n--) {
    if (!step(n > 1 ? 1 << TWEA : 0)) return 0;
    *bytes++ = TWDR;
  }
  return TW_STATUS;
}

link_result link_fetch(uint8_t board, link_block *out) {
  uint8_t bytes[LINK_SIZE];
  uint8_t end = fetch(board, bytes);
  bool moved = end != 0;
  if (moved) {
    TWCR = GO | (1 << TWSTO);
    moved = wait(1 << TWSTO, 0);
  }
  if (!moved) {
    clock_free();
    return LINK_HELD;
  }
  if (end != TW_MR_DATA_NACK || crc8(bytes) != bytes[LINK_SIZE - 1]) return LINK_SILENT;
  out->status = bytes[0];
  memcpy(out->counts, bytes + 1, sizeof out->counts);
  return LINK_OK;
}

void link_open(uint8_t board) {
  TWBR = (F_CPU / 400000UL - 16) / 2;
  if (board)
    TWAR = (uint8_t)((LINK_ADDRESS + board - 1) << 1);
  else
    clock_free();
}
