/* The wire from board 0 to the host: a pseudo-terminal, and what can go wrong with bytes on the way. */
#ifndef SIMAVR_TERMINAL_H
#define SIMAVR_TERMINAL_H

#include <stdbool.h>
#include <stdint.h>

typedef struct terminal {
  int master, slave; /* -1: unplugged */
  char name[64];
  const char *alias; /* a symbolic link to it, or NULL */
  bool patient;      /* wait for a reader, instead of dropping what isn't read */
  bool baud_matters; /* the host must have set the UART's speed, else it reads rubbish */
  double baud;
  uint8_t buffer[4096];
  int filled;
  int corrupt, lose; /* how many more bytes to corrupt, to lose */
  uint32_t random;
  uint64_t sent, lost;
} terminal;

/* False, and one line on stderr, when there is no terminal to be had. */
bool terminal_plug(terminal *t);
void terminal_unplug(terminal *t);

void terminal_byte(void *terminal, uint8_t byte);
void terminal_flush(terminal *t);

#endif
