/* A register map, an INI file: the meaning of each word of a drive on a Modbus.

     [bus]                       how the drive is reached
     transport = rtu             tcp: port = HOST:PORT
     port = /dev/ttyUSB0
     baud = 500000               any
     format = 8N1
     crc = low-first             high-first: against the standard, but some drives have it so
     unit = 1                    of the registers that don't name another
     [register torque1]          one section a register; address as in the drive's manual (0x or decimal)
     direction = write
     bus_unit = 1                the unit that has it, where several stand on one bus; without: bus.unit
     address = 0x5308            ; unconfirmed, or the document and page that has it
     type = i16                  32-bit types say their order
     unit = A                    value = scale * raw + offset, in this unit, at the motor
     scale = 0.1
     torque_constant = 0.0389    Nm/A
     min = -3                    a command has limits, in its unit
     max = 3
     ratio = 12                  motor turns a joint turn
     sign = -1
     [enable]                    steps in order; numbers are raw
     step1 = write mode 2
     step2 = wait status 0x0008 0x0008 0.5     NAME MASK BITS SECONDS
     step3 = pause 0.01
     [disable]
     [clear]                     at an acknowledgement: what makes the drive leave its fault
     [identify]                  once after connecting
     [watchdog]
     kind = silence              the drive stops by itself when the bus is silent for `time`
     guardian = auto             where it doesn't (kind = none), a process of ours does

   Names with a meaning: torque1 torque2 (written), position1 position2, speed1 speed2, measured1 measured2
   (torque or current), bus_voltage, index1 index2 (a position's count at its last index mark), reading_x reading_y
   reading_count reading_age (a finger's place relative to the ring), counter (a word of ours that the drive keeps),
   counter2 (the same word in a second unit).
   All others serve steps, echoes, or masks. */
#ifndef ETHD__SERVO_MAP_H
#define ETHD__SERVO_MAP_H

#include <stdbool.h>

#include "ethd/config.h"

#define ETHD__SERVO_REGISTERS_MAX 48u
#define ETHD__SERVO_STEPS_MAX 24u
#define ETHD__SERVO_EVERY_MAX 100u
#define ETHD__SERVO_NAME_MAX 24u
#define ETHD__SERVO_PORT_MAX 160u
#define ETHD__SERVO_BYTES_MAX ((size_t)1 << 16)

enum { ETHD__SERVO_TCP, ETHD__SERVO_RTU };
enum { ETHD__SERVO_READ, ETHD__SERVO_WRITE };
enum { ETHD__SERVO_HOLDING, ETHD__SERVO_INPUT };
enum { ETHD__SERVO_U16, ETHD__SERVO_I16, ETHD__SERVO_U32, ETHD__SERVO_I32, ETHD__SERVO_F32 };
enum { ETHD__SERVO_HIGH_FIRST, ETHD__SERVO_LOW_FIRST, ETHD__SERVO_NO_ORDER };
enum { ETHD__SERVO_SEPARATE, ETHD__SERVO_COMBINED }; /* 16 then 3, or 0x17 */
enum { ETHD__SERVO_BY_WORD, ETHD__SERVO_BY_VALUE };
enum { ETHD__SERVO_CRC_LOW_FIRST, ETHD__SERVO_CRC_HIGH_FIRST };
enum { ETHD__SERVO_GUARD_AUTO, ETHD__SERVO_GUARD_NEVER, ETHD__SERVO_GUARD_ALWAYS };
enum { ETHD__SERVO_WATCH_NONE, ETHD__SERVO_WATCH_SILENCE, ETHD__SERVO_WATCH_COUNTER };

/* Names with a meaning, in the order of ethd__servo_roles. */
enum {
  ETHD__SERVO_TORQUE1,
  ETHD__SERVO_TORQUE2,
  ETHD__SERVO_COUNTER,
  ETHD__SERVO_COUNTER2,
  ETHD__SERVO_POSITION1,
  ETHD__SERVO_POSITION2,
  ETHD__SERVO_SPEED1,
  ETHD__SERVO_SPEED2,
  ETHD__SERVO_MEASURED1,
  ETHD__SERVO_MEASURED2,
  ETHD__SERVO_BUS_VOLTAGE,
  ETHD__SERVO_INDEX1,
  ETHD__SERVO_INDEX2,
  ETHD__SERVO_READING_X,
  ETHD__SERVO_READING_Y,
  ETHD__SERVO_READING_COUNT,
  ETHD__SERVO_READING_AGE,
  ETHD__SERVO_ROLES
};

typedef struct ethd__servo_role {
  const char *name, *units; /* units: the allowed units of its register, "A|Nm" */
  int direction;
} ethd__servo_role;

extern const ethd__servo_role ethd__servo_roles[ETHD__SERVO_ROLES];

/* A [register]. Masks and addresses are whole numbers. */
typedef struct ethd__servo_register {
  char name[ETHD__SERVO_NAME_MAX];
  int32_t line, role;                                    /* role -1: none */
  int32_t direction, space, type, order, unit, reversed; /* reversed: 1 where sign is -1 */
  uint32_t bus_unit;                                     /* its unit on the bus */
  uint32_t address;                                      /* as on the wire, from 0 */
  double scale, offset, min, max, ratio;
  double counts, torque_constant;    /* per motor turn; Nm/A */
  uint32_t bits;                     /* width of a position's counter */
  double speed_max;                  /* rad/s of the joint: a faster counter jumped */
  double freeze_torque, freeze_time; /* Nm, s: as in encoder/unwrap.h; a torque of 0: a share of the largest */
  double reverse_torque, reverse_time, inertia;
  uint32_t every;                 /* exchanges from one reading to the next; 1: in each */
  double rate;                    /* 1/s, of the readings that a reading_count counts */
  double tolerance;               /* of measured torque, in its unit; 0: not watched */
  uint32_t fault_mask, healthy;   /* (raw & fault_mask) != healthy: the drive reports a fault */
  uint32_t enabled_mask, enabled; /* (raw & enabled_mask) == enabled: the drive is enabled */
  int32_t echo;                   /* the register that holds the same raw value after a write; -1: none */
  int32_t absolute;               /* 1: a position that means the same angle after the drive was without power */
  bool cyclic;                    /* part of every exchange */
  bool unconfirmed;               /* marked so at its address: no document of the maker names it */
} ethd__servo_register;

enum { ETHD__SERVO_STEP_WRITE, ETHD__SERVO_STEP_WAIT, ETHD__SERVO_STEP_PAUSE };

typedef struct ethd__servo_step {
  int32_t kind, line, at; /* at: register */
  uint32_t mask, bits;    /* of a wait */
  double value;           /* raw, of a write; s otherwise */
} ethd__servo_step;

typedef struct ethd__servo_steps {
  ethd__servo_step at[ETHD__SERVO_STEPS_MAX];
  uint32_t count;
} ethd__servo_steps;

enum { ETHD__SERVO_IDENTIFY, ETHD__SERVO_ENABLE, ETHD__SERVO_DISABLE, ETHD__SERVO_CLEAR, ETHD__SERVO_SEQUENCES };

/* Names of the sequences' sections. */
extern const char *const ethd__servo_sequences[ETHD__SERVO_SEQUENCES];

typedef struct ethd__servo_map {
  int32_t transport, format, exchange, addressing;
  int32_t crc, local_echo; /* of rtu: order of the checksum's bytes; 1: sent bytes come back first */
  int32_t rs485;           /* direction switched by: 0 the adapter, 1 RTS high while sending, 2 RTS low */
  char port[ETHD__SERVO_PORT_MAX];
  uint32_t baud, unit, base, divisor, gap;
  double turnaround; /* s: from the end of a question to the begin of its answer; 0: not known */
  double connect, response, drain, silence, back_off; /* s */
  int32_t watchdog, resumes;
  int32_t guardian;     /* a process that writes zero when we are silent: without a watchdog, never, always */
  double watchdog_time; /* s */
  ethd__servo_register registers[ETHD__SERVO_REGISTERS_MAX];
  uint32_t count;
  int32_t roles[ETHD__SERVO_ROLES]; /* the register of each role; -1: none */
  ethd__servo_steps sequences[ETHD__SERVO_SEQUENCES];
} ethd__servo_map;

/* Adjacent words in one unit. */
typedef struct ethd__servo_span {
  uint32_t unit;
  int32_t space;
  uint32_t address, count; /* as on the wire: from 0, words */
} ethd__servo_span;

/* "8N1|8E1|8O1|8N2", in the order of `format`; "1|Nm|A|..." of `unit`. */
extern const char ethd__servo_formats[], ethd__servo_units[];

/* Reads a map. Every refusal is one line with file:line. [main] */
ETHD_MUST_CHECK ethd_status ethd__servo_map_parse(const char *text, size_t length, const char *name,
                                                  ethd__servo_map *out, char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__servo_map_load(const char *path, const char *name, ethd__servo_map *out,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Returns whether registers of several units are on the bus. [any] */
bool ethd__servo_several(const ethd__servo_map *map);

/* Returns whether the unit of torque `axis`, 0 or 1, has a register of this kind; true without such a torque. [any] */
bool ethd__servo_unit_has(const ethd__servo_map *map, int axis, bool (*is)(const ethd__servo_register *));

/* Returns how many registers' addresses say `; unconfirmed`. [any] */
uint32_t ethd__servo_unconfirmed(const ethd__servo_map *map);

/* Returns sentence i about a gap of this map: no watchdog, no echo, ...; NULL after the last. [main] */
const char *ethd__servo_risk(const ethd__servo_map *map, uint32_t i);

#endif
