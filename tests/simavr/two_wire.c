#include "two_wire.h"

#include <string.h>

#include <sim_interrupts.h>
#include <sim_io.h>

/* Registers of the ATmega328P, by their data address, and bits of TWCR. */
enum { TWBR = 0xB8, TWSR, TWAR, TWDR, TWCR };
enum { TWIE = 1, TWEN = 4, TWSTO = 16, TWSTA = 32, TWEA = 64, TWINT = 128 };

static uint8_t *control(two_wire_port *p) { return &p->avr->data[TWCR]; }
static bool on(two_wire_port *p) { return *control(p) & TWEN; }
static bool waits(two_wire_port *p) { return *control(p) & TWINT; } /* for its firmware */

static avr_cycle_count_t bits(two_wire_port *p, int count) {
  int prescaler = 1 << 2 * (p->avr->data[TWSR] & 3);
  return (avr_cycle_count_t)(count * (16 + 2 * p->avr->data[TWBR] * prescaler));
}

static void tell(two_wire_port *p, uint8_t status) {
  p->avr->data[TWSR] = (uint8_t)((p->avr->data[TWSR] & 3) | status);
  avr_raise_interrupt(p->avr, &p->twi->twi);
}

bool two_wire_sda(const two_wire *bus) {
  bool low = bus->shorted || bus->stuck > 0;
  for (int n = 0; n < TWO_WIRE_PORTS; n++) low = low || bus->port[n].pulls_sda;
  return !low;
}

bool two_wire_scl(const two_wire *bus) {
  bool low = false;
  for (int n = 0; n < TWO_WIRE_PORTS; n++) low = low || bus->port[n].pulls_scl;
  return !low;
}

/* ---- what takes time on the bus ---- */

static avr_cycle_count_t started(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr, (void)when;
  two_wire_port *p = param;
  two_wire *bus = p->bus;
  if (!on(p) || !(*control(p) & TWSTA) || !two_wire_sda(bus)) return 0;
  bus->master = (int)(p - bus->port);
  bus->phase = TWO_WIRE_STARTED;
  tell(p, 0x08);
  return 0;
}

static int find_slave(two_wire *bus, uint8_t address) {
  for (int n = 0; n < TWO_WIRE_PORTS; n++) {
    two_wire_port *p = &bus->port[n];
    bool listens = p->avr && n != bus->master && on(p) && *control(p) & TWEA && !waits(p);
    if (listens && p->avr->data[TWAR] >> 1 == address >> 1 && address & 1) return n;
  }
  return -1;
}

static avr_cycle_count_t addressed(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr, (void)when;
  two_wire_port *p = param;
  two_wire *bus = p->bus;
  bus->slave = two_wire_sda(bus) ? find_slave(bus, p->avr->data[TWDR]) : -1;
  bus->phase = bus->slave >= 0 ? TWO_WIRE_READING : TWO_WIRE_ENDED;
  if (bus->slave >= 0) tell(&bus->port[bus->slave], 0xA8);
  tell(p, bus->slave >= 0 ? 0x40 : 0x48);
  return 0;
}

static avr_cycle_count_t exchanged(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr, (void)when;
  two_wire_port *p = param;
  two_wire *bus = p->bus;
  bool more = *control(p) & TWEA;
  uint8_t data = bus->slave >= 0 ? bus->port[bus->slave].avr->data[TWDR] : 0xFF;
  p->avr->data[TWDR] = two_wire_sda(bus) ? data : 0;
  if (bus->corrupt > 0) {
    bus->corrupt--;
    p->avr->data[TWDR] ^= 0x11;
  }
  bus->bytes++;
  tell(p, more ? 0x50 : 0x58);
  if (bus->slave >= 0) tell(&bus->port[bus->slave], more ? 0xB8 : 0xC0);
  if (more) return 0;
  bus->slave = -1;
  bus->phase = TWO_WIRE_ENDED;
  return 0;
}

/* A byte goes over when neither end holds SCL any more. */
static void exchange(two_wire *bus) {
  if (bus->phase != TWO_WIRE_READING || bus->master < 0 || waits(&bus->port[bus->master])) return;
  if (bus->slave >= 0 && waits(&bus->port[bus->slave])) return;
  two_wire_port *p = &bus->port[bus->master];
  avr_cycle_timer_register(p->avr, bits(p, 9), exchanged, p);
}

/* ---- what the firmware does ---- */

static void release(two_wire *bus) {
  bus->master = bus->slave = -1;
  bus->phase = TWO_WIRE_IDLE;
}

static void let_go(two_wire *bus, int n) {
  two_wire_port *p = &bus->port[n];
  avr_cycle_timer_cancel(p->avr, started, p);
  avr_cycle_timer_cancel(p->avr, addressed, p);
  avr_cycle_timer_cancel(p->avr, exchanged, p);
  if (bus->slave == n) bus->slave = -1;
  if (bus->master != n) return;
  if (bus->slave >= 0) bus->stuck = 5;
  bus->master = -1;
  bus->phase = TWO_WIRE_IDLE;
}

static void act(two_wire *bus, int n) {
  two_wire_port *p = &bus->port[n];
  if (*control(p) & TWSTO) {
    *control(p) &= (uint8_t)~TWSTO;
    if (bus->master == n) release(bus);
  } else if (*control(p) & TWSTA) {
    avr_cycle_timer_register(p->avr, bits(p, 1), started, p);
  } else if (bus->master == n && bus->phase == TWO_WIRE_STARTED) {
    avr_cycle_timer_register(p->avr, bits(p, 9), addressed, p);
  } else {
    exchange(bus);
  }
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
  two_wire_port *p = param;
  bool went = value & TWINT, waited = waits(p), was_on = on(p);
  if (went && waited) avr_clear_interrupt(avr, &p->twi->twi);
  avr->data[address] = (uint8_t)((value & (TWEA | TWSTA | TWSTO | TWEN | TWIE)) | (waited && !went ? TWINT : 0));
  int n = (int)(p - p->bus->port);
  if (was_on && !on(p)) let_go(p->bus, n);
  if (on(p) && went) act(p->bus, n);
}

static void write_data(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
  (void)param;
  avr->data[address] = value;
}

static uint8_t read_data(avr_t *avr, avr_io_addr_t address, void *param) {
  (void)param;
  return avr->data[address];
}

void two_wire_pins(two_wire *bus, int n, bool sda_low, bool scl_low) {
  two_wire_port *p = &bus->port[n];
  bool rises = p->pulls_scl && !scl_low;
  p->pulls_sda = sda_low && !on(p);
  p->pulls_scl = scl_low && !on(p);
  if (!rises || !bus->stuck || --bus->stuck) return;
  bus->recoveries++;
  if (bus->slave >= 0) tell(&bus->port[bus->slave], 0xC0);
  bus->slave = -1;
}

void two_wire_reset(two_wire *bus, int n) {
  let_go(bus, n);
  bus->port[n].pulls_sda = bus->port[n].pulls_scl = false;
}

void two_wire_attach(two_wire *bus, int n, avr_t *avr) {
  two_wire_port *p = &bus->port[n];
  if (!n) release(bus);
  p->bus = bus;
  p->avr = avr;
  for (avr_io_t *io = avr->io_port; io; io = io->next) {
    if (!strcmp(io->kind, "twi")) p->twi = (avr_twi_t *)io;
  }
  avr->io[AVR_DATA_TO_IO(TWCR)].w.c = write_control;
  avr->io[AVR_DATA_TO_IO(TWCR)].w.param = p;
  avr->io[AVR_DATA_TO_IO(TWDR)].w.c = write_data;
  avr->io[AVR_DATA_TO_IO(TWDR)].r.c = read_data;
}
