/* The keys of a map, as tables: name, range, default, meaning. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "ethd/param.h"
#include "servo/map_parts.h"
#include "text/error_text.h"
#include "text/key.h"
#include "text/text.h"

const char ethd__servo_formats[] = "8N1|8E1|8O1|8N2";

#define AT(type, field) offsetof(ethd__servo_##type, field)
#define OPEN_LIMIT 1e12
#define WORD_MAX 4294967295.0

static const ethd__key_row bus[] = {
    {{"transport", "tcp|rtu", 0, 1, (double)NAN, "Modbus/TCP, or RTU on a serial line"}, AT(map, transport), NULL},
    {{"format", ethd__servo_formats, 0, 3, 0, "bits, parity and stop bits of a serial byte"}, AT(map, format), NULL},
    {{"baud", ETHD_WHOLE, 1200, 12e6, 0, "baud rate of the serial line"}, AT(map, baud), NULL},
    {{"unit", ETHD_WHOLE, 0, 255, 1, "station number of the drive"}, AT(map, unit), NULL},
    {{"base", ETHD_WHOLE, 0, 1, 0, "address of the first register in the manual"}, AT(map, base), NULL},
    {{"divisor", ETHD_WHOLE, 1, 1000, 1, "ticks of the loop for each exchange"}, AT(map, divisor), NULL},
    {{"gap", ETHD_WHOLE, 0, 32, 0, "most unnamed registers that a read may span"}, AT(map, gap), NULL},
    {{"addressing", "words|values", 0, 1, 0, "what an address counts; values: each value is read alone"},
     AT(map, addressing),
     NULL},
    {{"crc", "low-first|high-first", 0, 1, 0, "rtu: order of the checksum's two bytes; low-first is the standard"},
     AT(map, crc),
     NULL},
    {{"rs485", "adapter|rts|rts-low", 0, 2, 0,
      "rtu: control of a two-wire line's direction: by the adapter, or by RTS, high or low while sending"},
     AT(map, rs485),
     NULL},
    {{"local_echo", "no|yes", 0, 1, 0, "rtu: yes if sent bytes come back, as on a two-wire line with an open receiver"},
     AT(map, local_echo),
     NULL},
    {{"exchange", "separate|combined", 0, 1, 0, "functions of an exchange: 16 then 3, or 0x17"},
     AT(map, exchange),
     NULL},
    {{"connect", "s", 1e-3, 60, 1, "longest time to connect"}, AT(map, connect), NULL},
    {{"response", "s", 1e-4, 10, 0.02, "longest time for an answer"}, AT(map, response), NULL},
    {{"drain", "s", 1e-4, 10, 2e-3, "silence that ends a damaged message"}, AT(map, drain), NULL},
    {{"silence", "s", 0, 1, -1, "silence before a request; rtu: 3.5 bytes by default"}, AT(map, silence), NULL},
    {{"turnaround", "s", 0, 1, 0,
      "rtu: time from the end of a request to the begin of its answer, as ethd-conform --probe measures it"},
     AT(map, turnaround),
     NULL},
    {{"back_off", "s", 1e-3, 60, 0.05, "wait between attempts to connect, doubled up to 32 times"},
     AT(map, back_off),
     NULL},
};

static const ethd__key_row watchdog[] = {
    {{"kind", "none|silence|counter", 0, 2, 0,
      "the drive's own watchdog, which removes the torque when the bus is silent"},
     AT(map, watchdog),
     NULL},
    {{"time", "s", 1e-3, 60, 0, "time after which the drive's watchdog acts"}, AT(map, watchdog_time), NULL},
    {{"guardian", "auto|no|yes", 0, 2, 0,
      "guardian process that writes zero torque when the program is silent; auto: if kind = none"},
     AT(map, guardian),
     NULL},
    {{"resumes", "no|yes", 0, 1, 0, "yes: the drive applies torque again as soon as the bus is back"},
     AT(map, resumes),
     NULL},
};

static const ethd__key_row keys[] = {
    {{"direction", "read|write", 0, 1, (double)NAN, "read or written by the loop"}, AT(register, direction), NULL},
    {{"address", ETHD_WHOLE, 0, 65536, (double)NAN, "address in the manual"}, AT(register, address), NULL},
    {{"bus_unit", ETHD_WHOLE, 0, 247, 0, "station number of the register; bus.unit by default"},
     AT(register, bus_unit),
     NULL},
    {{"space", "holding|input", 0, 1, 0, "holding: functions 3 and 16; input: function 4"}, AT(register, space), NULL},
    {{"type", "u16|i16|u32|i32|f32", 0, 4, (double)NAN, "type of the value"}, AT(register, type), NULL},
    {{"order", "high-first|low-first", 0, 1, 2, "order of two words"}, AT(register, order), NULL},
    {{"unit", ethd__servo_units, 0, 11, 0, "unit of the value at the motor"}, AT(register, unit), NULL},
    {{"scale", "1", -1e9, 1e9, 1, "units for each raw count"}, AT(register, scale), NULL},
    {{"offset", "1", -1e9, 1e9, 0, "units at the raw value 0"}, AT(register, offset), NULL},
    {{"min", "1", -OPEN_LIMIT, OPEN_LIMIT, -OPEN_LIMIT, "least value, in the register's unit"},
     AT(register, min),
     NULL},
    {{"max", "1", -OPEN_LIMIT, OPEN_LIMIT, OPEN_LIMIT, "largest value, in the register's unit"},
     AT(register, max),
     NULL},
    {{"ratio", "1", 1e-3, 1e4, 1, "motor turns for each turn of the joint"}, AT(register, ratio), NULL},
    {{"sign", "1|-1", 0, 1, 0, "sense of the joint's rotation"}, AT(register, reversed), NULL},
    {{"counts", "1", 1, 1e9, 0, "counts for each turn of the motor"}, AT(register, counts), NULL},
    {{"torque_constant", "Nm/A", 1e-6, 1e3, 0, "torque constant of the motor"}, AT(register, torque_constant), NULL},
    {{"bits", ETHD_WHOLE, 8, 32, 0, "bits of a position's counter; the type's by default"}, AT(register, bits), NULL},
    {{"speed_max", "rad/s", 0.01, 1e4, 40, "highest speed of a joint; a faster change of its counter is a jump"},
     AT(register, speed_max),
     NULL},
    {{"freeze_torque", "Nm", 1e-6, 1e6, 0, "change of torque that must move a joint: over twice its friction"},
     AT(register, freeze_torque),
     NULL},
    {{"freeze_time", "s", 1e-3, 10, 0.05, "longest time until that change moves the joint"},
     AT(register, freeze_time),
     NULL},
    {{"reverse_torque", "Nm", 1e-6, 1e6, 0,
      "opposing torque against which a joint can't gain speed: over its friction"},
     AT(register, reverse_torque),
     NULL},
    {{"reverse_time", "s", 1e-3, 10, 0.02, "time for which a joint may gain speed against that torque"},
     AT(register, reverse_time),
     NULL},
    {{"inertia", "kg m^2", 1e-9, 1e6, 0.01, "inertia of the joint, for reverse_torque and reverse_time"},
     AT(register, inertia),
     NULL},
    {{"absolute", "no|yes", 0, 1, 0, "yes if a position keeps its meaning while the drive has no power"},
     AT(register, absolute),
     NULL},
    {{"every", ETHD_WHOLE, 1, ETHD__SERVO_EVERY_MAX, 1, "exchanges from one reading to the next, for slow values"},
     AT(register, every),
     NULL},
    {{"rate", "1/s", 1, 1e5, 300, "rate of the readings that the counter counts"}, AT(register, rate), NULL},
    {{"tolerance", "1", 1e-9, 1e9, 0, "largest difference of measured and commanded torque, in the register's unit"},
     AT(register, tolerance),
     NULL},
    {{"fault_mask", ETHD_WHOLE, 1, WORD_MAX, 0, "bits that show a fault"}, AT(register, fault_mask), NULL},
    {{"healthy", ETHD_WHOLE, 0, WORD_MAX, 0, "value of these bits without a fault"}, AT(register, healthy), NULL},
    {{"enabled_mask", ETHD_WHOLE, 1, WORD_MAX, 0, "bits that show whether the drive is enabled"},
     AT(register, enabled_mask),
     NULL},
    {{"enabled", ETHD_WHOLE, 0, WORD_MAX, 0, "value of these bits when the drive is enabled"},
     AT(register, enabled),
     NULL},
};

#define ROWS(table) table, sizeof table / sizeof *table

ethd_status ethd__servo_read_bus(const ethd__key_file *s, int line, ethd__servo_map *map) {
  ethd_status status = ethd__keys_known(s, "bus", ROWS(bus), "port");
  if (!status) status = ethd__keys_read(s, "bus", line, ROWS(bus), map);
  if (status) return status;
  const ethd_ini_key *port = ethd_ini_find(s->ini, "bus", "port");
  if (!port)
    return ethd__say(s->message, ETHD_E_UNKNOWN, "%s:%d: bus.port is missing: HOST:PORT, or a serial device", s->name,
                     line);
  if (strlen(port->value) >= sizeof map->port) return ethd__servo_refuse(s, port, "a shorter name");
  strcpy(map->port, port->value);
  if (map->transport == ETHD__SERVO_RTU && !map->baud)
    return ethd__say(s->message, ETHD_E_UNKNOWN, "%s:%d: bus.baud is missing: rtu needs it", s->name, line);
  const char *serial_only = map->crc ? "crc" : map->local_echo ? "local_echo" : map->rs485 ? "rs485" : NULL;
  if (serial_only && map->transport != ETHD__SERVO_RTU)
    return ethd__servo_refuse(s, ethd_ini_find(s->ini, "bus", serial_only), "transport = rtu");
  if (map->silence < 0) map->silence = map->transport == ETHD__SERVO_RTU ? 3.5 * 11 / map->baud : 0;
  return ETHD_OK;
}

ethd_status ethd__servo_read_watchdog(const ethd__key_file *s, int line, ethd__servo_map *map) {
  ethd_status status = ethd__keys_known(s, "watchdog", ROWS(watchdog), NULL);
  if (!status) status = ethd__keys_read(s, "watchdog", line, ROWS(watchdog), map);
  if (!status && map->watchdog && !(map->watchdog_time > 0))
    status = ethd__say(s->message, ETHD_E_UNKNOWN, "%s:%d: watchdog.time is missing: %s", s->name, line,
                       watchdog[1].param.brief);
  return status;
}

ethd_status ethd__servo_read_register(const ethd__key_file *s, const ethd_ini_section *section,
                                      const ethd__servo_map *map, ethd__servo_register *out) {
  ethd_status status = ethd__keys_known(s, section->name, ROWS(keys), "echo");
  if (!status) status = ethd__keys_read(s, section->name, section->line, ROWS(keys), out);
  if (status) return status;
  const ethd_ini_key *address = ethd_ini_find(s->ini, section->name, "address");
  uint32_t words = out->type >= ETHD__SERVO_U32 ? 2 : 1;
  if (out->address < map->base || out->address - map->base + words > 65536)
    return ethd__servo_refuse(s, address, map->base ? "1 to 65536 less the words" : "0 to 65535 less the words");
  out->address -= map->base;
  const ethd_ini_key *unit = ethd_ini_find(s->ini, section->name, "bus_unit");
  if (!unit) out->bus_unit = map->unit;
  if (unit && map->transport == ETHD__SERVO_RTU && !out->bus_unit)
    return ethd__servo_refuse(s, unit, "1 to 247: on a serial line 0 is for all units, and none answers");
  if (out->scale == 0) return ethd__servo_refuse(s, ethd_ini_find(s->ini, section->name, "scale"), "a number but 0");
  if (!out->bits) out->bits = 16 * words;
  return ETHD_OK;
}
