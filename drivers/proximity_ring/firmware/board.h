/* One board of the ring: an ATmega328P at 16 MHz with four VCNL4000. Pins, addresses, times.

     PC0..PC3  SDA of sensor 0..3     one line each, since all sensors answer to the same address
     PB0       SCL of the four        one line for all
     PC4, PC5  SDA, SCL of the bus between the boards (the chip's own two-wire interface)
     PD2       start: board 0 pulls it low for a moment at the start of each period
     PD1       UART out (board 0)
     PD5, PD6  straps of the board's number, to ground = 1; PD7 to ground: 400 kBd instead of 500

   All buses and the start line are open drain: a pin is either an input or pulls low, its PORT bit stays 0. */
#ifndef BOARD_H
#define BOARD_H

#ifndef F_CPU
#define F_CPU 16000000UL
#endif

#include <avr/io.h>

#include "../frame.h"

#define LANES ETHD__FRAME_LANES
#define LANES_ALL 0x0Fu
#define LANES_DDR DDRC
#define LANES_PORT PORTC
#define LANES_PIN PINC
#define LANES_SCL_DDR DDRB
#define LANES_SCL_PORT PORTB
#define LANES_SCL_PIN PINB
#define LANES_SCL (1u << PB0)

#define LINK_DDR DDRC
#define LINK_PIN PINC
#define LINK_SDA (1u << PC4)
#define LINK_SCL (1u << PC5)
#define LINK_ADDRESS 0x20u /* of board 1; 2 and 3 follow */

#define START_DDR DDRD
#define START_PIN (1u << PD2)

#define STRAPS_PORT PORTD
#define STRAPS_PIN PIND
#define STRAP_BOARD PD5 /* and PD6 */
#define STRAP_SLOW PD7

/* Instants within a period, in cycles of the timer (16 in a microsecond). */
#define CYCLES(us) ((uint16_t)((us) * (F_CPU / 1000000UL)))
#define SLOT CYCLES(ETHD__FRAME_SLOT_US)
#define COLLECT CYCLES(2070u) /* board 0 fetches the others' blocks: by then they are ready */

#endif
