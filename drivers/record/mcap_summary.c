#include <stdlib.h>
#include <zlib.h>

#include "record/mcap_parts.h"

static void put_statistics(ethd_mcap *m, ethd__bytes *to) {
  ethd__bytes b = {0};
  uint64_t messages = 0;
  for (uint16_t i = 0; i < m->topic_count; i++) messages += m->counts[i];
  ethd__mcap_number(m, &b, messages, 8);
  ethd__mcap_number(m, &b, m->topic_count, 2);
  ethd__mcap_number(m, &b, m->topic_count, 4);
  ethd__mcap_number(m, &b, 0, 4);
  ethd__mcap_number(m, &b, 0, 4);
  ethd__mcap_number(m, &b, m->chunk_count, 4);
  ethd__mcap_number(m, &b, m->chunk_count ? m->chunks[0].first : 0, 8);
  ethd__mcap_number(m, &b, m->chunk_count ? m->chunks[m->chunk_count - 1].last : 0, 8);
  ethd__mcap_number(m, &b, 10u * m->topic_count, 4);
  for (uint16_t i = 0; i < m->topic_count; i++) {
    ethd__mcap_number(m, &b, i, 2);
    ethd__mcap_number(m, &b, m->counts[i], 8);
  }
  ethd__mcap_record(m, to, ETHD__MCAP_STATISTICS, &b);
  free(b.at);
}

static void put_chunk_index(ethd_mcap *m, const ethd__chunk *c, ethd__bytes *to) {
  ethd__bytes b = {0};
  uint32_t topics = 0;
  for (uint16_t i = 0; i < m->topic_count; i++) topics += c->index[i] != 0;
  ethd__mcap_number(m, &b, c->first, 8);
  ethd__mcap_number(m, &b, c->last, 8);
  ethd__mcap_number(m, &b, c->start, 8);
  ethd__mcap_number(m, &b, c->length, 8);
  ethd__mcap_number(m, &b, 10u * topics, 4);
  for (uint16_t i = 0; i < m->topic_count; i++) {
    if (!c->index[i]) continue;
    ethd__mcap_number(m, &b, i, 2);
    ethd__mcap_number(m, &b, c->index[i], 8);
  }
  ethd__mcap_number(m, &b, c->indexes, 8);
  ethd__mcap_string(m, &b, "");
  ethd__mcap_number(m, &b, c->bytes, 8);
  ethd__mcap_number(m, &b, c->bytes, 8);
  ethd__mcap_record(m, to, ETHD__MCAP_CHUNK_INDEX, &b);
  free(b.at);
}

static void put_group(ethd_mcap *m, ethd__bytes *offsets, uint8_t opcode, uint64_t start, uint64_t end) {
  ethd__bytes b = {0};
  if (end == start) return;
  ethd__mcap_number(m, &b, opcode, 1);
  ethd__mcap_number(m, &b, start, 8);
  ethd__mcap_number(m, &b, end - start, 8);
  ethd__mcap_record(m, offsets, ETHD__MCAP_SUMMARY_OFFSET, &b);
  free(b.at);
}

/* Writes groups of records and where they are, then the footer, whose checksum covers all but itself. */
void ethd__mcap_summary(ethd_mcap *m) {
  ethd__bytes s = {0}, offsets = {0};
  uint64_t start = m->at, ends[4];
  ethd__mcap_put(m, &s, m->schemas.at, m->schemas.length);
  ends[0] = start + s.length;
  ethd__mcap_put(m, &s, m->topics.at, m->topics.length);
  ends[1] = start + s.length;
  put_statistics(m, &s);
  ends[2] = start + s.length;
  for (size_t i = 0; i < m->chunk_count; i++) put_chunk_index(m, &m->chunks[i], &s);
  ends[3] = start + s.length;
  put_group(m, &offsets, ETHD__MCAP_SCHEMA, start, ends[0]);
  put_group(m, &offsets, ETHD__MCAP_CHANNEL, ends[0], ends[1]);
  put_group(m, &offsets, ETHD__MCAP_STATISTICS, ends[1], ends[2]);
  put_group(m, &offsets, ETHD__MCAP_CHUNK_INDEX, ends[2], ends[3]);
  ethd__mcap_put(m, &s, offsets.at, offsets.length);
  ethd__mcap_number(m, &s, ETHD__MCAP_FOOTER, 1);
  ethd__mcap_number(m, &s, 20, 8);
  ethd__mcap_number(m, &s, start, 8);
  ethd__mcap_number(m, &s, ends[3], 8);
  if (!m->failed) ethd__mcap_number(m, &s, crc32(0, (const Bytef *)s.at, (uInt)s.length), 4);
  ethd__mcap_write_out(m, s.at, s.length);
  free(s.at);
  free(offsets.at);
}
