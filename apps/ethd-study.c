/* A tapping study: people, strategies, speeds; every tap judged at once, nothing lost. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "screen/place.h"
#include "study/shard.h"

static const char doc[] =
    "Runs a tapping study: participants tap a virtual wall under each strategy at each speed until enough taps "
    "are valid; every tap is judged at once, recorded tick by tick, and kept whatever happens. Or simulates "
    "thousands of participants over a grid of gains.\v"
    "STUDY is an INI file; paper.study, which is installed, is the paper's. The folder of --out holds all data and "
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

enum {
  OPTION_RESUME = 256,
  OPTION_ASK,
  OPTION_FINGER,
  OPTION_PARTICIPANT,
  OPTION_SIMULATE,
  OPTION_SHARD,
  OPTION_TICKS,
  OPTION_MERGE,
  OPTION_SCREEN,
  OPTION_VIRTUAL
};

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of a new session, or of a simulation", 0},
    {"resume", OPTION_RESUME, "DIR", 0, "go on with the session in DIR", 0},
    {"participant", OPTION_PARTICIPANT, "K", 0, "only participant K, from 1; the others another time", 0},
    {"finger", OPTION_FINGER, "FILE.csv", 0, "every hand's path is this recorded movement", 0},
    {"ask", OPTION_ASK, NULL, 0, "take commands on stdin", 0},
    {"screen", OPTION_SCREEN, "WxH", OPTION_ARG_OPTIONAL,
     "in a window, 1280x720 by default; the mouse is the finger, unless people's are", 0},
    {"virtual", OPTION_VIRTUAL, NULL, 0, "with people: the device in lock-step, as fast as it goes", 0},
    {"quiet", 'q', NULL, 0, "print no line for each tap", 0},
    {"simulate", OPTION_SIMULATE, "N", 0, "simulate N participants at every point of the study's [grid]", 1},
    {"shard", OPTION_SHARD, "I/N", 0, "simulate only this share (1/1)", 1},
    {"ticks", OPTION_TICKS, NULL, 0, "record every tick of a simulation, 300 kB a tap", 1},
    {"merge", OPTION_MERGE, "DIR", 0, "merge all shards in DIR into DIR/taps.csv", 1},
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
  if (!!arg.out + !!arg.resume + !!arg.merge != 1)
    argp_error(state, "--out DIR, --resume DIR or --merge DIR is needed");
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
  case ARGP_KEY_END: check_options(state); return 0;
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
    ethd__fail(ETHD_EXIT_INPUT, "%s: hand.source: people have hands of their own; no --simulate, no --finger",
               protocol->path);
  if (!people && arg.is_virtual)
    ethd__fail(ETHD_EXIT_INPUT, "--virtual: %s: hand.source: people is needed; any other has no real time",
               protocol->path);
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
  if (!study) ethd__fail_memory();
  ethd_status status = ethd__protocol_load(study, &protocol, message);
  free(study);
  check(status, message);
  ethd__folder_device(&protocol, &loaded);
  check_study(&protocol, &loaded);
  status = ethd__folder_make(arg.out, &protocol, &loaded, arg.finger, message);
  if (status) ethd__fail(status == ETHD_E_FILE ? ETHD_EXIT_FAILED : ethd__exit_code(status), "%s", message);
  ethd__loaded_free(&loaded);
  ethd__protocol_free(&protocol);
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

static int run_session(void) {
  static ethd__screen_place place;
  char message[ETHD_MESSAGE_MAX] = "";
  const ethd__place_options wanted = {.path = arg.resume ? arg.resume : arg.out,
                                      .participant = arg.participant,
                                      .ask = arg.ask,
                                      .quiet = arg.quiet,
                                      .is_virtual = arg.is_virtual,
                                      .width = arg.width,
                                      .height = arg.height};
  bool over = false;
  if (!arg.resume) make_folder();
  ethd__place_open(&wanted, &place);
  ethd_status status = ethd__place_run(&place, &over, message);
  int code = end(&place.sitting, wanted.path, status, over, message);
  ethd__place_close(&place);
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
  check(ethd__folder_open(arg.out, true, &folder, message), message);
  folder.protocol.participants = (uint32_t)arg.simulate;
  check(ethd__desk_open(&folder.protocol, &folder.loaded, folder.finger, &desk, message), message);
  ethd__catch_interrupt();
  ethd_status status = ethd__shard_run(&folder, &desk, &arg.shard, &taps, &over, message);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s; the same command goes on", message);
  if (over) printf("%s: shard %u/%u: %llu taps\n", arg.out, arg.shard.index, arg.shard.count, (unsigned long long)taps);
  ethd__desk_close(&desk);
  ethd__folder_close(&folder);
  return over ? ETHD_EXIT_DONE : stopped(arg.out, "the same command, --out");
}

static int merge(void) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__folder folder;
  uint64_t taps;
  check(ethd__folder_read(arg.merge, &folder, message), message);
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
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  return ethd__end(arg.merge ? merge() : arg.simulate ? run_shard() : run_session());
}
