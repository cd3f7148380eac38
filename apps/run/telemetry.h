/* Telemetry: a JSON object a datagram, as PlotJuggler's UDP server reads it. All [main]. */
#ifndef ETHD_APPS_RUN_TELEMETRY_H
#define ETHD_APPS_RUN_TELEMETRY_H

#include <stdbool.h>

#include "ethd/config.h"
#include "ethd/loop.h"

/* HOST:PORT, [HOST]:PORT for numbers with colons; *out is the socket. A multicast or broadcast address is refused, unless
   `group`; the refusal names the option --telemetry-group. */
ETHD_MUST_CHECK ethd_status ethd__telemetry_open(const char *address, bool group, int *out,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Never waits: a datagram that can't leave is dropped. */
void ethd__telemetry_send(int socket, const ethd_loop_row *row);

#endif
