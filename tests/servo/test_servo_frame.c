/* Modbus frames of our own against frames that others published, and against wrong answers. */
#include <errno.h>
#include <modbus/modbus.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clock.h"
#include "servo/bus_parts.h"
#include "servo/frame.h"
#include "unit/rig.h"

static ethd__servo_map map;
static ethd__servo_frame f;
static uint16_t words[125];

static void speak(int32_t transport, int32_t crc, uint32_t unit) {
  map = (ethd__servo_map){.transport = transport, .crc = crc, .unit = unit};
  memset(words, 0xA5, sizeof words);
}

static void is(const uint8_t *bytes, int length) {
  ck_assert_int_eq(f.length, length);
  ck_assert_mem_eq(f.bytes, bytes, (size_t)length);
}
#define IS(...) is((const uint8_t[]){__VA_ARGS__}, (int)sizeof((uint8_t[]){__VA_ARGS__}))

static int answer(const uint8_t *bytes, int length) {
  for (int n = 0; n < length; n++) /* known as soon as the function is there, and not before */
    ck_assert_int_eq(ethd__servo_frame_whole(&map, &f, bytes, n),
                     n > (map.transport == ETHD__SERVO_TCP ? 7 : 1) ? length : 0);
  return ethd__servo_frame_take(&map, &f, bytes, length, words);
}
#define ANSWER(...) answer((const uint8_t[]){__VA_ARGS__}, (int)sizeof((uint8_t[]){__VA_ARGS__}))

/* SVD48V Series User Manual V2.0, p. 12 and 13: each frame as it is printed. */
TEST(test_svd48v_manual) {
  speak(ETHD__SERVO_RTU, ETHD__SERVO_CRC_HIGH_FIRST, 0xEE);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x5410, 1}, &f);
  IS(0xEE, 0x03, 0x54, 0x10, 0x00, 0x01, 0x60, 0x83);
  ck_assert_int_eq(ANSWER(0xEE, 0x03, 0x02, 0x00, 0x03, 0x92, 0x2D), 0);
  ck_assert_uint_eq(words[0], 3);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x5410, 2}, &f);
  IS(0xEE, 0x03, 0x54, 0x10, 0x00, 0x02, 0x61, 0xC3);
  ck_assert_int_eq(ANSWER(0xEE, 0x03, 0x04, 0x00, 0x07, 0x00, 0x02, 0xFD, 0xD4), 0);
  ck_assert(words[0] == 7 && words[1] == 2 && words[2] == 0xA5A5);
  ethd__servo_frame_write(&map, (ethd__servo_span){map.unit, 0, 0x5100, 1}, (const uint16_t[]){2}, &f);
  IS(0xEE, 0x10, 0x51, 0x00, 0x00, 0x01, 0x02, 0x00, 0x02, 0x60, 0xEF);
  ck_assert_int_eq(ANSWER(0xEE, 0x10, 0x51, 0x00, 0x00, 0x01, 0xAA, 0x07), 0);
}

/* MODBUS over serial line V1.02 has the checksum's low byte first; the application protocol V1.1b3 has these exchanges:
   p. 15 (read holding registers), p. 30 (write multiple registers), p. 38 (read and write). */
TEST(test_standard) {
  speak(ETHD__SERVO_RTU, ETHD__SERVO_CRC_LOW_FIRST, 1);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0, 10}, &f);
  IS(0x01, 0x03, 0x00, 0x00, 0x00, 0x0A, 0xC5, 0xCD);
  speak(ETHD__SERVO_TCP, 0, 17);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x6B, 3}, &f);
  IS(0, 0, 0, 0, 0, 6, 17, 0x03, 0x00, 0x6B, 0x00, 0x03);
  ck_assert_int_eq(ANSWER(0, 0, 0, 0, 0, 9, 17, 0x03, 0x06, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64), 0);
  ck_assert(words[0] == 0x022B && words[1] == 0 && words[2] == 0x64);
  ethd__servo_frame_write(&map, (ethd__servo_span){map.unit, 0, 1, 2}, (const uint16_t[]){0x000A, 0x0102}, &f);
  IS(0, 0, 0, 0, 0, 11, 17, 0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0A, 0x01, 0x02);
  ck_assert_int_eq(ANSWER(0, 0, 0, 0, 0, 6, 17, 0x10, 0x00, 0x01, 0x00, 0x02), 0);
  ethd__servo_frame_both(&map, (ethd__servo_span){map.unit, 0, 0x0E, 3}, (const uint16_t[]){0xFF, 0xFF, 0xFF},
                         (ethd__servo_span){map.unit, 0, 3, 6}, &f);
  IS(0, 0, 0, 0, 0, 17, 17, 0x17, 0x00, 0x03, 0x00, 0x06, 0x00, 0x0E, 0x00, 0x03, 0x06, 0x00, 0xFF, 0x00, 0xFF, 0x00,
     0xFF);
  ck_assert_int_eq(
      ANSWER(0, 0, 0, 0, 0, 15, 17, 0x17, 0x0C, 0x00, 0xFE, 0x0A, 0xCD, 0x00, 0x01, 0x00, 0x03, 0x00, 0x0D, 0x00, 0xFF),
      0);
  ck_assert(words[0] == 0xFE && words[1] == 0x0ACD && words[5] == 0xFF);
  speak(ETHD__SERVO_TCP, 0, 17);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_INPUT, 8, 1}, &f);
  IS(0, 0, 0, 0, 0, 6, 17, 0x04, 0x00, 0x08, 0x00, 0x01);
}

static void seal(uint8_t *a, int length) {
  uint16_t crc = ethd__servo_crc(a, length - 2);
  a[length - 2] = (uint8_t)(crc >> 8);
  a[length - 1] = (uint8_t)crc;
}

/* Noise is told by its first bytes, without waiting until the answer is due. */
TEST(test_begins) {
  const uint8_t good[] = {0xEE, 0x03}, refused[] = {0xEE, 0x83}, other[] = {0xEE, 0x10}, noise[] = {0x5A};
  speak(ETHD__SERVO_RTU, ETHD__SERVO_CRC_HIGH_FIRST, 0xEE);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x5410, 1}, &f);
  for (int n = 0; n <= 2; n++) ck_assert(ethd__servo_frame_begins(&map, &f, good, n));
  ck_assert(ethd__servo_frame_begins(&map, &f, refused, 2));
  ck_assert(!ethd__servo_frame_begins(&map, &f, other, 2));
  ck_assert(!ethd__servo_frame_begins(&map, &f, noise, 1));
  const uint8_t tcp[] = {0, 0, 0, 0, 0, 9, 17, 0x03}, elses[] = {0, 0, 0, 0, 0, 9, 18, 0x03};
  speak(ETHD__SERVO_TCP, 0, 17);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x6B, 3}, &f);
  for (int n = 0; n <= 8; n++) ck_assert(ethd__servo_frame_begins(&map, &f, tcp, n));
  ck_assert(ethd__servo_frame_begins(&map, &f, elses, 6) && !ethd__servo_frame_begins(&map, &f, elses, 7));
}

TEST(test_wrong_answers) {
  uint8_t good[] = {1, 3, 4, 0, 7, 0, 2, 0, 0}, refused[] = {1, 0x83, 2, 0, 0};
  speak(ETHD__SERVO_RTU, ETHD__SERVO_CRC_HIGH_FIRST, 1);
  ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x5414, 2}, &f);
  seal(good, 9);
  ck_assert_int_eq(ethd__servo_frame_take(&map, &f, good, 9, words), 0);
  map.crc = ETHD__SERVO_CRC_LOW_FIRST; /* the standard's order isn't this drive's */
  ck_assert_int_eq(ethd__servo_frame_take(&map, &f, good, 9, words), EMBBADCRC);
  map.crc = ETHD__SERVO_CRC_HIGH_FIRST;
  for (int i = 0; i < 3; i++) { /* sealed, but of another unit, function, or length */
    uint8_t other[9];
    memcpy(other, good, 9);
    other[i] = i == 2 ? 2 : 4;
    seal(other, 9);
    ck_assert_int_eq(ethd__servo_frame_take(&map, &f, other, 9, words), EMBBADDATA);
  }
  seal(refused, 5);
  ck_assert_int_eq(ethd__servo_frame_whole(&map, &f, refused, 5), 5);
  ck_assert_int_eq(ethd__servo_frame_take(&map, &f, refused, 5, words), EMBXILADD);
  ethd__servo_frame_write(&map, (ethd__servo_span){map.unit, 0, 0x5308, 2}, (const uint16_t[]){1, 2}, &f);
  uint8_t elsewhere[] = {1, 16, 0x53, 0x09, 0, 2, 0, 0};
  seal(elsewhere, 8);
  ck_assert_int_eq(ethd__servo_frame_take(&map, &f, elsewhere, 8, NULL), EMBBADDATA);
}

/* A connection that was reset, or that has ended, is an error at once: no signal, and no wait for the answer. */
TEST(test_ended_connection) {
  for (int k = 0; k < 2; k++) {
    int ends[2];
    speak(ETHD__SERVO_TCP, 0, 17);
    map.response = 60;
    ethd__servo_frame_read(&map, (ethd__servo_span){map.unit, ETHD__SERVO_HOLDING, 0x6B, 3}, &f);
    ck_assert_int_eq(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    const ethd__servo_bus bus = {.map = &map, .fd = ends[0]};
    ck_assert_int_eq(k ? shutdown(ends[1], SHUT_WR) : close(ends[1]), 0);
    const int64_t began = ethd__clock_now();
    ck_assert_int_eq(ethd__servo_ask(&bus, &f, words), k ? ECONNRESET : EPIPE);
    ck_assert_int_lt(ethd__clock_now() - began, 30000000000);
    close(ends[0]);
    if (k) close(ends[1]);
  }
}
