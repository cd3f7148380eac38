#include "sensors.h"

#include "board.h"
#include "lanes.h"
#include "vcnl4000.h"

#define EMITTER 10u /* x 10 mA */

static uint8_t settled; /* lanes whose sensor has its settings */
static uint8_t begun;   /* lanes that measure, with their settings */

void sensors_open(void) {
  lanes_open();
  lanes_free(lanes_held());
  sensors_settle();
}

/* A sensor that lost its supply, and so its settings, must not be taken for one that sees less. */
static void check_settings(void) {
  uint8_t bits[VCNL4000_CURRENT - VCNL4000_PRODUCT + 1][8], product[4], current[4];
  settled &= lanes_get(settled, VCNL4000_ADDRESS, VCNL4000_PRODUCT, sizeof bits / 8, bits);
  lanes_split(bits[0], product);
  lanes_split(bits[VCNL4000_CURRENT - VCNL4000_PRODUCT], current);
  for (uint8_t lane = 0, mask = 1; lane < LANES; lane++, mask <<= 1) {
    if ((product[lane] & 0xF0) != VCNL4000_PRODUCT_ID || current[lane] != EMITTER) settled &= (uint8_t)~mask;
  }
}

void sensors_settle(void) {
  check_settings();
  begun &= settled;
  uint8_t lanes = (uint8_t)~settled & LANES_ALL;
  if (!lanes) return;
  lanes = lanes_put(lanes, VCNL4000_ADDRESS, VCNL4000_CURRENT, EMITTER);
  settled |= lanes_put(lanes, VCNL4000_ADDRESS, VCNL4000_TIMING, VCNL4000_TIMING_ADVISED);
}

void sensors_begin(uint8_t lane) {
  uint8_t mask = (uint8_t)(1u << lane);
  uint8_t done = lanes_put(settled & mask, VCNL4000_ADDRESS, VCNL4000_COMMAND, VCNL4000_MEASURE);
  settled &= (uint8_t)~mask | done;
  begun = (begun & (uint8_t)~mask) | done;
}

/* Makes a count, which is never 0, because 0 means that it is missing. */
static uint16_t count(uint8_t high, uint8_t low) {
  uint16_t value = (uint16_t)(high << 8 | low);
  return value ? value : 1;
}

bool sensors_read(uint16_t counts[4]) {
  uint8_t ready[1][8], result[2][8], command[4], high[4], low[4];
  settled &= lanes_get(settled, VCNL4000_ADDRESS, VCNL4000_COMMAND, 1, ready);
  settled &= lanes_get(settled, VCNL4000_ADDRESS, VCNL4000_RESULT, 2, result);
  lanes_split(ready[0], command);
  lanes_split(result[0], high);
  lanes_split(result[1], low);
  for (uint8_t lane = 0, mask = 1; lane < LANES; lane++, mask <<= 1) {
    bool good = settled & begun & mask && command[lane] & VCNL4000_READY;
    counts[lane] = good ? count(high[lane], low[lane]) : ETHD__FRAME_MISSING;
  }
  uint8_t held = lanes_held();
  return held && lanes_free(held);
}
