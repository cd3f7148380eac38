/* Telemetry: one JSON object in each datagram, as PlotJuggler's UDP server reads it. All [main]. */
#ifndef ETHD__APPS_RUN_TELEMETRY_H
#define ETHD__APPS_RUN_TELEMETRY_H

#include <stdbool.h>

#include "ethd/config.h"
#include "run/front.h"

/* Opens a socket, *out, to HOST:PORT, or [HOST]:PORT for addresses with colons. `what` names it in messages. Refuses a
   multicast or broadcast address unless `group` is set; the refusal names the option --telemetry-group. */
ETHD_MUST_CHECK ethd_status ethd__telemetry_open(const char *what, const char *address, bool group, int *out,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Sends a datagram without waiting; drops it if it can't be sent at once. `columns`: of the row's trace. */
void ethd__telemetry_send(int socket, const ethd_column *columns, const ethd__row_head *row);

#endif
