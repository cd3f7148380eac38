/* From words to numbers and back. libmodbus's own float helpers aren't inverse of each other in every build. */
#ifndef ETHD_SERVO_WORDS_H
#define ETHD_SERVO_WORDS_H

#include "servo/map.h"

/* 1 or 2. [any] */
uint32_t ethd__servo_words(const ethd__servo_register *r);

/* The smallest and largest raw number of a type, exact. [any] */
void ethd__servo_range(const ethd__servo_register *r, double *min, double *max);

/* Raw numbers: whole but for f32. Pack cuts at the type's range, and takes 0 for what isn't a number. [any] */
void ethd__servo_pack(const ethd__servo_register *r, double raw, uint16_t *out);
double ethd__servo_unpack(const ethd__servo_register *r, const uint16_t *words);

/* The words as one unsigned number. [any] */
uint32_t ethd__servo_bits(const ethd__servo_register *r, const uint16_t *words);

/* A joint's torque as a raw number, cut at the register's limits; a raw number in SI at the joint. [any] */
double ethd__servo_raw(const ethd__servo_register *r, double joint);
double ethd__servo_joint(const ethd__servo_register *r, double raw);

/* SI at the motor of one unit. [any] */
double ethd__servo_factor(const ethd__servo_register *r);

/* Largest torque at the joint that the register's limits allow, both ways. [any] */
double ethd__servo_most(const ethd__servo_register *r);

#endif
