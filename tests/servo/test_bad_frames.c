/* Small damage to a drive's answer: each length, each bit, each pair of bits, in the servo's own framing. Nothing damaged
   is taken for an answer, and how many cases there were is asserted, so that none is left out unseen. The answers are put
   together here, with the checksum of the test's own drive. */
#include <modbus/modbus.h>
#include <stdio.h>
#include <string.h>

#include "servo/frame.h"
#include "servo/mock.h"
#include "unit/rig.h"

#define WORDS 4

static ethd__servo_map map;
static ethd__servo_frame question;
static uint8_t good[ETHD__SERVO_FRAME_MAX];
static int good_length;
static uint16_t words[ETHD__SERVO_FRAME_MAX / 2];

/* ---- the servo's answers ---- */

enum { WAITS = -1, TAKEN = 0 }; /* or the errno of a refusal */

/* What our framing makes of bytes that come one by one, as drivers/servo/ask.c asks it. */
static int hear(const uint8_t *bytes, int length) {
  memset(words, 0xA5, sizeof words);
  for (int got = 1, whole = 0; got <= length; got++) {
    if (!ethd__servo_frame_begins(&map, &question, bytes, got)) return EMBBADDATA;
    if (!whole) whole = ethd__servo_frame_whole(&map, &question, bytes, got);
    if (whole == got) return ethd__servo_frame_take(&map, &question, bytes, got, words);
  }
  return WAITS;
}

static bool untouched(void) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (words[i] != 0xA5A5) return false;
  return true;
}

static void put(int value) { good[good_length++] = (uint8_t)value; }

/* As the specification has it (V1.1b3, p. 15, 16, 30, 38): station, function, and bytes of data or what was written
   where. */
static void answer_to(int function, int count) {
  const bool is_tcp = map.transport == ETHD__SERVO_TCP;
  const int data = function == 16 ? 4 : 1 + 2 * count;
  good_length = 0;
  if (is_tcp)
    for (int i = 0; i < 6; i++) put(i < 4 ? question.bytes[i] : i == 5 ? 2 + data : 0);
  put((int)map.unit);
  put(function);
  if (function == 16)
    for (int i = 0; i < 4; i++) put(question.bytes[good_length]);
  else
    put(2 * count);
  for (int i = 0; function != 16 && i < 2 * count; i++) put(0x11 * (i + 1));
  uint16_t crc = mock_crc(good, good_length);
  if (is_tcp) return;
  put(map.crc == ETHD__SERVO_CRC_HIGH_FIRST ? crc >> 8 : crc & 0xFF);
  put(map.crc == ETHD__SERVO_CRC_HIGH_FIRST ? crc & 0xFF : crc >> 8);
}

static void ask(int function, int count) {
  const uint16_t out[WORDS] = {1, 2, 3, 4};
  const int32_t space = function == 4 ? ETHD__SERVO_INPUT : ETHD__SERVO_HOLDING;
  const ethd__servo_span at = {map.unit, space, 0x5308, (uint32_t)count}, from = {map.unit, 0, 0x5414, (uint32_t)count};
  if (function == 3 || function == 4)
    ethd__servo_frame_read(&map, at, &question);
  else if (function == 16)
    ethd__servo_frame_write(&map, at, out, &question);
  else
    ethd__servo_frame_both(&map, (ethd__servo_span){map.unit, 0, 0x5308, 2}, out, from, &question);
  answer_to(function, count);
  ck_assert_int_eq(hear(good, good_length), TAKEN);
  ck_assert_int_eq(untouched(), function == 16);
}

typedef struct sweep {
  long lengths, bits, pairs, data; /* data: bits of a tcp answer's words, which nothing protects */
} sweep;

static void flip(uint8_t *bytes, int bit) { bytes[bit / 8] ^= (uint8_t)(1 << bit % 8); }

static void refused(const uint8_t *bytes, int length) {
  ck_assert_int_ne(hear(bytes, length), TAKEN);
  ck_assert(untouched());
}

static void damage_answer(int function, sweep *s) {
  const int bits = 8 * good_length;
  uint8_t bad[ETHD__SERVO_FRAME_MAX];
  for (int n = 0; n < good_length; n++, s->lengths++) ck_assert_int_eq(hear(good, n), WAITS);
  for (int a = 0; a < bits; a++) {
    bool is_word = map.transport == ETHD__SERVO_TCP && function != 16 && a / 8 >= 9;
    memcpy(bad, good, sizeof bad);
    flip(bad, a);
    if (is_word) {
      s->data++;
      continue;
    }
    refused(bad, good_length);
    s->bits++;
    for (int b = 0; map.transport == ETHD__SERVO_RTU && b < a; b++, s->pairs++) {
      flip(bad, b);
      refused(bad, good_length);
      flip(bad, b);
    }
  }
}

TEST(test_servo) {
  static const int functions[] = {3, 4, 16, 23};
  const struct {
    int transport, crc;
  } lines[] = {{ETHD__SERVO_RTU, ETHD__SERVO_CRC_HIGH_FIRST},
               {ETHD__SERVO_RTU, ETHD__SERVO_CRC_LOW_FIRST},
               {ETHD__SERVO_TCP, ETHD__SERVO_CRC_LOW_FIRST}};
  sweep s = {0, 0, 0, 0};
  for (size_t l = 0; l < sizeof lines / sizeof *lines; l++)
    for (size_t f = 0; f < sizeof functions / sizeof *functions; f++)
      for (int count = 1; count <= WORDS; count++) {
        map = (ethd__servo_map){.transport = lines[l].transport, .crc = lines[l].crc, .unit = 17};
        ask(functions[f], count);
        damage_answer(functions[f], &s);
      }
  printf("servo: %ld lengths, %ld bits, %ld pairs of bits refused; %ld bits of words are tcp's own to protect\n",
         s.lengths, s.bits, s.pairs, s.data);
  /* by hand: an rtu answer has 7, 9, 11, 13 bytes (3, 4 and 23), or 8 (16); a tcp answer 11, 13, 15, 17, or 12 */
  ck_assert_int_eq(s.lengths, 2 * (3 * 40 + 32) + 3 * 56 + 48);
  ck_assert_int_eq(s.bits, 8 * (2 * (3 * 40 + 32) + 3 * 4 * 9 + 48));
  ck_assert_int_eq(s.pairs, 2 * (3 * (56 * 55 + 72 * 71 + 88 * 87 + 104 * 103) + 4 * 64 * 63) / 2);
  ck_assert_int_eq(s.data, 8 * 3 * (2 + 4 + 6 + 8));
}
