/* A tapping study: people, strategies, speeds; every tap judged at once, nothing lost. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/cli.h"
#include "file/recording_parts.h"
#include "run/summary.h"
#include "screen/screen.h"
#include "study/desk.h"
#include "study/session.h"
#include "study/shard.h"
#include "study/station.h"

static const char doc[] =
    "Runs a tapping study: participants tap a virtual wall under each strategy at each speed until enough taps "
    "are valid; every tap is judged at once, recorded tick by tick, and kept whatever happens. Or simulates "
    "thousands of participants over a grid of gains.\v"
    "STUDY is an INI file; paper.study, which comes along, is the paper's. The folder of --out holds all data and "
    "a README.md that says what each file and column is; ethd-report draws it. A session that was stopped, killed "
    "or ran out of disk goes on with --resume: no tap is lost, repeated or torn. Simulated participants are "
    "plausible, not measured; they answer no survey. With \"[hand] source = people\" the configuration's device is "
    "opened and run as ethd-run does, and a person's finger is in its ring.\n\n"
    "With --ask, lines on stdin: note WORDS, pause, go, abort (this participant), stop; ack, for a device that has "
    "stopped itself; and the survey's answers.\n\n"
    "Examples:\n"
    "  ethd-study --out session\n"
    "  ethd-study my.study --out session --ask\n"
    "  ethd-study --out mine --screen    (tap with the mouse)\n"
    "  ethd-study device.study --out lab --screen    (source = people, config = device.ini: in its ring)\n"
    "  ethd-study --resume session\n"
    "  ethd-study grid.study --simulate 1000 --shard 1/4 --out bulk    (and 2/4, 3/4, 4/4, anywhere)\n"
    "  ethd-study --merge bulk";

enum { OPTION_RESUME = 256, OPTION_ASK, OPTION_FINGER, OPTION_PARTICIPANT, OPTION_SIMULATE, OPTION_SHARD, OPTION_TICKS, OPTION_MERGE, OPTION_SCREEN, OPTION_VIRTUAL };

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of a new session, or of a simulation", 0},
    {"resume", OPTION_RESUME, "DIR", 0, "go on with the session in DIR", 0},
    {"participant", OPTION_PARTICIPANT, "K", 0, "only this one, from 1; the others another time", 0},
    {"finger", OPTION_FINGER, "FILE.csv", 0, "every hand's path is this recorded movement", 0},
    {"ask", OPTION_ASK, NULL, 0, "take commands on stdin", 0},
    {"screen", OPTION_SCREEN, "WxH", OPTION_ARG_OPTIONAL, "in a window, 1280x720 by default; the mouse is the finger, unless people's are", 0},
    {"virtual", OPTION_VIRTUAL, NULL, 0, "with people: the device in lock-step, as fast as it goes", 0},
    {"quiet", 'q', NULL, 0, "no line per tap", 0},
    {"simulate", OPTION_SIMULATE, "N", 0, "N participants at every point of the study's [grid]", 1},
    {"shard", OPTION_SHARD, "I/N", 0, "only this share of the simulation: 1/1", 1},
    {"ticks", OPTION_TICKS, NULL, 0, "of a simulation: every tick of every tap, 300 kB each", 1},
    {"merge", OPTION_MERGE, "DIR", 0, "all shards in DIR into DIR/taps.csv", 1},
    {0},
};

static struct {
  const char *study, *out, *resume, *finger, *merge;
  int64_t participant, simulate;
  ethd__shard shard;
  int width, height; /* px of the screen; 0: none */
  bool ask, quiet, sharded, is_virtual;
} arg = {.shard = {.index = 1, .count = 1}};

static void parse_shard(const char *text) {
  char left[24];
  const char *slash = strchr(text, '/');
  size_t n = slash ? (size_t)(slash - text) : sizeof left;
  if (n >= sizeof left) ethd__fail(ETHD_EXIT_INPUT, "--shard: found \"%.40s\", I/N is allowed, as in 2/4", text);
  memcpy(left, text, n);
  left[n] = 0;
  arg.shard.count = (uint32_t)ethd__option_integer("--shard", slash + 1, 1, ETHD_STUDY_SHARDS_MAX);
  arg.shard.index = (uint32_t)ethd__option_integer("--shard", left, 1, arg.shard.count);
  arg.sharded = true;
}

static void parse_screen(const char *text) {
  char rest;
  arg.width = 1280, arg.height = 720;
  if (text && (sscanf(text, "%5dx%5d%c", &arg.width, &arg.height, &rest) != 2 || arg.width < 320 || arg.height < 200 ||
               arg.width > 16384 || arg.height > 16384))
    ethd__fail(ETHD_EXIT_INPUT, "--screen: found \"%.40s\", WxH from 320x200 to 16384x16384 is allowed", text);
}

/* What goes with what. */
static void check_options(struct argp_state *state) {
  if (!!arg.out + !!arg.resume + !!arg.merge != 1) argp_error(state, "--out DIR, --resume DIR or --merge DIR is needed");
  if (!arg.out && (arg.study || arg.finger)) argp_error(state, "the study is taken from the folder");
  if ((arg.sharded || arg.shard.record) && !arg.simulate) argp_error(state, "--shard and --ticks need --simulate N");
  if (arg.width && (arg.ask || arg.simulate || arg.finger || arg.merge))
    argp_error(state, "--screen has a finger of its own, and keys: no --ask, --finger, --simulate, --merge");
  if (arg.simulate && (!arg.out || arg.ask || arg.participant))
    argp_error(state, "--simulate needs --out DIR, and has nobody to ask or choose");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
    case 'o': arg.out = text; return 0;
    case 'q': arg.quiet = true; return 0;
    case OPTION_RESUME: arg.resume = text; return 0;
    case OPTION_PARTICIPANT:
      arg.participant = ethd__option_integer("--participant", text, 1, ETHD_STUDY_SESSION_PEOPLE);
      return 0;
    case OPTION_FINGER: arg.finger = text; return 0;
    case OPTION_ASK: arg.ask = true; return 0;
    case OPTION_SIMULATE: arg.simulate = ethd__option_integer("--simulate", text, 1, ETHD_STUDY_PEOPLE); return 0;
    case OPTION_SHARD: parse_shard(text); return 0;
    case OPTION_TICKS: arg.shard.record = true; return 0;
    case OPTION_SCREEN: parse_screen(text); return 0;
    case OPTION_VIRTUAL: arg.is_virtual = true; return 0;
    case OPTION_MERGE: arg.merge = text; return 0;
    case ARGP_KEY_ARG:
      if (arg.study) argp_error(state, "\"%s\": one study file is allowed", text);
      arg.study = text;
      return 0;
    case ARGP_KEY_END:
      check_options(state);
      return 0;
    default: return ARGP_ERR_UNKNOWN;
  }
}

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

/* ---- a session ---- */

/* Nothing is written before all of the input is known to be good. */
static void check_study(const ethd__protocol *protocol, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  ethd__desk desk;
  check(ethd__desk_open(protocol, loaded, arg.finger, &desk, message), message);
  ethd__desk_close(&desk);
  bool people = protocol->hands == ETHD_HANDS_PEOPLE;
  if (people && (arg.simulate || arg.finger))
    ethd__fail(ETHD_EXIT_INPUT, "%s: hand.source: people have hands of their own; no --simulate, no --finger", protocol->path);
  if (!people && arg.is_virtual)
    ethd__fail(ETHD_EXIT_INPUT, "--virtual: %s: hand.source: people is needed; any other has no real time", protocol->path);
  if (protocol->axis_count && !arg.simulate)
    ethd__fail(ETHD_EXIT_INPUT, "%s: [grid]: a session has no grid; --simulate has", protocol->path);
  if (arg.participant > protocol->participants)
    ethd__fail(ETHD_EXIT_INPUT, "--participant: found %lld, 1 to %u are allowed", (long long)arg.participant,
               protocol->participants);
}

static void make_folder(void) {
  char message[ETHD_MESSAGE_MAX], *journal = ethd__folder_path(arg.out, ETHD_STUDY_JOURNAL);
  ethd__protocol protocol;
  ethd__loaded loaded;
  if (access(journal, F_OK) == 0)
    ethd__fail(ETHD_EXIT_INPUT, "%s: holds a session; --resume %s goes on with it", arg.out, arg.out);
  free(journal);
  char *study = arg.study ? strdup(arg.study) : ethd__data_path("paper.study");
  if (!study) ethd__fail(ETHD_EXIT_FAILED, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  ethd_status status = ethd__protocol_load(study, &protocol, message);
  free(study);
  check(status, message);
  ethd__folder_device(&protocol, &loaded);
  check_study(&protocol, &loaded);
  status = ethd__folder_make(arg.out, &protocol, &loaded, arg.finger, message);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  ethd__loaded_free(&loaded);
  ethd__protocol_free(&protocol);
}

static void choose(ethd__sitting *sitting, const ethd__protocol *protocol) {
  if (arg.participant > protocol->participants)
    ethd__fail(ETHD_EXIT_INPUT, "--participant: found %lld, 1 to %u are allowed", (long long)arg.participant,
               protocol->participants);
  if (!arg.participant) return;
  sitting->first = (uint32_t)arg.participant - 1;
  sitting->last = (uint32_t)arg.participant;
}

static int stopped(const char *folder, const char *how) {
  fprintf(stderr, "%s: stopped; what was done is kept: %s %s goes on\n", program_invocation_short_name, how, folder);
  return ETHD_EXIT_FAILED;
}

static int end(const ethd__sitting *sitting, const char *folder, ethd_status status, bool over, const char *message) {
  if (status < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s; what was done is kept: ethd-study --resume %s goes on", message, folder);
  if (over) {
    printf("%s: %llu taps; ethd-report %s draws them\n", folder, (unsigned long long)sitting->taps, folder);
    return ETHD_EXIT_DONE;
  }
  return stopped(folder, "ethd-study --resume");
}

/* All that a session needs at once. */
typedef struct ethd__place {
  ethd__folder folder;
  ethd__desk desk;
  ethd__station station;
  ethd__screen screen;
  ethd__console console;
  ethd__sitting sitting;
  ethd__source device; /* people's; its self is NULL without */
} ethd__place;

/* Where people tap, their device: it says of itself what isn't realtime and what risk stays. */
static void take_device(ethd__place *at, const char *path) {
  char message[ETHD_MESSAGE_MAX], *config = ethd__folder_path(path, ETHD_RECORDING_CONFIG);
  ethd_status status =
      ethd__station_open(&at->desk, config, at->folder.device, arg.is_virtual, &at->station, message);
  free(config);
  check(status, message);
  ethd__remarks_print(stderr, &at->station.session);
  at->device = ethd__station_source(&at->station);
  at->sitting.source = at->device;
}

/* The window, where one is asked for; else lines. */
static void take_front(ethd__place *at) {
  char message[ETHD_MESSAGE_MAX];
  bool people = at->device.self != NULL;
  at->sitting.front = ethd__console_front(&at->console);
  if (!arg.width) return;
  if (ethd__screen_open(&at->screen, &at->desk, people ? &at->device : NULL, arg.width, arg.height, message))
    ethd__fail(ETHD_EXIT_FAILED, "--screen: %s", message);
  if (!people) at->sitting.source = ethd__screen_source(&at->screen);
  if (people) at->station.watcher = ethd__screen_watcher(&at->screen);
  at->sitting.front = ethd__screen_front(&at->screen);
}

static void open_place(ethd__place *at, const char *path) {
  char message[ETHD_MESSAGE_MAX] = "";
  check(ethd__folder_open(path, &at->folder, message), message);
  if (arg.is_virtual && at->folder.protocol.hands != ETHD_HANDS_PEOPLE)
    ethd__fail(ETHD_EXIT_INPUT, "--virtual: %s: hand.source: people is needed", at->folder.protocol.path);
  at->console = (ethd__console){.protocol = &at->folder.protocol, .ask = arg.ask, .quiet = arg.quiet};
  check(ethd__desk_open(&at->folder.protocol, &at->folder.loaded, at->folder.finger, &at->desk, message), message);
  check(ethd__sitting_open(&at->folder, &at->sitting, message), message);
  choose(&at->sitting, &at->folder.protocol);
  at->sitting.source = ethd__desk_source(&at->desk);
  ethd__catch_interrupt();
  if (at->folder.protocol.hands == ETHD_HANDS_PEOPLE) take_device(at, path);
  take_front(at);
}

/* First of all: nothing moves any more, whatever is still to be said. */
static void close_device(ethd__place *at) {
  char message[ETHD_MESSAGE_MAX];
  if (at->device.self && ethd__station_close(&at->station, message) < 0)
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
}

static void close_place(ethd__place *at) {
  ethd__sitting_close(&at->sitting);
  ethd__desk_close(&at->desk);
  ethd__folder_close(&at->folder);
}

static int run_session(void) {
  static ethd__place place;
  char message[ETHD_MESSAGE_MAX] = "";
  const char *path = arg.resume ? arg.resume : arg.out;
  bool over = false;
  if (!arg.resume) make_folder();
  open_place(&place, path);
  ethd_status status = ethd__sitting_run(&place.sitting, &over, message);
  close_device(&place);
  if (arg.width) {
    ethd__screen_end(&place.screen, over);
    ethd__screen_close(&place.screen);
  }
  int code = end(&place.sitting, path, status, over, message);
  close_place(&place);
  return code;
}

/* ---- a simulation ---- */

static int run_shard(void) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__folder folder;
  ethd__desk desk;
  uint64_t taps;
  bool over;
  make_folder();
  check(ethd__folder_open(arg.out, &folder, message), message);
  folder.protocol.participants = (uint32_t)arg.simulate;
  check(ethd__desk_open(&folder.protocol, &folder.loaded, folder.finger, &desk, message), message);
  ethd__catch_interrupt();
  ethd_status status = ethd__shard_run(&folder, &desk, &arg.shard, &taps, &over, message);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s; the same command goes on", message);
  if (over)
    printf("%s: shard %u/%u: %llu taps\n", arg.out, arg.shard.index, arg.shard.count, (unsigned long long)taps);
  ethd__desk_close(&desk);
  ethd__folder_close(&folder);
  return over ? ETHD_EXIT_DONE : stopped(arg.out, "the same command, --out");
}

static int merge(void) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__folder folder;
  uint64_t taps;
  check(ethd__folder_open(arg.merge, &folder, message), message);
  ethd_status status = ethd__shards_merge(&folder, &taps, message);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  printf("%s/%s: %llu taps of %u participants at %zu points\n", arg.merge, ETHD_STUDY_TAPS, (unsigned long long)taps,
         folder.protocol.participants, ethd__protocol_points(&folder.protocol));
  ethd__folder_close(&folder);
  return ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "[STUDY]", doc, NULL, NULL, NULL};
  ethd__begin();
  signal(SIGXFSZ, SIG_IGN); /* a full quota is an answer of write, not the end */
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  return ethd__end(arg.merge ? merge() : arg.simulate ? run_shard() : run_session());
}
