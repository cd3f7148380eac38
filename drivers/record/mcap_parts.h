/* An MCAP file that is being written. */
#ifndef ETHD__RECORD_MCAP_PARTS_H
#define ETHD__RECORD_MCAP_PARTS_H

#include "record/mcap.h"
#include "text/text.h"

#define ETHD__MCAP_TOPICS 8

enum {
  ETHD__MCAP_HEADER = 1,
  ETHD__MCAP_FOOTER,
  ETHD__MCAP_SCHEMA,
  ETHD__MCAP_CHANNEL,
  ETHD__MCAP_MESSAGE,
  ETHD__MCAP_CHUNK,
  ETHD__MCAP_MESSAGE_INDEX,
  ETHD__MCAP_CHUNK_INDEX,
  ETHD__MCAP_STATISTICS = 11,
  ETHD__MCAP_SUMMARY_OFFSET = 14,
  ETHD__MCAP_DATA_END
};

typedef struct ethd__bytes {
  char *at;
  size_t length, room;
} ethd__bytes;

typedef struct ethd__chunk {
  uint64_t first, last, start, length, indexes, bytes; /* first and last instant; where it is in the file, and sizes */
  uint64_t index[ETHD__MCAP_TOPICS];                   /* where each topic's index is, 0: none */
} ethd__chunk;

struct ethd_mcap {
  ethd_replace replace;
  ethd__bytes records;                  /* of the chunk that is being filled */
  ethd__bytes index[ETHD__MCAP_TOPICS]; /* its messages: instant and offset */
  ethd__bytes topics;                   /* schemas and channels, which the summary repeats */
  ethd__bytes schemas;
  ethd__chunk *chunks;
  size_t chunk_count, chunk_room;
  ethd__chunk open;
  uint64_t counts[ETHD__MCAP_TOPICS];
  uint16_t topic_count;
  uint64_t at; /* bytes in the file */
  int failed;  /* there was no memory, or a write failed */
};

/* Appends data, little endian; a failure is kept in mcap->failed. [main] */
void ethd__mcap_put(ethd_mcap *mcap, ethd__bytes *to, const void *data, size_t length);
void ethd__mcap_number(ethd_mcap *mcap, ethd__bytes *to, uint64_t value, size_t width);
void ethd__mcap_string(ethd_mcap *mcap, ethd__bytes *to, const char *text);

/* Appends opcode, length and content. [main] */
void ethd__mcap_record(ethd_mcap *mcap, ethd__bytes *to, uint8_t opcode, const ethd__bytes *content);

/* Writes data to the file. [main] */
void ethd__mcap_write_out(ethd_mcap *mcap, const void *data, size_t length);
void ethd__mcap_write_record(ethd_mcap *mcap, uint8_t opcode, ethd__bytes *content);

/* Writes topics, statistics, the chunks' index, and the footer. [main] */
void ethd__mcap_summary(ethd_mcap *mcap);

#endif
