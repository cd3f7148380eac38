#include "uart.h"

#include <avr/interrupt.h>

#include "board.h"

static uint8_t wire[ETHD__FRAME_WIRE];
static volatile uint8_t next = ETHD__FRAME_WIRE;

ISR(USART_UDRE_vect) {
  uint8_t n = next;
  UDR0 = wire[n++];
  next = n;
  if (n == ETHD__FRAME_WIRE) UCSR0B = 1 << TXEN0;
}

void uart_open(bool slow) {
  UCSR0A = 1 << U2X0;
  UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
  UBRR0 = slow ? 4 : 3;
  UCSR0B = 1 << TXEN0;
  UDR0 = ETHD__FRAME_DELIMITER; /* ends what a reset may have cut short */
}

/* Each zero becomes the distance to the next one; 42 bytes need one byte more. */
static void cobs(const uint8_t *frame) {
  uint8_t *code = wire;
  uint8_t *out = wire + 1;
  for (uint8_t n = 0; n < ETHD__FRAME_SIZE; n++, out++) {
    *out = frame[n];
    if (frame[n]) continue;
    *code = (uint8_t)(out - code);
    code = out;
  }
  *code = (uint8_t)(out - code);
  *out = ETHD__FRAME_DELIMITER;
}

void uart_send(const uint8_t frame[ETHD__FRAME_SIZE]) {
  UCSR0B = 1 << TXEN0;
  cobs(frame);
  next = 0;
  UCSR0B = (1 << TXEN0) | (1 << UDRIE0);
}
