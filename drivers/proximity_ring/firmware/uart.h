/* Sends frames: COBS, zero at the end, by interrupt while the next period runs. */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#include "../frame.h"

/* slow: 400 kBd, else 500; both are exact at 16 MHz. */
void uart_open(bool slow);

/* Codes and sends the frame; it waits for nothing: the frame before has long gone. */
void uart_send(const uint8_t frame[ETHD__FRAME_SIZE]);

#endif
