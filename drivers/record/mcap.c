#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "ethd/ethd.h"
#include "record/mcap_parts.h"
#include "text/error_text.h"

#define CHUNK_BYTES (1u << 20) /* a chunk is closed once it has this many */
#define MAGIC "\x89MCAP0\r\n"

/* ---- beginning ---- */

ethd_status ethd_mcap_create(const char *path, ethd_mcap **out, char message[ETHD_MESSAGE_MAX]) {
  ethd_mcap *m = calloc(1, sizeof *m);
  *out = NULL;
  if (!m) return ethd__no_memory(message, path);
  ethd_status status = ethd_replace_begin(path, &m->replace, message);
  if (status) {
    free(m);
    return status;
  }
  ethd__bytes b = {0};
  ethd__mcap_write_out(m, MAGIC, 8);
  ethd__mcap_string(m, &b, "");
  ethd__mcap_string(m, &b, "libethd " ETHD_VERSION);
  ethd__mcap_write_record(m, ETHD__MCAP_HEADER, &b);
  free(b.at);
  *out = m;
  return ETHD_OK;
}

/* Schema i + 1 belongs to channel i. */
uint16_t ethd_mcap_topic(ethd_mcap *m, const char *topic, const char *name, const char *schema) {
  ethd__bytes b = {0};
  uint16_t id = m->topic_count++;
  ethd__mcap_number(m, &b, id + 1u, 2);
  ethd__mcap_string(m, &b, name);
  ethd__mcap_string(m, &b, "jsonschema");
  ethd__mcap_string(m, &b, schema);
  ethd__mcap_record(m, &m->schemas, ETHD__MCAP_SCHEMA, &b);
  b.length = 0;
  ethd__mcap_number(m, &b, id, 2);
  ethd__mcap_number(m, &b, id + 1u, 2);
  ethd__mcap_string(m, &b, topic);
  ethd__mcap_string(m, &b, "json");
  ethd__mcap_number(m, &b, 0, 4);
  ethd__mcap_record(m, &m->topics, ETHD__MCAP_CHANNEL, &b);
  free(b.at);
  return id;
}

/* ---- chunks ---- */

static void write_indexes(ethd_mcap *m) {
  ethd__bytes b = {0};
  for (uint16_t i = 0; i < m->topic_count; i++) {
    if (!m->index[i].length) continue;
    m->open.index[i] = m->at;
    ethd__mcap_number(m, &b, i, 2);
    ethd__mcap_number(m, &b, m->index[i].length, 4);
    ethd__mcap_put(m, &b, m->index[i].at, m->index[i].length);
    ethd__mcap_write_record(m, ETHD__MCAP_MESSAGE_INDEX, &b);
    m->index[i].length = 0;
  }
  free(b.at);
}

static void keep_chunk(ethd_mcap *m) {
  if (m->chunk_count == m->chunk_room) {
    size_t room = 2 * m->chunk_room + 16;
    ethd__chunk *chunks = realloc(m->chunks, room * sizeof *chunks);
    if (!chunks) {
      m->failed = 1;
      return;
    }
    m->chunks = chunks;
    m->chunk_room = room;
  }
  m->chunks[m->chunk_count++] = m->open;
}

static void end_chunk(ethd_mcap *m) {
  ethd__bytes b = {0};
  if (!m->records.length) return;
  ethd__mcap_number(m, &b, m->open.first, 8);
  ethd__mcap_number(m, &b, m->open.last, 8);
  ethd__mcap_number(m, &b, m->records.length, 8);
  ethd__mcap_number(m, &b, crc32(0, (const Bytef *)m->records.at, (uInt)m->records.length), 4);
  ethd__mcap_string(m, &b, "");
  ethd__mcap_number(m, &b, m->records.length, 8);
  ethd__mcap_put(m, &b, m->records.at, m->records.length);
  m->open.bytes = m->records.length;
  m->open.start = m->at;
  ethd__mcap_write_record(m, ETHD__MCAP_CHUNK, &b);
  m->open.length = m->at - m->open.start;
  write_indexes(m);
  m->open.indexes = m->at - m->open.start - m->open.length;
  keep_chunk(m);
  m->records.length = 0;
  m->open = (ethd__chunk){0};
  free(b.at);
}

/* Begins a chunk. The first one holds the topics too, so that a file whose end is lost can still be read. */
static void begin_chunk(ethd_mcap *m, uint64_t now) {
  m->open.first = now;
  if (m->chunk_count) return;
  ethd__mcap_put(m, &m->records, m->schemas.at, m->schemas.length);
  ethd__mcap_put(m, &m->records, m->topics.at, m->topics.length);
}

void ethd_mcap_message(ethd_mcap *m, uint16_t topic, int64_t time_ns, const char *json, size_t length) {
  uint64_t now = (uint64_t)time_ns;
  if (!m->records.length) begin_chunk(m, now);
  m->open.last = now;
  ethd__mcap_number(m, &m->index[topic], now, 8);
  ethd__mcap_number(m, &m->index[topic], m->records.length, 8);
  ethd__mcap_number(m, &m->records, ETHD__MCAP_MESSAGE, 1);
  ethd__mcap_number(m, &m->records, 22 + length, 8);
  ethd__mcap_number(m, &m->records, topic, 2);
  ethd__mcap_number(m, &m->records, m->counts[topic]++, 4);
  ethd__mcap_number(m, &m->records, now, 8);
  ethd__mcap_number(m, &m->records, now, 8);
  ethd__mcap_put(m, &m->records, json, length);
  if (m->records.length >= CHUNK_BYTES) end_chunk(m);
}

/* ---- ending ---- */

static void release(ethd_mcap *m) {
  for (uint16_t i = 0; i < ETHD__MCAP_TOPICS; i++) free(m->index[i].at);
  free(m->records.at);
  free(m->schemas.at);
  free(m->topics.at);
  free(m->chunks);
  free(m);
}

void ethd_mcap_abandon(ethd_mcap *m) {
  if (!m) return;
  ethd_replace_abandon(&m->replace);
  release(m);
}

ethd_status ethd_mcap_close(ethd_mcap *m, char message[ETHD_MESSAGE_MAX]) {
  ethd__bytes b = {0};
  end_chunk(m);
  ethd__mcap_number(m, &b, 0, 4);
  ethd__mcap_write_record(m, ETHD__MCAP_DATA_END, &b);
  free(b.at);
  ethd__mcap_summary(m);
  ethd__mcap_write_out(m, MAGIC, 8);
  if (m->failed && !ferror(m->replace.file)) {
    ethd_mcap_abandon(m);
    return ethd__no_memory(message, NULL);
  }
  ethd_status status = ethd_replace_commit(&m->replace, message);
  release(m);
  return status;
}
