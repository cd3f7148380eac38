/* Register maps that are refused, each with its line. volume.c tries texts that are no maps. */
#include <stdio.h>
#include <string.h>

#include "servo/map_text.h"

/* The line of the text where `part` begins. */
static int line_of(const char *all, const char *part) {
  int line = 1;
  for (const char *p = all; p < part; p++) line += *p == '\n';
  return line;
}

/* The map with the first `was` behind `from` replaced is refused, in one line of file:line: why. */
static void refused_behind(const char *from, const char *was, const char *now, const char *why) {
  static char changed[MAP_TEXT_MAX + 4096];
  char *start = strstr(text, from), *at = start ? strstr(start, was) : NULL;
  ck_assert_msg(at != NULL, "no %s behind %s", was, from);
  snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, now, at + strlen(was));
  ck_assert_msg(try(changed) < 0, "%s passes", now);
  ck_assert_msg(strstr(message, why) && !strchr(message, '\n') && !strncmp(message, "m.map:", 6), "%s -> %s, not %s",
                now, message, why);
}
static void refused(const char *was, const char *now, const char *why) { refused_behind("", was, now, why); }

TEST(test_bus_refused) {
  read_map("apps/config/plant.map");
  refused("transport = tcp", "transport = can", ":4: bus.transport: found \"can\", tcp|rtu is allowed");
  refused("transport = tcp", "", ":3: bus.transport is missing");
  refused("[bus]", "[bus_]", "found [bus_]");
  refused("port = 127", "por = 127", ":5: bus.por: unknown key");
  refused("port = 127.0.0.1:1502", "", "bus.port is missing");
  refused("transport = tcp", "transport = rtu", "bus.baud is missing");
  refused("transport = tcp", "transport = rtu\nbaud = 9600.5", "bus.baud");
  refused("transport = tcp", "transport = rtu\nbaud = 100", "bus.baud");
  refused("transport = tcp", "transport = tcp\nformat = 7N1", "bus.format");
  refused("unit = 1", "unit = 256", ":6: bus.unit: found \"256\", a whole number from 0 to 255");
  refused("unit = 1", "unit = 1\nunit = 1", ":7: bus.unit: occurs twice");
  refused("divisor = 1", "divisor = 0", ":7: bus.divisor");
  refused("divisor = 1", "divisor = 1.5", ":7: bus.divisor");
  refused("response = 0.003", "response = 0", "bus.response");
  refused("unit = 1", "unit = 1\nsilence = 2", "bus.silence");
  refused("unit = 1", "unit = 1\nbase = 2", "bus.base");
  refused("unit = 1", "unit = 1\naddressing = bytes", "bus.addressing");
  refused("unit = 1", "unit = 1\nexchange = both", "bus.exchange");
  refused("unit = 1", "unit = 1\ncrc = high-first", "bus.crc: found \"high-first\", transport = rtu is allowed");
  refused("unit = 1", "unit = 1\nlocal_echo = yes", "bus.local_echo: found \"yes\", transport = rtu is allowed");
  refused("unit = 1", "unit = 1\nrs485 = rts", "bus.rs485: found \"rts\", transport = rtu is allowed");
  refused("unit = 1", "unit = 1\nrs485 = yes", "bus.rs485");
  refused("unit = 1", "unit = 1\nturnaround = -1", "bus.turnaround");
  refused("kind = silence", "kind = dog", "watchdog.kind");
  refused("time = 0.05", "", "watchdog.time is missing");
}

TEST(test_register_refused) {
  read_map("apps/config/plant.map");
  refused_behind("[register torque1]", "min = -0.2\n", "",
                 "register torque1.min: is missing: a command needs its limits");
  refused_behind("[register torque1]", "max = 0.2\n", "",
                 "register torque1.max: is missing: a command needs its limits");
  refused_behind("[register torque1]", "min = -0.2", "min = 0.1", "min < 0 < max");
  refused_behind("[register torque1]", "max = 0.2", "max = 20", "the type holds -32768 to 32767");
  refused_behind("[register torque1]", "max = 0.2", "max = 0.2\noffset = 0.00005", "no torque is raw -0.5");
  refused_behind("[register torque1]", "unit = Nm", "unit = V", "register torque1.unit: A|Nm is allowed");
  refused_behind("[register torque1]", "unit = Nm", "unit = A", "torque_constant: is missing");
  refused_behind("[register torque1]", "scale = 1e-4", "scale = 0", "register torque1.scale");
  refused_behind("[register torque1]", "ratio = 9.80", "ratio = 0", "register torque1.ratio");
  refused_behind("[register torque1]", "ratio = 9.80", "ratio = 9.80\nsign = 0.5", "1|-1");
  refused_behind("[register torque1]", "direction = write", "direction = read",
                 "register torque1.direction: write is allowed");
  refused_behind("[register torque1]", "direction = write", "direction = write\nspace = input", "can't be written");
  refused_behind("[register torque1]", "echo = seen1", "echo = seen9",
                 "register torque1.echo: the map has no [register seen9]");
  refused_behind("[register torque1]", "echo = seen1", "echo = torque2", "torque2 isn't read");
  refused_behind("[register torque1]", "echo = seen1", "echo = seen_counter", "seen_counter is of another type");
  refused_behind("[register torque1]", "echo = seen1", "", "nothing uses it");
  refused_behind("[register control]", "type = u16", "type = u16\necho = seen1", "only torque1, torque2 and counter");
  refused_behind("[register counter]", "type = u16", "type = i16", "u16 is allowed");
  refused_behind("[register position1]", "order = high-first\n", "", "register position1.order: is missing");
  refused_behind("[register position1]", "order = high-first", "order = big", "register position1.order");
  refused_behind("[register position1]", "counts = 4000\n", "", "register position1.counts: is missing");
  refused_behind("[register position1]", "type = i32", "type = i24", "register position1.type");
  refused_behind("[register position1]", "type = i32\n", "", "register position1.type is missing");
  refused_behind("[register position1]", "address = 5", "address = 65535", "register position1.address");
  refused_behind("[register position1]", "address = 5", "address = -1", "register position1.address");
  refused_behind("[register position1]", "address = 5", "address = 3",
                 "register position1.address: overlaps [register counter]");
  refused_behind("[register position2]", "address = 7", "address = 6", "register position2.address: overlaps");
  refused_behind("[register position1]", "counts = 4000", "counts = 4000\nbits = 33", "register position1.bits");
  refused_behind("[register measured1]", "unit = Nm", "unit = Nm\nbits = 17", "its words have 16");
  refused_behind("[register position1]", "counts = 4000", "counts = 4000\nevery = 2",
                 "register position1.every: only measured");
  refused_behind("[register seen1]", "type = i16", "type = i16\nevery = 2", "register seen1.every: only measured");
  refused_behind("[register control]", "type = u16", "type = u16\nevery = 2", "register control.every: only measured");
  refused_behind("[register status]", "fault_mask = 0x0001", "fault_mask = 1\nevery = 101", "register status.every");
  refused_behind("[register reading_count]", "type = u16", "type = u16\nrate = 0", "register reading_count.rate");
  refused_behind("[register counter]", "type = u16", "type = u16\nmax = 0.5", "register counter.max: a counter counts");
  refused_behind("[register position1]", "order = high-first", "order = high-first\nabsolute = maybe",
                 "position1.absolute");
  refused_behind("[register seen1]", "type = i16", "type = i16\nabsolute = yes", "only position1 and position2 can be");
  refused_behind("[register torque2]", "address = 2", "address = 1", "writes there too");
  refused_behind("[register status]", "fault_mask = 0x0001", "fault_mask = 0x10000", "is wider than the register");
  refused_behind("[register status]", "fault_mask = 0x0001", "fault_mask = 1\nhealthy = 2", "register status.healthy");
  refused_behind("[register status]", "enabled = 0x0002", "enabled = 4", "register status.enabled");
  refused_behind("[register reading_x]", "type = f32", "type = f32\nfault_mask = 1",
                 "only whole numbers that are read");
  refused_behind("[register seen1]", "type = i16", "type = i16\ntolerance = 1", "only measured1 and measured2");
  refused_behind("[register bus_voltage]", "min = 24\n", "", "min < max are needed");
  refused_behind("[register reading_count]", "type = u16", "type = f32\norder = high-first", "whole numbers");
  refused("[register reading_y]", "[register reading_z]", "reading_z: nothing uses it");
  refused("[register seen2]", "[register Seen2]", "a register's name has");
  refused("[register seen2]", "[register ]", "a register's name has");
  refused("[register seen2]", "[register a_name_of_more_than_23_letters]", "a register's name has");
  refused("[register seen2]", "[register seen1]", "occurs twice");
  refused("[register position2]", "[register speed2]", "unit");
  refused_behind("[register seen2]", "type = i16", "type = i16 ; x\nfoo = 1", "register seen2.foo: unknown key");
}

/* A torque needs its position, and a position its torque. */
TEST(test_roles_refused) {
  static const char *const lean =
      "[bus]\ntransport = tcp\nport = a:1\n[register torque1]\ndirection = write\naddress = 0\ntype = i16\nunit = Nm\n"
      "min = -1\nmax = 1\n";
  snprintf(text, MAP_TEXT_MAX, "%s", lean);
  ck_assert_int_lt(try(text), 0);
  ck_assert_msg(strstr(message, "torque1 and position1 go together") != NULL, "%s", message);
  snprintf(text, MAP_TEXT_MAX, "%s[register position1]\ndirection = read\naddress = 1\ntype = u16\nunit = rad\n", lean);
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  const size_t end = strlen(text);
  snprintf(text + end, MAP_TEXT_MAX - end, "[watchdog]\nkind = counter\ntime = 1\n");
  ck_assert_int_lt(try(text), 0);
  ck_assert_ptr_nonnull(strstr(message, "needs a [register counter]"));
  ck_assert_int_lt(try(""), 0);
  ck_assert_str_eq(message, "m.map: section [bus] is missing");
  ck_assert_int_lt(try("[bus]\ntransport = tcp\nport = a:1\n"), 0);
  ck_assert_ptr_nonnull(strstr(message, "a torque1 or a torque2 is missing"));
}

/* Several units on one bus: equal addresses don't overlap, all else is as within one. */
TEST(test_units_refused) {
  const char *torque2 = "[register torque2]";
  read_map("tests/servo/two_units.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_uint_eq(map.registers[map.roles[ETHD__SERVO_TORQUE1]].bus_unit, 1);
  ck_assert_uint_eq(map.registers[map.roles[ETHD__SERVO_TORQUE2]].bus_unit, 2);
  ck_assert_ptr_null(strstr(ethd__servo_risk(&map, 0), "echo"));
  const char *wrong[] = {"248", "-1", "1.5", "x", "0x", "256"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char unit[32], why[96];
    snprintf(unit, sizeof unit, "bus_unit = %s", wrong[i]);
    snprintf(why, sizeof why, "register torque2.bus_unit: found \"%s\", a whole number from 0 to 247", wrong[i]);
    refused_behind(torque2, "bus_unit = 2", unit, why);
  }
  refused_behind(torque2, "bus_unit = 2\n", "", "register torque2.echo: seen2 is of another unit");
  refused_behind(torque2, "bus_unit = 2", "bus_unit = 3", "register torque2.echo: seen2 is of another unit");
  refused_behind("[register control2]", "bus_unit = 2\n", "",
                 "register control2.address: [register control] of line 16 writes there too");
  refused("[register counter]", "[register counter3]", "counter3.echo: only torque1, torque2 and counters");
}

/* What the whole map must have in each unit. */
TEST(test_units_roles_refused) {
  static const char bus[] = "[bus]\ntransport = tcp\nport = a:1\n";
  static const char torque[] = "[register torque%d]\ndirection = write\naddress = 0\ntype = i16\nunit = Nm\nmin = -1\n"
                               "max = 1\nbus_unit = %d\n[register position%d]\ndirection = read\naddress = %d\n"
                               "type = u16\nunit = rad\nbus_unit = %d\n";
  char first[512], second[512], vain[512];
  snprintf(first, sizeof first, torque, 1, 1, 1, 1, 1);
  snprintf(second, sizeof second, torque, 2, 2, 2, 1, 2);
  snprintf(vain, sizeof vain, torque, 2, 2, 2, 2, 1);
  snprintf(text, MAP_TEXT_MAX, "%s%s%s", bus, first, second);
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert(ethd__servo_several(&map));
  snprintf(text, MAP_TEXT_MAX, "%s%s%s", bus, first, vain);
  ck_assert_int_lt(try(text), 0);
  ck_assert_str_eq(message,
                   "m.map: nothing is read in each exchange from a unit that has a torque: it could vanish unseen");
  const char *counter = "[register counter%s]\ndirection = write\naddress = 7\ntype = u16\nmax = 9\nbus_unit = %d\n";
  char own[128], other[128];
  snprintf(own, sizeof own, counter, "", 1);
  snprintf(other, sizeof other, counter, "2", 2);
  snprintf(text, MAP_TEXT_MAX, "%s[watchdog]\nkind = counter\ntime = 1\n%s%s%s", bus, first, second, own);
  ck_assert_int_lt(try(text), 0);
  ck_assert_str_eq(message, "m.map: watchdog.kind = counter needs a counter in each unit that has a torque");
  strcat(text, other);
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  snprintf(text, MAP_TEXT_MAX, "%s%s%s%s", bus, first, second, other);
  ck_assert_int_lt(try(text), 0);
  ck_assert_str_eq(message, "m.map: counter2 is the counter of a second unit, beside counter in the first");
  snprintf(text, MAP_TEXT_MAX,
           "[bus]\ntransport = rtu\nbaud = 9600\nport = a\n%s[register c]\ndirection = write\n"
           "address = 9\ntype = u16\nbus_unit = 0\n[enable]\nstep1 = write c 1\n",
           first);
  ck_assert_int_lt(try(text), 0);
  ck_assert_ptr_nonnull(strstr(message, "register c.bus_unit: found \"0\", 1 to 247: on a serial line 0 is for all"));
}

TEST(test_steps_refused) {
  read_map("apps/config/plant.map");
  char why[64];
  const char *step = "step1 = write control 2";
  snprintf(why, sizeof why, ":%d: enable.step1: the map has no [register controls]", line_of(text, strstr(text, step)));
  refused(step, "step1 = write controls 2", why);
  refused(step, "step1 = write control", "write NAME RAW");
  refused(step, "step1 = write control 65536", "write NAME RAW");
  refused(step, "step1 = write control 1.5", "write NAME RAW");
  refused(step, "step1 = write status 2", "direction = write is allowed");
  refused(step, "step1 = wait control 1 1 1", "direction = read is allowed");
  refused(step, "step1 = jump control 2", "write NAME RAW, wait NAME MASK BITS SECONDS or pause SECONDS");
  refused(step, "step1 = pause 0", "pause SECONDS");
  refused(step, "step1 = pause 61", "pause SECONDS");
  refused(step, "step5 = pause 1", "step1 comes here");
  refused(step, "step25 = pause 1", "step1 to step24");
  refused(step, "step01 = pause 1", "step1 to step24");
  refused(step, "stepp = pause 1", "step1 to step24");
  const char *wait = "step2 = wait status 0x0001 0x0000 0.5";
  refused(wait, "step2 = wait status 0x0001 0x0002 0.5", "bits within the mask");
  refused(wait, "step2 = wait status 0x10000 0 0.5", "wait NAME MASK BITS SECONDS");
  refused(wait, "step2 = wait status 1 0 0", "wait NAME MASK BITS SECONDS");
  refused(wait, "step2 = wait status 1 0", "wait NAME MASK BITS SECONDS");
  refused(wait, "step2 = wait status 1 0 1 1", "wait NAME MASK BITS SECONDS");
  refused(wait, "", "step2 comes here");
}
