/* Modbus questions as bytes. libmodbus doesn't support a serial line with the checksum's high byte first or with a
   local echo, nor several units on one bus; and the guardian has no time for a library.

     rtu   unit | function, data | checksum              checksum low byte first by the standard
     tcp   number, 0, length | unit | function, data */
#ifndef ETHD__SERVO_FRAME_H
#define ETHD__SERVO_FRAME_H

#include "servo/map.h"

#define ETHD__SERVO_FRAME_MAX 264

typedef struct ethd__servo_frame {
  uint8_t bytes[ETHD__SERVO_FRAME_MAX];
  int length; /* of the question */
  int answer; /* bytes of a good answer */
} ethd__servo_frame;

/* Functions 3 or 4, 16, and 0x17, to the span's unit (`both`: that of `to`). Their number on tcp is 0. [any] */
void ethd__servo_frame_read(const ethd__servo_map *map, ethd__servo_span from, ethd__servo_frame *out);
void ethd__servo_frame_write(const ethd__servo_map *map, ethd__servo_span to, const uint16_t *words,
                             ethd__servo_frame *out);
void ethd__servo_frame_both(const ethd__servo_map *map, ethd__servo_span to, const uint16_t *words,
                            ethd__servo_span from, ethd__servo_frame *out);

/* Gives a question its number, which its answer repeats; does nothing for rtu, which has none. [any] */
void ethd__servo_frame_number(const ethd__servo_map *map, uint16_t number, ethd__servo_frame *question);

/* True while the bytes so far can begin an answer: they have the question's number, unit and function. False for noise
   and for another unit's answer; waiting longer is then useless. [any] */
bool ethd__servo_frame_begins(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                              int length);

/* The length of the answer that begins with these bytes; 0: too few bytes to know it. */
int ethd__servo_frame_whole(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                            int length);

/* Stores a whole answer's words; `words` is NULL if none are expected. Returns 0 or an errno of libmodbus: EMBBADCRC,
   EMBBADDATA for an answer to another question, EMBXILADD and the like for the drive's refusals. [any] */
int ethd__servo_frame_take(const ethd__servo_map *map, const ethd__servo_frame *question, const uint8_t *answer,
                           int length, uint16_t *words);

/* CRC-16 of Modbus. [any] */
uint16_t ethd__servo_crc(const uint8_t *bytes, int length);

#endif
