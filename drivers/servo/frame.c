#include "servo/frame.h"

#include <modbus/modbus.h>
#include <stdbool.h>
#include <string.h>

#define HEAD 6 /* bytes of a tcp frame before the unit */

enum { READ_HOLDING = 3, READ_INPUT = 4, WRITE = 16, BOTH = 23, REFUSED = 0x80 };

static void put(uint8_t *at, uint32_t word) {
  at[0] = (uint8_t)(word >> 8);
  at[1] = (uint8_t)word;
}

static uint32_t get(const uint8_t *at) { return (uint32_t)at[0] << 8 | at[1]; }

static int head(const ethd__servo_map *map) { return map->transport == ETHD__SERVO_TCP ? HEAD : 0; }
static int tail(const ethd__servo_map *map) { return map->transport == ETHD__SERVO_TCP ? 0 : 2; }

uint16_t ethd__servo_crc(const uint8_t *bytes, int length) {
  uint16_t crc = 0xFFFF;
  for (int i = 0; i < length; i++) {
    crc ^= bytes[i];
    for (int k = 0; k < 8; k++) crc = (uint16_t)(crc & 1 ? crc >> 1 ^ 0xA001 : crc >> 1);
  }
  return crc;
}

/* The checksum in the map's order: high byte first as the SVD48V has it, or low byte first. */
static uint16_t checksum(const ethd__servo_map *map, const uint8_t *bytes, int length) {
  uint16_t crc = ethd__servo_crc(bytes, length);
  return map->crc == ETHD__SERVO_CRC_HIGH_FIRST ? crc : (uint16_t)(crc << 8 | crc >> 8);
}

/* ---- questions ---- */

static uint8_t *begin(const ethd__servo_map *map, uint32_t unit, int function, ethd__servo_frame *out) {
  memset(out, 0, sizeof *out);
  uint8_t *at = out->bytes + head(map);
  at[0] = (uint8_t)unit;
  at[1] = (uint8_t)function;
  return at + 2;
}

/* Ends a question of `data` bytes after the function; `answer` is that number of a good answer. */
static void end(const ethd__servo_map *map, int data, int answer, ethd__servo_frame *out) {
  int n = head(map) + 2 + data;
  if (head(map))
    put(out->bytes + 4, (uint32_t)(2 + data));
  else
    put(out->bytes + n, checksum(map, out->bytes, n));
  out->length = n + tail(map);
  out->answer = head(map) + 2 + answer + tail(map);
}

static void put_span(uint8_t *at, ethd__servo_span span) {
  put(at, span.address);
  put(at + 2, span.count);
}

static void put_words(uint8_t *at, uint32_t count, const uint16_t *words) {
  at[0] = (uint8_t)(2 * count);
  for (uint32_t i = 0; i < count; i++) put(at + 1 + 2 * i, words[i]);
}

void ethd__servo_frame_read(const ethd__servo_map *map, ethd__servo_span from, ethd__servo_frame *out) {
  put_span(begin(map, from.unit, from.space == ETHD__SERVO_INPUT ? READ_INPUT : READ_HOLDING, out), from);
  end(map, 4, 1 + 2 * (int)from.count, out);
}

void ethd__servo_frame_write(const ethd__servo_map *map, ethd__servo_span to, const uint16_t *words,
                             ethd__servo_frame *out) {
  uint8_t *at = begin(map, to.unit, WRITE, out);
  put_span(at, to);
  put_words(at + 4, to.count, words);
  end(map, 5 + 2 * (int)to.count, 4, out);
}

void ethd__servo_frame_both(const ethd__servo_map *map, ethd__servo_span to, const uint16_t *words,
                            ethd__servo_span from, ethd__servo_frame *out) {
  uint8_t *at = begin(map, to.unit, BOTH, out);
  put_span(at, from);
  put_span(at + 4, to);
  put_words(at + 8, to.count, words);
  end(map, 9 + 2 * (int)to.count, 1 + 2 * (int)from.count, out);
}

void ethd__servo_frame_number(const ethd__servo_map *map, uint16_t number, ethd__servo_frame *question) {
  if (head(map)) put(question->bytes, number);
}

/* ---- answers ---- */

bool ethd__servo_frame_begins(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                              int length) {
  int at = head(map);
  if (at && memcmp(answer, question->bytes, (size_t)(length < 4 ? length : 4)) != 0) return false;
  if (length > at && answer[at] != question->bytes[at]) return false;
  return length <= at + 1 || (answer[at + 1] & ~REFUSED) == question->bytes[at + 1];
}

int ethd__servo_frame_whole(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                            int length) {
  int at = head(map) + 1;
  if (length <= at) return 0;
  return answer[at] & REFUSED ? head(map) + 3 + tail(map) : question->answer;
}

static int refusal(uint8_t code) { return code >= 1 && code <= 11 ? MODBUS_ENOBASE + code : EMBBADEXC; }

/* True when the answer has the question's unit, function and number, and the expected number of bytes. */
static bool is_to(const ethd__servo_map *map, const ethd__servo_frame *q, const uint8_t *a, int length) {
  int h = head(map), read = q->bytes[h + 1] != WRITE;
  if (h && (memcmp(a, q->bytes, 4) != 0 || (int)get(a + 4) != length - h)) return false;
  if (a[h] != q->bytes[h] || (a[h + 1] & ~REFUSED) != q->bytes[h + 1]) return false;
  if (a[h + 1] & REFUSED) return true;
  return read ? a[h + 2] == q->answer - h - 3 - tail(map) : memcmp(a + h + 2, q->bytes + h + 2, 4) == 0;
}

int ethd__servo_frame_take(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                           int length, uint16_t *words) {
  const uint8_t *a = answer + head(map);
  if (!head(map) && get(answer + length - 2) != checksum(map, answer, length - 2)) return EMBBADCRC;
  if (!is_to(map, question, answer, length)) return EMBBADDATA;
  if (a[1] & REFUSED) return refusal(a[2]);
  for (int i = 0; words && a[1] != WRITE && i < a[2] / 2; i++) words[i] = (uint16_t)get(a + 3 + 2 * i);
  return 0;
}
