#include "lanes.h"

#include <stdbool.h>
#include <util/delay_basic.h>

#include "board.h"

/* Fast mode asks for SCL low >= 1.3 us and high >= 0.6 us, which are 21 and 10 cycles; the code between these waits
   takes the rest of a bit's 40 cycles. */
#define LOW_WAIT __builtin_avr_delay_cycles(15)
#define HIGH_WAIT __builtin_avr_delay_cycles(7)
#define HOLD_WAIT __builtin_avr_delay_cycles(10)
#define FREE_WAIT __builtin_avr_delay_cycles(20)

static uint8_t alive; /* lanes that still take part in this transaction */

/* The pins of the boards' bus, in the same port, are inputs while sensors are spoken to. */
static inline void pull(uint8_t lanes) { LANES_DDR = lanes; }

static inline void scl_low(void) { LANES_SCL_DDR |= LANES_SCL; }

/* A sensor may hold SCL for a moment; if one holds it for 20 us, all lanes drop out. */
static __attribute__((noinline)) void scl_await(void) {
  for (uint8_t turn = 60; turn; turn--) {
    if (LANES_SCL_PIN & LANES_SCL) return;
  }
  alive = 0;
}

static inline void scl_high(void) {
  LANES_SCL_DDR &= (uint8_t)~LANES_SCL;
  __builtin_avr_delay_cycles(3); /* SCL rises, and the pin's synchroniser follows */
  if (!(LANES_SCL_PIN & LANES_SCL)) scl_await();
}

/* Makes one clock with SDA pulled low on the lanes `low`, and returns the port's pins. */
static inline __attribute__((always_inline)) uint8_t bit(uint8_t low) {
  pull(low);
  LOW_WAIT;
  scl_high();
  HIGH_WAIT;
  uint8_t seen = LANES_PIN;
  scl_low();
  return seen;
}

static void start(uint8_t lanes) {
  pull(0);
  alive = lanes;
  scl_high();
  FREE_WAIT;
  alive &= LANES_PIN;
  pull(alive);
  HOLD_WAIT;
  scl_low();
}

static void restart(void) {
  pull(0);
  LOW_WAIT;
  scl_high();
  HOLD_WAIT;
  pull(alive);
  HOLD_WAIT;
  scl_low();
}

static void stop(void) {
  pull(alive);
  LOW_WAIT;
  scl_high();
  HOLD_WAIT;
  pull(0);
}

static void send(uint8_t byte) {
  uint8_t lanes = alive;
  if (!lanes) return;
  for (uint8_t n = 8; n; n--, byte <<= 1) bit(byte & 0x80 ? 0 : lanes);
  lanes &= (uint8_t)~bit(0);
  if (alive) alive = lanes;
}

static void receive(bool more, uint8_t out[8]) {
  uint8_t lanes = alive;
  if (!lanes) return;
  for (uint8_t n = 8; n; n--) *out++ = bit(0);
  bit(more ? lanes : 0);
}

void lanes_open(void) {
  LANES_PORT &= (uint8_t)~LANES_ALL;
  LANES_SCL_PORT &= (uint8_t)~LANES_SCL;
  pull(0);
  LANES_SCL_DDR &= (uint8_t)~LANES_SCL;
}

uint8_t lanes_put(uint8_t lanes, uint8_t address, uint8_t reg, uint8_t value) {
  if (!lanes) return 0;
  start(lanes);
  send((uint8_t)(address << 1));
  send(reg);
  send(value);
  stop();
  return alive;
}

uint8_t lanes_get(uint8_t lanes, uint8_t address, uint8_t reg, uint8_t count, uint8_t out[][8]) {
  if (!lanes) return 0;
  start(lanes);
  send((uint8_t)(address << 1));
  send(reg);
  restart();
  send((uint8_t)(address << 1 | 1));
  for (uint8_t n = 0; n < count; n++) receive(n + 1 < count, out[n]);
  stop();
  return alive;
}

/* For each bit, the lowest pin goes to lane 0, the next to lane 1, and so on. It takes 80 cycles instead of 500 in
   C. */
void lanes_split(const uint8_t bits[8], uint8_t out[4]) {
  uint8_t a = 0, b = 0, c = 0, d = 0;
  for (uint8_t n = 8; n; n--) {
    uint8_t seen = *bits++;
    __asm__("lsr %4\n\t rol %0\n\t"
            "lsr %4\n\t rol %1\n\t"
            "lsr %4\n\t rol %2\n\t"
            "lsr %4\n\t rol %3"
            : "+r"(a), "+r"(b), "+r"(c), "+r"(d), "+r"(seen));
  }
  out[0] = a, out[1] = b, out[2] = c, out[3] = d;
}

uint8_t lanes_held(void) { return (uint8_t)~LANES_PIN & LANES_ALL; }

uint8_t lanes_free(uint8_t lanes) {
  alive = lanes;
  scl_low();
  for (uint8_t n = 9; n && alive; n--) alive &= (uint8_t)~bit(0);
  alive = lanes;
  stop();
  return lanes & (uint8_t)~lanes_held();
}
