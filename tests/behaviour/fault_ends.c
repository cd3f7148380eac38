/* Rows that arise at load, at start, in the recorder. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "behaviour/fault_rows.h"
#include "ethd/config.h"
#include "unit/draw.h"

/* The text is refused, at this line. */
static void expect_refusal(const char *text, int line, char *says, size_t room) {
  ethd_config *config = NULL;
  char message[ETHD_MESSAGE_MAX] = "", place[32];
  ethd_status status = ethd_config_parse(text, strlen(text), "bad.ini", "apps/config", &config, message);
  snprintf(place, sizeof place, "bad.ini:%d:", line);
  if (status >= 0)
    snprintf(says, room, "taken: %.100s", text);
  else if (!strstr(message, place))
    snprintf(says, room, "said: %.140s", message);
  if (config) ethd_config_free(config);
}

static void bad_plugin(int i, char *says, size_t room) {
  static const char *const names[] = {"wrong_abi", "bad_table", "short_entry", "no_symbol", "no_law", "no_step"};
  const char *build = getenv("BUILD");
  char text[1024], lines[32] = "";
  for (int k = 0; k < i; k++) strcat(lines, "\n");
  snprintf(text, sizeof text, "%s[plugins]\nfile = %s/tests/plugins/%s.so\n", lines, build ? build : "build",
           names[(size_t)i % (sizeof names / sizeof *names)]);
  expect_refusal(text, i + 2, says, room);
}

static void bad_configuration(int i, char *says, size_t room) {
  static const char *const bad[] = {"k_e = 2500x", "k_e = nan", "k_e = -1", "k_e = 0x10", "colour = red",
                                    "k_e",         "k_e =",     "law = no", "b_e = 1e999"};
  char text[256];
  int before = (int)(draw_bits((uint64_t)i) % 9);
  snprintf(text, sizeof text, "%.*s[contact]\n%s\n", before, "\n\n\n\n\n\n\n\n\n",
           bad[(size_t)i % (sizeof bad / sizeof *bad)]);
  expect_refusal(text, before + 2, says, room);
}

/* 16 rows find room; then one in each tick is lost, and the next that is kept says how many were. */
static void full_recorder(int i, char *says, size_t room) {
  static fault_rig r;
  ethd_loop_stats stats;
  int begin = 20 + (int)(draw_bits((uint64_t)i) % 600);
  fault_rig_open(&r, FAULT_PLAIN, (uint64_t)i, NULL);
  while (r.tick < begin) fault_rig_tick(&r);
  r.lazy = 1;
  for (int k = 0; k < 17; k++) fault_rig_tick(&r);
  ethd_loop_read(r.loop, &stats);
  if (stats.rows_lost != 1) snprintf(says, room, "trial %d: %llu lost", i, (unsigned long long)stats.rows_lost);
  for (int k = 0; k < i; k++) fault_rig_tick(&r);
  r.lazy = 0;
  for (int k = 0; k < 2; k++) fault_rig_tick(&r); /* takes what waits; then the one that tells */
  if (r.lost != (uint64_t)i + 2 || r.row.trace.fault || !ethd_loop_armed(r.loop))
    snprintf(says, room, "trial %d: %llu told, fault %d", i, (unsigned long long)r.lost, (int)r.row.trace.fault);
  fault_rig_close(&r);
}

/* A drive that keeps a set-point from before isn't enabled. */
static void old_point(int i, char *says, size_t room) {
  static fault_rig r;
  int begin = 20 + (int)(draw_bits((uint64_t)i) % 300);
  fault_rig_open(&r, FAULT_BUS, (uint64_t)i, NULL);
  while (r.tick < begin) fault_rig_tick(&r);
  ethd_loop_disarm(r.loop);
  for (int k = 0; k < 5; k++) fault_rig_tick(&r);
  if (ethd_device_stop(r.device)) snprintf(says, room, "trial %d: stop", i);
  fault_rig_mark(&r);
  r.old_point = (uint16_t)(1 + draw_bits((uint64_t)i + 100) % 1000);
  if (ethd_loop_enable(r.loop) >= 0) snprintf(says, room, "trial %d: enabled with the set-point %d", i, r.old_point);
  for (int k = 0; k < 20; k++) {
    fault_rig_tick(&r);
    if (ethd_loop_armed(r.loop) || r.server.words[MOCK_STATUS] & 2 || r.torque[0] != 0)
      snprintf(says, room, "trial %d: enabled all the same", i);
  }
  if (r.seen[ETHD_FAULT_SET_POINT] < 0) snprintf(says, room, "trial %d: the row isn't told", i);
  fault_rig_close(&r);
}

const fault_end fault_ends[] = {
    {30, ETHD_REACTION_REFUSE, bad_plugin, "six plugins that are none"},
    {31, ETHD_REACTION_REFUSE, bad_configuration, "nine wrong lines, each told with its number"},
    {32, ETHD_REACTION_COUNTED, full_recorder, "nobody takes the loop's rows; lost ones are told behind"},
    {36, ETHD_REACTION_REFUSE, old_point, "the drive keeps a set-point while it is enabled anew"},
};
const size_t fault_end_count = sizeof fault_ends / sizeof *fault_ends;
