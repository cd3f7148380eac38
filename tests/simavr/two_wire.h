/* The bus between the boards, and the part of the ATmega's two-wire interface that drives it.

   simavr's own model takes a microsecond for a bit whatever the bit rate, and can't transmit as a slave; this one
   takes over its registers: start, address, reading, stop by one master; slaves that transmit and hold SCL until
   they have loaded a byte; the bit rate; SDA held low; a slave that holds SDA because its master was reset in
   the middle of a byte, until it has been clocked through. Nobody writes on this bus, nor are there two masters. */
#ifndef SIMAVR_TWO_WIRE_H
#define SIMAVR_TWO_WIRE_H

#include <stdbool.h>
#include <stdint.h>

#include <avr_twi.h>
#include <sim_avr.h>

#define TWO_WIRE_PORTS 4

typedef struct two_wire two_wire;

typedef struct two_wire_port {
  two_wire *bus;
  avr_t *avr;
  avr_twi_t *twi;
  bool pulls_sda, pulls_scl; /* as plain pins */
} two_wire_port;

struct two_wire {
  two_wire_port port[TWO_WIRE_PORTS];
  int master, slave; /* -1: nobody */
  enum { TWO_WIRE_IDLE, TWO_WIRE_STARTED, TWO_WIRE_READING, TWO_WIRE_ENDED } phase;
  bool shorted; /* SDA to ground */
  int corrupt;  /* bytes that will go over wrongly */
  int stuck;    /* clocks that a slave still holds SDA */
  uint64_t bytes, recoveries;
};

void two_wire_attach(two_wire *bus, int port, avr_t *avr);

/* The port's chip was reset. */
void two_wire_reset(two_wire *bus, int port);

/* The port's two pins as plain outputs that pull low. */
void two_wire_pins(two_wire *bus, int port, bool sda_low, bool scl_low);

bool two_wire_sda(const two_wire *bus);
bool two_wire_scl(const two_wire *bus);

#endif
