/* MCAP: a container of time-stamped messages (https://mcap.dev/spec) that PlotJuggler and Foxglove open.
   Messages are JSON, in chunks with an index and a summary; nothing is compressed. All [main]. */
#ifndef ETHD_FILE_MCAP_H
#define ETHD_FILE_MCAP_H

#include "ethd/config.h"

typedef struct ethd_mcap ethd_mcap;

/* The file takes its path's place when it is closed. */
ETHD_MUST_CHECK ethd_status ethd_mcap_create(const char *path, ethd_mcap **out, char message[ETHD_MESSAGE_MAX]);

/* A topic ("/tick") whose messages are as `schema`, a JSON schema of an object, says; at most 8, before the
   first message. Returns its number. */
uint16_t ethd_mcap_topic(ethd_mcap *mcap, const char *topic, const char *name, const char *schema);

/* A JSON text. time_ns >= 0 and rising or equal. */
void ethd_mcap_message(ethd_mcap *mcap, uint16_t topic, int64_t time_ns, const char *json, size_t length);

/* Writes the index, puts the file in its place and frees; reports whatever went wrong. */
ETHD_MUST_CHECK ethd_status ethd_mcap_close(ethd_mcap *mcap, char message[ETHD_MESSAGE_MAX]);
/* Frees and leaves what was there before. NULL is fine. */
void ethd_mcap_abandon(ethd_mcap *mcap);

#endif
