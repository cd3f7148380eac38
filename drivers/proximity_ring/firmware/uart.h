/* Sends frames: COBS, zero at the end, by interrupt while the next period runs. */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

#include "../frame.h"

/* slow: 400 kBd, else 500; both are exact at 16 MHz. */
void uart_open(bool slow);

/* Encodes and sends the frame. It waits for nothing, because the frame before was sent long ago. */
void uart_send(const uint8_t frame[ETHD__FRAME_SIZE]);

#endif
