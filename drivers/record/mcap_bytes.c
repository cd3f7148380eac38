#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "record/mcap_parts.h"

static bool room_for(ethd__bytes *b, size_t more) {
  if (b->length + more <= b->room) return true;
  size_t room = 2 * b->room + more + 256;
  char *at = realloc(b->at, room);
  if (!at) return false;
  b->at = at;
  b->room = room;
  return true;
}

void ethd__mcap_put(ethd_mcap *m, ethd__bytes *b, const void *data, size_t length) {
  if (!room_for(b, length)) {
    m->failed = 1;
    return;
  }
  if (length) memcpy(b->at + b->length, data, length);
  b->length += length;
}

void ethd__mcap_number(ethd_mcap *m, ethd__bytes *b, uint64_t value, size_t width) {
  unsigned char little[8];
  for (size_t i = 0; i < width; i++) little[i] = (unsigned char)(value >> (8 * i));
  ethd__mcap_put(m, b, little, width);
}

void ethd__mcap_string(ethd_mcap *m, ethd__bytes *b, const char *text) {
  ethd__mcap_number(m, b, strlen(text), 4);
  ethd__mcap_put(m, b, text, strlen(text));
}

/* A record is its opcode, the length of its content, and the content. */
void ethd__mcap_record(ethd_mcap *m, ethd__bytes *to, uint8_t opcode, const ethd__bytes *content) {
  ethd__mcap_number(m, to, opcode, 1);
  ethd__mcap_number(m, to, content->length, 8);
  ethd__mcap_put(m, to, content->at, content->length);
}

void ethd__mcap_write_out(ethd_mcap *m, const void *data, size_t length) {
  if (length && fwrite(data, 1, length, m->replace.file) != length) m->failed = 1;
  m->at += length;
}

void ethd__mcap_write_record(ethd_mcap *m, uint8_t opcode, ethd__bytes *content) {
  ethd__bytes b = {0};
  ethd__mcap_record(m, &b, opcode, content);
  ethd__mcap_write_out(m, b.at, b.length);
  free(b.at);
  content->length = 0;
}
