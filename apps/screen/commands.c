#include "screen/commands.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "describe/describe.h"
#include "screen/place.h"
#include "study/plan.h"
#include "study/sums.h"
#include "study/tables.h"
#include "text/file.h"
#include "text/ini.h"
#include "text/text.h"

static void check(ethd_status status, const char *message) {
  if (status) ethd__fail(status == ETHD_E_FILE ? ETHD_EXIT_FAILED : ethd__exit_code(status), "%s", message);
}

/* ---- a new folder ---- */

/* All input is checked before anything is written. */
static void check_study(const ethd__study_options *o, const ethd__protocol *p, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  ethd__desk desk;
  ethd__need(ethd__desk_open(p, loaded, o->finger, &desk, message), message);
  ethd__desk_close(&desk);
  bool people = p->hands == ETHD_HANDS_PEOPLE;
  if (people && (o->simulate || o->finger))
    ethd__fail(ETHD_EXIT_INPUT, "%s: hand.source: people have hands of their own; no --simulate, no --finger", p->path);
  if (!people && o->is_virtual)
    ethd__fail(ETHD_EXIT_INPUT, "--virtual: %s: hand.source: people is needed; any other has no real time", p->path);
  if (p->hands == ETHD_HANDS_MOUSE && (!o->width || o->simulate || o->finger))
    ethd__fail(ETHD_EXIT_INPUT, "%s: hand.source: mouse needs --screen, and no --simulate or --finger", p->path);
  if (p->hands == ETHD_HANDS_RECORDED && o->width)
    ethd__fail(ETHD_EXIT_INPUT, "%s: hand.source: recorded hands need no --screen", p->path);
  if (p->axis_count && !o->simulate)
    ethd__fail(ETHD_EXIT_INPUT, "%s: [grid]: a session has no grid; --simulate has", p->path);
  if (o->last > p->participants)
    ethd__fail(ETHD_EXIT_INPUT, "--participant: found %lld, 1 to %u are allowed", (long long)o->last, p->participants);
}

static void load_study(const ethd__study_options *o, ethd__protocol *out) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *study = o->study ? strdup(o->study) : ethd__data_path("paper.study");
  if (!study) ethd__fail_memory();
  ethd_status status = ethd__protocol_load(study, out, message);
  if (!status) status = ethd__folder_conditions(out, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
}

static void make_folder(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *store = ethd__folder_path(o->out, ETHD_STUDY_STORE);
  ethd__protocol protocol;
  ethd__loaded loaded;
  if (!o->simulate && ethd__file_taken(store) && !ethd__folder_simulated(o->out))
    ethd__fail(ETHD_EXIT_INPUT, "%s: holds a session; --resume %s goes on with it", o->out, o->out);
  load_study(o, &protocol);
  ethd__folder_device(&protocol, &loaded);
  check_study(o, &protocol, &loaded);
  if (o->simulate) protocol.participants = (uint32_t)o->simulate;
  const ethd__folder_parts parts = {&protocol, &loaded, o->finger, (uint32_t)o->simulate};
  check(ethd__folder_make(o->out, &parts, message), message);
  ethd__loaded_free(&loaded);
  ethd__protocol_free(&protocol);
}

/* ---- a session ---- */

#define UNQUOTED " \t'\"\\$`;&|<>()*?" /* characters of a path that a shell reads as its own */

/* Prints the whole command that resumes the session, so that nobody resumes it with another hand. */
static char *going_on(const ethd__study_options *o, const char *folder) {
  ethd__printed text;
  FILE *file = ethd__print_begin(&text);
  fprintf(file, strpbrk(folder, UNQUOTED) ? "ethd-study --resume '%s'" : "ethd-study --resume %s", folder);
  if (o->first) fprintf(file, " --participant %lld", (long long)o->first);
  if (o->last > o->first) fprintf(file, "-%lld", (long long)o->last);
  if (o->width)
    fprintf(file, o->width == 1280 && o->height == 720 ? " --screen" : " --screen=%dx%d", o->width, o->height);
  if (o->ask) fputs(" --ask", file);
  if (o->is_virtual) fputs(" --virtual", file);
  if (o->markers) fprintf(file, " --markers %s", o->markers);
  if (o->quiet) fputs(" --quiet", file);
  return ethd__print_end(&text);
}

/* Returns true if the folder's configuration names plugins, which ethd-report runs only on request. */
static bool has_plugins(const char *folder) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *text = NULL, *path = ethd__folder_path(folder, "config.ini");
  size_t length = 0;
  ethd_ini ini;
  bool has = false;
  if (!ethd_text_read(path, ETHD_INI_BYTES_MAX, &text, &length, message) &&
      !ethd_ini_parse(text, length, path, "plugins.file", NULL, &ini, message)) {
    has = ethd_ini_find(&ini, "plugins", "file") != NULL;
    ethd_ini_free(&ini);
  }
  return has;
}

/* Prints the folder's new contents, and the command that shows them. */
static void say_taps(const char *folder, uint64_t taps, size_t stations) {
  const char *quote = strpbrk(folder, UNQUOTED) ? "'" : "";
  printf("%s: ", folder);
  if (stations)
    printf("%llu tap%s of %zu station%s", (unsigned long long)taps, ethd__s(taps), stations, ethd__s(stations));
  else
    printf("%llu tap%s%s", (unsigned long long)taps, ethd__s(taps), taps ? "" : " were missing");
  printf("; ethd-report %s%s%s%s draws %s\n", has_plugins(folder) ? "--plugins " : "", quote, folder, quote,
         taps == 1 ? "it" : "them");
}

static int end(const ethd__study_options *o, const ethd__sitting *sitting, ethd_status status, bool over,
               const char *message) {
  const char *folder = o->resume ? o->resume : o->out;
  ETHD__FREED char *command = going_on(o, folder);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s; what was done is kept: %s goes on", message, command);
  if (over && sitting->unasked)
    printf("%s: %u questionnaire%s; ethd-study --resume %s with --ask or --screen asks %s\n", folder, sitting->unasked,
           sitting->unasked == 1 ? " wasn't asked" : "s weren't asked", folder, sitting->unasked == 1 ? "it" : "them");
  if (over)
    say_taps(folder, sitting->taps, 0);
  else
    fprintf(stderr, "%s: stopped; what was done is kept: %s goes on\n", program_invocation_short_name, command);
  return over ? ETHD_EXIT_DONE : ETHD_EXIT_FAILED;
}

int ethd__command_session(const ethd__study_options *o) {
  static ethd__screen_place place;
  char message[ETHD_MESSAGE_MAX] = "";
  const ethd__place_options wanted = {.path = o->resume ? o->resume : o->out,
                                      .first = o->first,
                                      .last = o->last,
                                      .ask = o->ask,
                                      .quiet = o->quiet,
                                      .is_virtual = o->is_virtual,
                                      .width = o->width,
                                      .height = o->height};
  bool over = false;
  ethd__container_keeper();
  check(ethd__markers_open(o->markers, &place.markers, message), message);
  if (!o->resume) make_folder(o);
  ethd__place_open(&wanted, &place);
  ethd_status status = ethd__place_run(&place, &over, message);
  int code = end(o, &place.sitting, status, over, message);
  ethd__place_close(&place);
  return code;
}

int ethd__command_decide(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX];
  check(ethd__session_decide(o->resume, o->decided, o->decision, o->reason, message), message);
  printf("%s: participant %u", o->resume, o->decided.participant);
  if (o->decided.attempt) printf(", block %zu, attempt %u", o->decided.block, o->decided.attempt);
  printf(": %s, %s; %s says so\n", o->decision, o->reason, o->decided.attempt ? "taps.csv" : "participants.csv");
  return ETHD_EXIT_DONE;
}

/* ---- a simulation ---- */

int ethd__command_shard(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__folder folder;
  ethd__desk desk;
  uint64_t taps;
  bool over;
  make_folder(o);
  check(ethd__folder_open(o->out, true, &folder, message), message);
  check(ethd__desk_open(&folder.protocol, &folder.loaded, folder.finger, &desk, message), message);
  ethd__catch_interrupt();
  ethd_status status = ethd__shard_run(&folder, &desk, &o->shard, &taps, &over, message);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s; the same command goes on", message);
  bool again = over && !taps;
  if (again)
    fprintf(o->sharded ? stdout : stderr, "%s: shard %u/%u was finished before; nothing is added\n", o->out,
            o->shard.index, o->shard.count);
  else if (over)
    printf("%s: shard %u/%u: %llu tap%s\n", o->out, o->shard.index, o->shard.count, (unsigned long long)taps,
           ethd__s(taps));
  else
    fprintf(stderr, "%s: stopped; what was done is kept: the same command, --out %s goes on\n",
            program_invocation_short_name, o->out);
  ethd__desk_close(&desk);
  ethd__folder_close(&folder);
  /* workers of a cluster repeat their commands until all shards are there */
  return over && (!again || o->sharded) ? ETHD_EXIT_DONE : ETHD_EXIT_FAILED;
}

/* ---- looking at folders ---- */

static int merge_shards(const char *path) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__folder folder;
  uint64_t taps;
  ethd__need(ethd__folder_read(path, &folder, message), message);
  ethd_status status = ethd__shards_merge(&folder, &taps, message);
  if (!status) status = ethd__sums_write(path, message);
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  const size_t points = ethd__protocol_points(&folder.protocol);
  const uint32_t people = folder.protocol.participants;
  printf("%s/%s: %llu tap%s of %u participant%s at %zu point%s\n", path, ETHD_STUDY_TAPS, (unsigned long long)taps,
         ethd__s(taps), people, ethd__s(people), points, ethd__s(points));
  ethd__folder_close(&folder);
  return ETHD_EXIT_DONE;
}

int ethd__command_merge(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX] = "";
  const char *folders[ETHD_STUDY_STATIONS + 2] = {o->merge};
  uint64_t taps;
  if (!o->out) return merge_shards(o->merge);
  memcpy(folders + 1, o->word, o->word_count * sizeof *folders);
  ethd__need(ethd__stations_fit(folders, o->word_count + 1, message), message);
  check(ethd__stations_merge(folders, o->word_count + 1, o->out, &taps, message), message);
  say_taps(o->out, taps, o->word_count + 1);
  return ETHD_EXIT_DONE;
}

int ethd__command_describe(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX] = "";
  const char *folders[ETHD_STUDY_STATIONS + 2] = {o->describe};
  bool job;
  memcpy(folders + 1, o->word, o->word_count * sizeof *folders);
  ethd_status status = ethd__describe(folders, o->word_count + 1, o->plugins, o->out, &job, message);
  if (status) ethd__fail(job ? ETHD_EXIT_FAILED : ethd__exit_code(status), "%s", message);
  return ETHD_EXIT_DONE;
}

int ethd__command_plan(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX], hash[ETHD_SHA256_TEXT];
  ethd__protocol protocol;
  ethd__loaded loaded;
  load_study(o, &protocol);
  ethd__folder_device(&protocol, &loaded);
  const ethd__folder_parts parts = {&protocol, &loaded, o->finger, 0};
  check(ethd__folder_plan_hash(&parts, hash, message), message);
  ethd__plan_print(stdout, &protocol);
  printf("Hash of study, configuration, scene, plant, conditions and movements: %s\n", hash);
  ethd__loaded_free(&loaded);
  ethd__protocol_free(&protocol);
  return ETHD_EXIT_DONE;
}

int ethd__command_words(const ethd__study_options *o) {
  (void)o;
  puts("[words]");
  for (int i = 0; i < ETHD_PHRASES; i++) printf("%s = %s\n", ethd__phrases[i].key, ethd__phrases[i].words);
  return ETHD_EXIT_DONE;
}

int ethd__command_export(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX];
  ethd__folder folder;
  ethd__study_store store;
  check(ethd__folder_read(o->export, &folder, message), message);
  check(ethd__progress_open(&folder, ETHD_STUDY_STORE, false, &store, message), message);
  check(ethd__tables_write(&folder, &store, message), message);
  check(ethd__sums_write(o->export, message), message);
  printf("%s: taps.csv and the other tables are as %s says\n", o->export, ETHD_STUDY_STORE);
  ethd__store_close(&store);
  ethd__folder_close(&folder);
  return ETHD_EXIT_DONE;
}

int ethd__command_verify(const ethd__study_options *o) {
  char message[ETHD_MESSAGE_MAX];
  size_t files;
  ethd_status status = ethd__sums_check(o->verify, &files, message);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  printf("%s: %zu files are as they were\n", o->verify, files);
  return ETHD_EXIT_DONE;
}
