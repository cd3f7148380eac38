/* Runs a device in real time, under commands from stdin. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "run/commands.h"
#include "run/session.h"
#include "run/summary.h"

#define POLL 20 /* ms between looks at signals and the duration */

static const char doc[] =
    "Runs a device, in the plane or in space, under the controller, one tick in each period, until the duration ends "
    "or the command stop, Ctrl-C, "
    "SIGTERM or SIGHUP comes. Then it stops the ring and disables the device. Ctrl-Z is ignored, since a stopped "
    "program can't control the ring.\v"
    "Commands are read from stdin, one on a line. The answer to each is a line that begins with ok or error:\n"
    "  transition LAW          change the transition law; the torque doesn't jump\n"
    "  contact LAW             change the contact law\n"
    "  tracking LAW            change the tracking law\n"
    "  set SECTION.KEY VALUE   set a number of the configuration\n"
    "  status                  print the state of ring and controller\n"
    "  ack                     acknowledge a fault\n"
    "  enable                  start a disabled device again, from zero torque\n"
    "  home [Q1 Q2]            set the joint angles, rad, or find them by moving\n"
    "  wait S                  wait for S seconds before the next command\n"
    "  stop                    end the run\n"
    "The end of the input doesn't end the run. A program in the background of a terminal reads no commands. With "
    "--virtual, time is counted: it passes in wait and, after the input's end, up to the duration. The device is "
    "stepped as fast as the machine can, and equal input gives equal bytes.\n\n"
    "Examples:\n"
    "  ethd-run --config device.ini --record session\n"
    "  ethd-run --config ur5e.ini --virtual --duration 5 --record reach </dev/null\n"
    "  echo transition smooth | ethd-run --virtual --duration 2";

enum {
  OPTION_RECORD = 256,
  OPTION_SNAPSHOT,
  OPTION_FAULTS,
  OPTION_TELEMETRY,
  OPTION_VIRTUAL,
  OPTION_CPU,
  OPTION_PRIORITY,
  OPTION_REQUIRE,
  OPTION_EARLY,
  OPTION_DMA,
  OPTION_SOFT,
  OPTION_FORCE,
  OPTION_GROUP,
  OPTION_HOME,
  OPTION_KEEPS
};

static const struct argp_option options[] = {
    {"config", 'c', "C.ini", 0, "configuration (default: the simulated device)", 0},
    {"duration", 'd', "S", 0, "end after S seconds; needed with --virtual", 0},
    {"record", OPTION_RECORD, "DIR", 0, "record every tick, for ethd-replay --verify", 0},
    {"record-every", OPTION_KEEPS, "N", 0,
     "record only each Nth tick, for long runs; such a recording can't be replayed. A tick has 776 bytes "
     "(2040 in space): 2.8 GB in an hour at 1 kHz",
     0},
    {"force", OPTION_FORCE, NULL, 0, "replace an existing recording", 0},
    {"snapshot", OPTION_SNAPSHOT, "FILE.npy", 0,
     "write the ticks around the first fault, 2 s before and 1 s after; default with --record: DIR/snapshot.npy", 0},
    {"faults", OPTION_FAULTS, NULL, 0, "print the table of faults and reactions, and end", 0},
    {"telemetry", OPTION_TELEMETRY, "HOST:PORT", 0, "send JSON by UDP at 100 Hz, for PlotJuggler's UDP server", 0},
    {"telemetry-group", OPTION_GROUP, NULL, 0,
     "allow a multicast or broadcast address in --telemetry; every host of the group can read the data", 0},
    {"virtual", OPTION_VIRTUAL, NULL, 0, "count time instead of waiting, for a simulated device; no threads", 0},
    {"home", OPTION_HOME, NULL, 0, "find the joint angles first, as [device] says: the arm moves slowly", 0},
    {"cpu", OPTION_CPU, "N|auto|none", 0, "processor of the loop; auto: the highest isolated one (none)", 1},
    {"priority", OPTION_PRIORITY, "N", 0, "SCHED_FIFO priority of the loop (80)", 1},
    {"require-rt", OPTION_REQUIRE, NULL, 0, "refuse to run on a machine without realtime rights or kernel", 1},
    {"early-wake", OPTION_EARLY, "US", 0,
     "wake this many microseconds early, warm the caches and spin until the tick (0)", 1},
    {"dma-latency", OPTION_DMA, "US", 0, "hold /dev/cpu_dma_latency at this value, microseconds", 1},
    {"soft-start", OPTION_SOFT, "S", 0, "time over which the torque rises after enabling, s (0.1)", 1},
    {0},
};

static struct {
  ethd__session_options session;
  double duration; /* s, 0: none */
} arg;

static int32_t parse_cpu(const char *text) {
  if (!strcmp(text, "none")) return ETHD_CPU_NONE;
  if (!strcmp(text, "auto")) return ETHD_CPU_AUTO;
  return (int32_t)ethd__option_integer("--cpu", text, 0, 1023);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  ethd_loop_def *loop = &arg.session.loop;
  switch (key) {
  case 'c': arg.session.config = text; return 0;
  case 'd': arg.duration = ethd__option_number("--duration", text, 1e-3, 1e7); return 0;
  case OPTION_RECORD: arg.session.record = text; return 0;
  case OPTION_KEEPS: arg.session.keeps = (uint32_t)ethd__option_integer("--record-every", text, 1, 1000000); return 0;
  case OPTION_SNAPSHOT: arg.session.snapshot = text; return 0;
  case OPTION_FAULTS: ethd__faults_print(stdout); exit(ethd__end(ETHD_EXIT_DONE));
  case OPTION_TELEMETRY: arg.session.telemetry = text; return 0;
  case OPTION_FORCE: arg.session.replace = true; return 0;
  case OPTION_GROUP: arg.session.group = true; return 0;
  case OPTION_VIRTUAL: arg.session.is_virtual = true; return 0;
  case OPTION_CPU: loop->cpu = parse_cpu(text); return 0;
  case OPTION_PRIORITY: loop->priority = (int32_t)ethd__option_integer("--priority", text, 1, 99); return 0;
  case OPTION_REQUIRE: loop->require_rt = 1; return 0;
  case OPTION_EARLY: loop->early_wake = 1e-6 * ethd__option_number("--early-wake", text, 0, 1e5); return 0;
  case OPTION_DMA: loop->dma_latency = (int32_t)ethd__option_integer("--dma-latency", text, 0, 1000000); return 0;
  case OPTION_HOME: arg.session.home = true; return 0;
  case OPTION_SOFT: loop->soft_start = ethd__option_number("--soft-start", text, 0, 10); return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END:
    if (arg.session.is_virtual && !(arg.duration > 0)) argp_error(state, "--virtual needs --duration");
    if (arg.session.keeps && !arg.session.record) argp_error(state, "--record-every needs --record");
    if (arg.session.is_virtual && loop->require_rt) argp_error(state, "--virtual contradicts --require-rt");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static bool over(const ethd__session *s) {
  return ethd__stop || !ethd__session_lives(s) ||
         (arg.duration > 0 && ethd__session_time(s) >= arg.duration * (1 - 1e-12));
}

/* Commands as they come; those behind a wait when it is over. */
static void run_live(ethd__session *s) {
  ethd__commands c = {.ended = false};
  while (!c.stop && !over(s)) {
    bool held = ethd__session_time(s) < c.hold;
    if (held || c.ended)
      usleep(held ? 1000 : POLL * 1000);
    else
      ethd__commands_read(&c, s, POLL);
    ethd__session_poll(s);
  }
}

/* Commands take no time; a terminal has none for a virtual clock. */
static void run_virtual(ethd__session *s) {
  ethd__commands c = {.ended = isatty(STDIN_FILENO)};
  while (!c.stop && !over(s)) {
    if (c.ended || ethd__session_time(s) < c.hold)
      ethd__session_tick(s);
    else
      ethd__commands_read(&c, s, -1);
  }
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  static ethd__session session;
  char message[ETHD_MESSAGE_MAX];
  arg.session.loop = ethd_loop_default();
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__container_keeper();
  (arg.session.is_virtual ? ethd__catch_end : ethd__hold_device)();
  ethd_status status = ethd__session_open(&arg.session, &session, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
  ethd__remarks_print(stderr, &session);
  if (arg.session.is_virtual)
    run_virtual(&session);
  else
    run_live(&session);
  ethd__session_halt(&session, ethd__stop);
  status = ethd__session_end(&session, message);
  ethd__summary_print(stdout, &session, arg.session.record);
  if (status) fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
  ethd__session_free(&session);
  return ethd__end(status ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
