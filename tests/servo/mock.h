/* A drive on a Modbus of our own making, independent of libmodbus, that can be made to misbehave: on a TCP port or
   behind a pseudo terminal, on a thread of its own. Its registers are those of apps/config/plant.map. */
#ifndef ETHD_TESTS_SERVO_MOCK_H
#define ETHD_TESTS_SERVO_MOCK_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

typedef enum mock_kind {
  MOCK_ANSWER,
  MOCK_DROP,      /* no answer, the request isn't heeded */
  MOCK_LATE,      /* answers after `wait` */
  MOCK_HALF,      /* half of the answer, the rest after `wait` */
  MOCK_CUT,       /* half of the answer, never the rest */
  MOCK_GARBLE,    /* one bit of the answer's data is wrong; tcp: its transaction number is */
  MOCK_EXCEPTION, /* `code` */
  MOCK_OLD,       /* the answer to the request of this kind before */
  MOCK_RESET,     /* the connection is reset, or the terminal closed */
  MOCK_HOLD       /* answers when mock_release is called */
} mock_kind;

typedef struct mock_act {
  mock_kind kind;
  int32_t code;
  int64_t wait; /* us */
} mock_act;

/* What to do with request n, of this function. */
typedef mock_act (*mock_plan)(void *user, uint64_t n, int function);

typedef struct mock {
  _Atomic uint16_t words[65536];
  _Atomic uint16_t second[65536]; /* words of unit 2, a drive of its own on the same line */
  atomic_int mute;                /* the unit that is gone: it heeds nothing and doesn't answer; 0: none */
  atomic_int astray;              /* not 0: added to the unit in its answers */
  _Atomic mock_plan act;          /* NULL: answer */
  void *_Atomic user;
  atomic_int frozen; /* 1: the motors stay as they were */
  atomic_int stuck;  /* not 0: what torque1 holds whatever is written */
  int is_rtu;
  atomic_int crc_high; /* rtu: its checksum has the high byte first; what has another isn't heard */
  atomic_int mirror;   /* rtu: what is sent to it comes back first */
  atomic_uint_fast64_t requests, connections;
  atomic_int stop, released, holding;
  int listener, line; /* line: connection, or the terminal's other end */
  int slave;          /* keeps the terminal alive between openings */
  char port[64];      /* as a map says it */
  pthread_t thread;
  uint8_t last[2][2][512]; /* answers before, of unit 2 or another: to reads, to writes */
  int last_length[2][2];
} mock;

/* Registers of apps/config/plant.map. */
enum {
  MOCK_CONTROL,
  MOCK_TORQUE1,
  MOCK_TORQUE2,
  MOCK_COUNTER,
  MOCK_STATUS,
  MOCK_POSITION1 = 5,
  MOCK_POSITION2 = 7,
  MOCK_MEASURED1 = 9,
  MOCK_MEASURED2,
  MOCK_VOLTAGE,
  MOCK_READING_X = 12,
  MOCK_READING_Y = 14,
  MOCK_READING_COUNT = 16,
  MOCK_READING_AGE
};

/* Healthy, disabled, 48 V, answering. is_rtu: behind a pseudo terminal. */
void mock_start(mock *m, int is_rtu);
void mock_stop(mock *m);

/* Takes the line away and refuses new ones, until mock_plug. Only tcp. */
void mock_unplug(mock *m);
void mock_plug(mock *m);

void mock_release(mock *m);

/* CRC of RTU frames. */
uint16_t mock_crc(const uint8_t *data, int length);

#endif
