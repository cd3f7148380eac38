/* Firmware of the proximity ring's boards: one image, the straps say which board it is on. */
#include <avr/wdt.h>
#include <stdbool.h>
#include <string.h>
#include <util/crc16.h>

#include "board.h"
#include "link.h"
#include "period.h"
#include "sensors.h"
#include "uart.h"

static uint8_t reset_cause __attribute__((section(".noinit")));

/* Runs before anything else, because after a reset by the watchdog the watchdog goes on, at its shortest time. */
void catch_reset(void) __attribute__((naked, used, section(".init3")));
void catch_reset(void) {
  reset_cause = MCUSR;
  MCUSR = 0;
  wdt_enable(WDTO_15MS);
}

/* The slot in which this board's first sensor measures. */
static uint8_t first_slot;

/* One reading of the four sensors, each in its slot; see frame.h. */
static bool sample(uint16_t start, uint16_t counts[LANES]) {
  for (uint8_t slot = 0; slot < LANES; slot++) {
    period_wait(start + slot * SLOT);
    sensors_begin((slot + LANES - first_slot) % LANES);
    if (slot) continue;
    period_release();
    sensors_settle();
  }
  period_wait(start + LANES * SLOT);
  return sensors_read(counts);
}

/* ---- boards 1..3 ---- */

static void follow(link_block *block) {
  period now;
  if (!period_next(&now)) return;
  if (link_fetched()) block->status &= LINK_COUNT; /* board 0 has seen the flags */
  if (sample(now.start, block->counts)) block->status |= LINK_RECOVERED;
  block->status = (block->status & (uint8_t)~LINK_COUNT) | ((block->status + 1) & LINK_COUNT);
  link_offer(block);
}

static void follow_for_ever(void) {
  link_block block = {.status = LINK_FIRST};
  for (;;) {
    wdt_reset();
    follow(&block);
  }
}

/* ---- board 0 ---- */

/* Takes a block's counts over, and returns its flags. A block that was fetched before doesn't count. */
static uint8_t merge(uint8_t board, const link_block *block, uint8_t *counts) {
  static uint8_t last[ETHD__FRAME_BOARDS] = {0xFF, 0xFF, 0xFF, 0xFF};
  if (block->status == last[board]) return ETHD__FRAME_BOARD_MISSING;
  last[board] = block->status;
  memcpy(counts, block->counts, sizeof block->counts);
  return (block->status & LINK_FIRST ? ETHD__FRAME_BOARD_RESET : 0) |
         (block->status & LINK_RECOVERED ? ETHD__FRAME_BUS_RECOVERED : 0);
}

static uint8_t collect(uint8_t *counts) {
  uint8_t flags = 0;
  for (uint8_t board = 1; board < ETHD__FRAME_BOARDS; board++) {
    link_block block;
    link_result result = link_fetch(board, &block);
    if (result == LINK_HELD) return flags | ETHD__FRAME_BOARD_MISSING | ETHD__FRAME_BUS_RECOVERED;
    flags |= result == LINK_OK ? merge(board, &block, counts + 2 * LANES * board) : ETHD__FRAME_BOARD_MISSING;
  }
  return flags;
}

static bool any_missing(const uint8_t *counts) {
  for (uint8_t k = 0; k < ETHD__FRAME_SENSORS; k++) {
    if (!(counts[2 * k] | counts[2 * k + 1])) return true;
  }
  return false;
}

static void seal(uint8_t *frame) {
  uint16_t crc = ETHD__FRAME_CRC_START;
  for (uint8_t n = 0; n < ETHD__FRAME_AT_CRC; n++) crc = _crc_ccitt_update(crc, frame[n]);
  memcpy(frame + ETHD__FRAME_AT_CRC, &crc, sizeof crc);
}

/* Numbers in memory are little endian, as in the frame. */
static void lead(uint16_t seq, uint8_t flags) {
  uint8_t frame[ETHD__FRAME_SIZE] = {[ETHD__FRAME_AT_TYPE] = ETHD__FRAME_TYPE};
  uint8_t *counts = frame + ETHD__FRAME_AT_COUNTS;
  uint16_t own[LANES];
  period now;
  period_next(&now);
  if (now.late) flags |= ETHD__FRAME_LATE;
  if (sample(now.start, own)) flags |= ETHD__FRAME_BUS_RECOVERED;
  memcpy(counts, own, sizeof own);
  period_wait(now.start + COLLECT);
  flags |= collect(counts);
  if (any_missing(counts)) flags |= ETHD__FRAME_SENSOR_MISSING;
  frame[ETHD__FRAME_AT_FLAGS] = flags;
  memcpy(frame + ETHD__FRAME_AT_SEQ, &seq, sizeof seq);
  memcpy(frame + ETHD__FRAME_AT_TIME, &now.time, sizeof now.time);
  seal(frame);
  uart_send(frame);
}

static void lead_for_ever(void) {
  uint8_t flags = ETHD__FRAME_FIRST | (reset_cause & (1 << WDRF) ? ETHD__FRAME_WATCHDOG : 0);
  for (uint16_t seq = 0;; seq++) {
    wdt_reset();
    lead(seq, flags);
    flags = 0;
  }
}

int main(void) {
  STRAPS_PORT |= (3u << STRAP_BOARD) | (1u << STRAP_SLOW);
  sensors_open(); /* also the time that the straps' pull-ups need */
  uint8_t straps = (uint8_t)~STRAPS_PIN;
  uint8_t board = straps >> STRAP_BOARD & 3;
  first_slot = ETHD__FRAME_SLOT(LANES * board);
  link_open(board);
  period_open(!board);
  if (board) follow_for_ever();
  uart_open(straps >> STRAP_SLOW & 1);
  lead_for_ever();
}
