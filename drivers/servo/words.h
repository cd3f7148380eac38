/* Converts words to numbers and back. libmodbus's own float helpers aren't each other's inverse in every build. */
#ifndef ETHD__SERVO_WORDS_H
#define ETHD__SERVO_WORDS_H

#include "servo/map.h"

/* Returns how many words the register has: 1 or 2. [any] */
uint32_t ethd__servo_words(const ethd__servo_register *r);

/* Returns where the register's words are. [any] */
ethd__servo_span ethd__servo_span_of(const ethd__servo_register *r);

/* Fills the smallest and largest raw number of a type, exactly. [any] */
void ethd__servo_range(const ethd__servo_register *r, double *min, double *max);

/* Raw numbers are whole except f32. Packing cuts them at the type's range and stores 0 for NaN. [any] */
void ethd__servo_pack(const ethd__servo_register *r, double raw, uint16_t *out);
double ethd__servo_unpack(const ethd__servo_register *r, const uint16_t *words);

/* Returns the words as one unsigned number. [any] */
uint32_t ethd__servo_bits(const ethd__servo_register *r, const uint16_t *words);

/* Converts a joint's torque, Nm, to a raw number within the register's limits, rounded towards zero: the drive never
   gets more than the command. NaN gives zero. [any] */
double ethd__servo_raw(const ethd__servo_register *r, double joint);

/* Converts a raw number to SI at the joint. [any] */
double ethd__servo_joint(const ethd__servo_register *r, double raw);

/* Returns the size of one unit of the register in SI at the motor. [any] */
double ethd__servo_factor(const ethd__servo_register *r);

/* Returns the smallest nonzero torque, Nm at the joint; 0 for f32. [any] */
double ethd__servo_least(const ethd__servo_register *r);

/* Returns the largest torque at the joint that the register's limits allow in both directions. [any] */
double ethd__servo_most(const ethd__servo_register *r);

#endif
