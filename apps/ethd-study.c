/* A tapping study: people, strategies, speeds; every tap judged at once, nothing lost. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "screen/commands.h"
#include "study/session.h"

static const char doc[] =
    "Runs a tapping study: participants tap a virtual wall under each strategy at each speed until enough taps "
    "are valid; every tap is judged at once, recorded tick by tick, and kept whatever happens. Or it simulates "
    "thousands of participants over a grid of gains.\v"
    "STUDY is an INI file; paper.study, which is installed, is the paper's. The folder of --out holds all data and "
    "a README.md that says what each file and column is; ethd-report draws it. A session that was stopped, killed "
    "or ran out of disk goes on with --resume: no tap is lost, repeated or torn. All that happens is put into the "
    "folder's "
    "study.sqlite (SQLite; keep it on a local disk, since network file systems don't lock it reliably). The "
    "tables are "
    "written at the end of each sitting and by --export. Simulated participants are "
    "plausible, not measured; they answer no survey. With \"[hand] source = people\" the configuration's device is "
    "opened and run as ethd-run does, and a person's finger is in its ring; with \"source = mouse\", or --screen "
    "alone, a pointer leads the simulated device's hand. All taps of a session have the same source, which is written "
    "at each tap (device, mouse, simulated, recorded); another source is refused.\n\n"
    "With \"[validity] by = paper\" a tap counts if the ring met the wall at the commanded speed. With \"by = finger\" "
    "it counts if the hand had that speed and the finger didn't come before the ring, which suits laws that stop the "
    "ring before the wall; the columns v_hand_mps, touch_depth_m and eps_felt_m show both for any tap.\n\n"
    "With --ask these lines are read on stdin: note WORDS, accept WORDS and reject WORDS (the latest tap), pause, go, "
    "abort (this "
    "participant), undo (the last abort, accept or reject), stop; ack, for a device that has stopped itself; and the "
    "survey's answers, which are kept one by one, and back, "
    "which returns to the question before.\n\n"
    "The study file holds questions of your own (\"[survey]\" after each block, \"[before]\" and \"[after]\" once per "
    "participant; numbered answers or q1_answers = text), consent and "
    "instruction (\"[pages]\"), and whatever else the screen says in your language (\"[words]\": --words prints the "
    "phrases by their names).\n\n"
    "With --markers a session sends a line of text by UDP as each block and trial begins and ends, at each trial's "
    "contact, and as a tap is accepted or rejected. The address is no part of the study: it can differ from station to "
    "station, and from run to run.\n\n"
    "A participant who withdraws or is excluded stays on record with the reason, in participants.csv, and leaves the "
    "analysis, as one who aborted does. A valid tap that the experimenter rejects, at the screen or later by --reject, "
    "doesn't count either; another one is then due. taps.csv says which taps were accepted and rejected, events.csv "
    "why.\n\n"
    "Examples:\n"
    "  ethd-study --plan my.study    (who gets what when, and how balanced that is)\n"
    "  ethd-study --words >>my.study    (then translate what is behind each =)\n"
    "  ethd-study --out session\n"
    "  ethd-study my.study --out session --ask\n"
    "  ethd-study --out mine --screen    (tap with the mouse)\n"
    "  ethd-study device.study --out lab --screen    (source = people)\n"
    "  ethd-study my.study --out station-a --participant 1-6    (7-12 elsewhere)\n"
    "  ethd-study --merge station-a station-b --out both\n"
    "  ethd-study --resume session\n"
    "  ethd-study --resume session --exclude 2 --reason \"was told another task\"\n"
    "  ethd-study --resume session --reject P01-02-004 --reason \"the hand slipped\"\n"
    "  ethd-study --export session\n"
    "  ethd-study --verify session\n"
    "  ethd-study --describe session --out facts    (study.json, for programs)\n"
    "  ethd-study grid.study --simulate 1000 --shard 1/4 --out bulk    (to 4/4)\n"
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
  OPTION_VIRTUAL,
  OPTION_MARKERS,
  OPTION_PLAN,
  OPTION_WORDS,
  OPTION_EXPORT,
  OPTION_VERIFY,
  OPTION_DESCRIBE,
  OPTION_PLUGINS,
  OPTION_WITHDRAW,
  OPTION_EXCLUDE,
  OPTION_INCLUDE,
  OPTION_ACCEPT,
  OPTION_REJECT,
  OPTION_REASON
};

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of a new session, or of a simulation", 0},
    {"resume", OPTION_RESUME, "DIR", 0, "go on with the session in DIR", 0},
    {"participant", OPTION_PARTICIPANT, "K[-L]", 0,
     "run only participant K, from 1, or K to L; the others follow later, or at another station", 0},
    {"finger", OPTION_FINGER, "FILE.csv", 0, "use a recorded movement as every hand's path", 0},
    {"ask", OPTION_ASK, NULL, 0, "take commands on stdin", 0},
    {"screen", OPTION_SCREEN, "WxH", OPTION_ARG_OPTIONAL,
     "open a window, 1280x720 by default; the mouse is the finger, unless people's are", 0},
    {"virtual", OPTION_VIRTUAL, NULL, 0, "with people: run the device in lock-step, as fast as it goes", 0},
    {"markers", OPTION_MARKERS, "HOST:PORT", 0,
     "send a line of text by UDP for each event, for EEG and other recorders", 0},
    {"plan", OPTION_PLAN, NULL, 0, "print everybody's order and its balance, and end", 0},
    {"words", OPTION_WORDS, NULL, 0, "print the screen's words as a section [words], which a study file may replace",
     0},
    {"export", OPTION_EXPORT, "DIR", 0, "write a folder's tables (taps.csv and so on) anew from its study.sqlite", 0},
    {"verify", OPTION_VERIFY, "DIR", 0, "compare a folder's files with its SHA256SUMS", 0},
    {"describe", OPTION_DESCRIBE, "DIR", 0,
     "write what the study in DIR asked for, for programs, into the folder of --out: study.json, a simulated encounter "
     "under each strategy, and of several folders the merged tables",
     0},
    {"plugins", OPTION_PLUGINS, NULL, 0, "with --describe: run the plugins that the folder's configuration names", 0},
    {"quiet", 'q', NULL, 0, "print no line for each tap", 0},
    {"withdraw", OPTION_WITHDRAW, "K", 0, "with --resume: write down that participant K has withdrawn, and end", 1},
    {"exclude", OPTION_EXCLUDE, "K", 0, "with --resume: take participant K out of the analysis, and end", 1},
    {"include", OPTION_INCLUDE, "K", 0,
     "with --resume: take participant K back into the analysis, and to the missing taps, and end", 1},
    {"reject", OPTION_REJECT, "TAP", 0,
     "with --resume: write down that a valid tap, such as P01-02-004, doesn't count, and end", 1},
    {"accept", OPTION_ACCEPT, "TAP", 0, "with --resume: write down that it does, and end", 1},
    {"reason", OPTION_REASON, "WORDS", 0, "why", 1},
    {"simulate", OPTION_SIMULATE, "N", 0, "simulate N participants at every point of the study's [grid]", 2},
    {"shard", OPTION_SHARD, "I/N", 0, "simulate only this share (1/1)", 2},
    {"ticks", OPTION_TICKS, NULL, 0, "record every tick of a simulation, 300 kB a tap", 2},
    {"merge", OPTION_MERGE, "DIR", 0,
     "merge all shards in DIR into DIR/taps.csv; or, with --out, the sessions in DIR and in further folders", 2},
    {0},
};

static ethd__study_options arg = {.shard = {.index = 1, .count = 1}};

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

static void parse_participant(const char *text) {
  const char *to = strchr(text, '-');
  ETHD__FREED char *from = strndup(text, to ? (size_t)(to - text) : strlen(text));
  if (!from) ethd__fail_memory();
  arg.first = ethd__option_integer("--participant", from, 1, ETHD_STUDY_SESSION_PEOPLE);
  arg.last = to ? ethd__option_integer("--participant", to + 1, arg.first, ETHD_STUDY_SESSION_PEOPLE) : arg.first;
}

static void decide(const char *option, const char *decision, const char *text) {
  if (arg.decision) ethd__fail(ETHD_EXIT_INPUT, "%s: one decision at a time is allowed", option);
  arg.decision = decision;
  if (strcmp(decision, "accept") && strcmp(decision, "reject")) {
    arg.decided.participant = (uint32_t)ethd__option_integer(option, text, 1, ETHD_STUDY_SESSION_PEOPLE);
    return;
  }
  char rest;
  ethd__about *tap = &arg.decided;
  if (sscanf(text, "P%5u-%4zu-%7u%c", &tap->participant, &tap->block, &tap->attempt, &rest) != 3 || !tap->participant ||
      !tap->block || !tap->attempt)
    ethd__fail(ETHD_EXIT_INPUT, "%s: found \"%.40s\", participant, block and attempt as in P01-02-004 are allowed",
               option, text);
}

/* What goes with what. */
static void check_options(struct argp_state *state) {
  bool stations = (arg.merge || arg.describe) && arg.out;
  if (!stations && arg.word_count > 1) argp_error(state, "\"%s\": one study file is allowed", arg.word[1]);
  if (!stations && arg.word_count) arg.study = arg.word[0];
  if (arg.describe && !arg.out) argp_error(state, "--describe needs --out DIR");
  if (!!arg.out + !!arg.resume + (arg.merge && (arg.describe || !stations)) + !!arg.export + !!arg.verify + arg.plan +
          arg.words !=
      1)
    argp_error(state, "--out DIR, --resume DIR, --merge DIR, --export DIR, --verify DIR, --plan or --words is needed");
  if (arg.plugins && !arg.describe) argp_error(state, "--plugins needs --describe DIR");
  if (!arg.out && !arg.plan && (arg.study || arg.finger)) argp_error(state, "the study is taken from the folder");
  if ((arg.sharded || arg.shard.record) && !arg.simulate) argp_error(state, "--shard and --ticks need --simulate N");
  if (arg.markers && (arg.simulate || arg.decision || !(arg.out || arg.resume) || stations))
    argp_error(state, "--markers needs a session: --out DIR or --resume DIR");
  if (arg.width && (arg.ask || arg.simulate || arg.finger || arg.merge))
    argp_error(state, "--screen has a finger of its own, and keys: no --ask, --finger, --simulate, --merge");
  if (arg.simulate && (!arg.out || arg.ask || arg.first))
    argp_error(state, "--simulate needs --out DIR, and has nobody to ask or choose");
  if (!arg.decision != !arg.reason || (arg.decision && !arg.resume))
    argp_error(state, "--withdraw, --exclude, --include, --accept and --reject need --resume DIR and --reason WORDS");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'o': arg.out = text; return 0;
  case 'q': arg.quiet = true; return 0;
  case OPTION_RESUME: arg.resume = text; return 0;
  case OPTION_PARTICIPANT: parse_participant(text); return 0;
  case OPTION_FINGER: arg.finger = text; return 0;
  case OPTION_ASK: arg.ask = true; return 0;
  case OPTION_SIMULATE: arg.simulate = ethd__option_integer("--simulate", text, 1, ETHD_STUDY_PEOPLE); return 0;
  case OPTION_SHARD: parse_shard(text); return 0;
  case OPTION_TICKS: arg.shard.record = true; return 0;
  case OPTION_SCREEN: parse_screen(text); return 0;
  case OPTION_MARKERS: arg.markers = text; return 0;
  case OPTION_VIRTUAL: arg.is_virtual = true; return 0;
  case OPTION_MERGE: arg.merge = text; return 0;
  case OPTION_PLAN: arg.plan = true; return 0;
  case OPTION_WORDS: arg.words = true; return 0;
  case OPTION_EXPORT: arg.export = text; return 0;
  case OPTION_VERIFY: arg.verify = text; return 0;
  case OPTION_DESCRIBE: arg.describe = text; return 0;
  case OPTION_PLUGINS: arg.plugins = true; return 0;
  case OPTION_WITHDRAW: decide("--withdraw", "withdraw", text); return 0;
  case OPTION_EXCLUDE: decide("--exclude", "exclude", text); return 0;
  case OPTION_INCLUDE: decide("--include", "include", text); return 0;
  case OPTION_ACCEPT: decide("--accept", "accept", text); return 0;
  case OPTION_REJECT: decide("--reject", "reject", text); return 0;
  case OPTION_REASON: arg.reason = text; return 0;
  case ARGP_KEY_ARG:
    if (arg.word_count == ETHD_STUDY_STATIONS) argp_error(state, "over %d folders", ETHD_STUDY_STATIONS);
    arg.word[arg.word_count++] = text;
    return 0;
  case ARGP_KEY_END: check_options(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "[STUDY]", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  const char *const folders[] = {arg.out, arg.resume, arg.merge, arg.export, arg.verify, arg.describe};
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) ethd__receive(folders[i]);
  for (size_t i = 0; (arg.merge || arg.describe) && i < arg.word_count; i++) ethd__receive(arg.word[i]);
  return ethd__end((arg.merge      ? ethd__command_merge
                    : arg.export   ? ethd__command_export
                    : arg.describe ? ethd__command_describe
                    : arg.verify   ? ethd__command_verify
                    : arg.plan     ? ethd__command_plan
                    : arg.words    ? ethd__command_words
                    : arg.decision ? ethd__command_decide
                    : arg.simulate ? ethd__command_shard
                                   : ethd__command_session)(&arg));
}
