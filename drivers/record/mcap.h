/* MCAP: a container of time-stamped messages (https://mcap.dev/spec) that PlotJuggler and Foxglove open.
   Messages are JSON, in chunks with an index and a summary; nothing is compressed. All [main]. */
#ifndef ETHD__RECORD_MCAP_H
#define ETHD__RECORD_MCAP_H

#include "ethd/config.h"

typedef struct ethd_mcap ethd_mcap;

/* Creates a file, which takes its path's place when it is closed. */
ETHD_MUST_CHECK ethd_status ethd_mcap_create(const char *path, ethd_mcap **out, char message[ETHD_MESSAGE_MAX]);

/* Adds a topic ("/tick") whose messages have `schema`, a JSON schema of an object, and returns its number. At most 8,
   all before the first message. */
uint16_t ethd_mcap_topic(ethd_mcap *mcap, const char *topic, const char *name, const char *schema);

/* Writes a message, a JSON text. time_ns >= 0, and never less than that of the message before. */
void ethd_mcap_message(ethd_mcap *mcap, uint16_t topic, int64_t time_ns, const char *json, size_t length);

/* Writes the index, puts the file in its place and frees; reports whatever went wrong. */
ETHD_MUST_CHECK ethd_status ethd_mcap_close(ethd_mcap *mcap, char message[ETHD_MESSAGE_MAX]);
/* Frees and leaves what was there before; NULL is allowed. */
void ethd_mcap_abandon(ethd_mcap *mcap);

#endif
