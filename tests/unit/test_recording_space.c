/* Recordings of the front in space: they replay to the bit through sense and near surfaces alone, and say where they don't. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "denormals.h"
#include "ethd/record.h"
#include "text/text.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];
static char folder[] = "/tmp/ethd-recording-XXXXXX", recording_folder[64];
static ethd_config *config;

static void write_text(const char *where, const char *name, const char *text) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", where, name);
  ck_assert_msg(ethd_text_write(path, text, strlen(text), message) == ETHD_OK, "%s", message);
}

static char *read_text(const char *name) {
  char path[256], *text;
  size_t length;
  snprintf(path, sizeof path, "%s/%s", recording_folder, name);
  ck_assert_msg(ethd_text_read(path, 1000000, &text, &length, message) == ETHD_OK, "%s", message);
  return text;
}

static void set_up(void) {
  char path[128];
  (void)ethd__denormals_flush();
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/c.ini", folder);
  snprintf(recording_folder, sizeof recording_folder, "%s/rec", folder);
  write_text(folder, "a.solids", "material soft k_e=900\nhalfspace 1 0 0 0.2\nsphere 0.2 0.1 0 0.05 material=soft\n");
  write_text(folder, "c.ini",
             "[space]\nacceleration = 20\nspeed = 3\n[scene]\nfile = a.solids\n[ability]\ndelay = 0.005\n");
  ck_assert_msg(ethd_config_load(path, &config, message) == ETHD_OK, "%s", message);
}

static void tear_down(void) {
  char command[64];
  ethd_config_free(config);
  snprintf(command, sizeof command, "rm -r %s", folder);
  ck_assert_int_eq(system(command), 0);
  strcpy(folder, "/tmp/ethd-recording-XXXXXX");
}

/* ---- a program that records ---- */

typedef struct program {
  ethd_recording *recording;
  ethd_space_setup setup;
  ethd_space *space;
  ethd_vec3 at, v;
  int64_t tick, state[3]; /* state: ticks in each */
} program;

static void event(program *p, const char *kind, const char *detail) {
  ck_assert_int_eq(ethd_recording_event(p->recording, kind, detail), ETHD_OK);
}

static void create(program *p) {
  ethd_error error;
  ethd_space_destroy(p->space);
  ck_assert_int_eq(ethd_space_create(&p->setup, &p->space, &error), ETHD_OK);
}

static void post(program *p) {
  ethd_error error;
  ck_assert_int_eq(ethd_space_post(p->space, &p->setup, &error), ETHD_OK);
}

/* The finger swings into wall and ball and out again, and the effector goes with it. */
static void run_with(program *p, int ticks, uint32_t bad) {
  for (int i = 0; i < ticks; i++, p->tick++) {
    const double t = 0.001 * (double)p->tick;
    ethd_space_sense sense = {.time_ns = p->tick * 1000000, .have = ETHD_SPACE_HAVE_FINGER};
    ethd_surface near[8];
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_event e;
    uint32_t count = (uint32_t)ethd_solids_surfaces(config->solids, NULL, p->at, 0.5, near, 8);
    for (; bad && count < bad; count++) near[count] = (ethd_surface){.point = {NAN, 0, 0}};
    ethd_vec3_put(p->at, sense.x);
    ethd_vec3_put(p->v, sense.v);
    ethd_vec3_put((ethd_vec3){0.15 + 0.05 * sin(9 * t), 0.03 * sin(13 * t), 0.01 * t}, sense.finger);
    ethd_vec3_put((ethd_vec3){0.45 * cos(9 * t), 0.39 * cos(13 * t), 0.01}, sense.finger_v);
    memset(&trace, 0xff, sizeof trace);
    (void)ethd_space_step(p->space, &sense, near, count, &command, &trace);
    while (ethd_space_poll(p->space, &e) == ETHD_OK) continue;
    p->v = ethd_vec3_of(command.value);
    p->at = ethd_vec3_add(p->at, ethd_vec3_scale(1e-3, p->v));
    if (trace.state >= 0 && trace.state < 3) p->state[trace.state]++;
    ck_assert_int_eq(ethd_recording_tick_space(p->recording, &trace), ETHD_OK);
  }
}

static void run(program *p, int ticks) { run_with(p, ticks, 0); }

static void set(program *p, const char *key, const char *value) {
  char detail[128];
  snprintf(detail, sizeof detail, "%s %s", key, value);
  event(p, "set", detail);
  ck_assert_msg(ethd_config_space_set(config, key, value, &p->setup, message) == ETHD_OK, "%s", message);
}

static void law(program *p, const char *kind, const char *id) {
  event(p, kind, id);
  ck_assert_msg(ethd_config_space_law(config, kind, id, &p->setup, message) == ETHD_OK, "%s", message);
}

static void record(void) {
  program p = {.setup = config->space, .at = {0.1, 0, 0}};
  ck_assert_msg(ethd_recording_create(recording_folder, config, true, &p.recording, message) == ETHD_OK, "%s", message);
  create(&p);
  run(&p, 800);
  event(&p, "start", "tap 1");
  create(&p);
  run(&p, 400);
  law(&p, "transition", "smooth");
  post(&p);
  run(&p, 200);
  law(&p, "contact", "spring");
  set(&p, "space.radius", "0.02");
  post(&p);
  run(&p, 200);
  set(&p, "contact.k_e", "2000");
  set(&p, "ability.delay", "0.01");
  post(&p);
  run(&p, 200);
  event(&p, "setup", "approach");
  p.setup = config->space;
  create(&p);
  run(&p, 400);
  run_with(&p, 1, 3); /* a surface that is impossible: a fault, latched */
  event(&p, "fault", "the input is impossible");
  run(&p, 99);
  event(&p, "clear", "");
  ethd_space_acknowledge(p.space);
  run(&p, 200);
  event(&p, "start", "enabled");
  ethd_space_restart(p.space);
  run(&p, 100);
  ck_assert(p.state[0] > 100 && p.state[2] > 100);
  ck_assert_int_eq(ethd_recording_tick(p.recording, &(ethd_trace){.state = 0}), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_recording_close(p.recording, message), ETHD_OK);
  ethd_space_destroy(p.space);
}

/* ---- tests ---- */

TEST(test_replays_to_the_bit) {
  char says[256];
  record();
  ck_assert_msg(ethd_recording_verify(recording_folder, false, NULL, message) == ETHD_OK, "%s", message);
  snprintf(says, sizeof says, "%s: 2600 ticks, equal to the bit", recording_folder);
  ck_assert_str_eq(message, says);
}

TEST(test_files) {
  record();
  char *text = read_text("config.ini");
  ck_assert_str_eq(text,
                   "[space]\nacceleration = 20\nspeed = 3\n[scene]\nfile = scene.scene\n[ability]\ndelay = 0.005\n");
  free(text);
  text = read_text("scene.scene");
  ck_assert_str_eq(text, "material soft k_e=900\nhalfspace 1 0 0 0.2\nsphere 0.2 0.1 0 0.05 material=soft\n");
  free(text);
}

/* Flips a bit of a byte of a row. */
static void flip(size_t row, size_t offset) {
  char path[128];
  snprintf(path, sizeof path, "%s/tick.npy", recording_folder);
  FILE *file = fopen(path, "r+b");
  ck_assert_ptr_nonnull(file);
  unsigned char head[10], byte;
  ck_assert_uint_eq(fread(head, 1, 10, file), 10);
  long at = 10 + head[8] + 256 * head[9] + (long)(row * sizeof(ethd_space_trace) + offset);
  ck_assert(fseek(file, at, SEEK_SET) == 0 && fread(&byte, 1, 1, file) == 1);
  byte ^= 1;
  ck_assert(fseek(file, at, SEEK_SET) == 0 && fwrite(&byte, 1, 1, file) == 1 && fclose(file) == 0);
}

/* A number of the trace, of the sense and of a surface: none may change by a bit. */
TEST(test_says_what_differs) {
  static const struct {
    size_t row, offset;
    const char *says;
  } changes[] = {{500, offsetof(ethd_space_trace, command) + 8, "tick 500: command[1]: recorded "},
                 {700, offsetof(ethd_space_trace, sense.finger), "tick 700: xf[0]: recorded "},
                 {300, offsetof(ethd_space_trace, near), "tick 300: "},
                 {200, offsetof(ethd_space_trace, state), "tick 200: state: recorded "}};
  record();
  for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
    flip(changes[i].row, changes[i].offset);
    ck_assert_int_eq(ethd_recording_verify(recording_folder, false, NULL, message), ETHD_E_DIFFERS);
    ck_assert_msg(strstr(message, changes[i].says) != NULL, "%s", message);
    flip(changes[i].row, changes[i].offset);
  }
  flip(100, offsetof(ethd_space_trace, overflow)); /* what found no room isn't there to be counted again */
  ck_assert_msg(ethd_recording_verify(recording_folder, false, NULL, message) == ETHD_OK, "%s", message);
}

/* Each event matters: without it, or a row late, the replay differs. */
TEST(test_events_matter) {
  static const char *const changes[][2] = {
      {"800,start,", "801,start,"},
      {"1200,transition,smooth", "1200,fault,smooth"},
      {"1400,contact,spring", "1400,fault,"},
      {"1400,contact,spring", "1400,contact,springs"},
      {"1400,set,space.radius 0.02", "1400,fault,"},
      {"1600,set,contact.k_e 2000", "1600,set,contact.k_e 2001"},
      {"1800,setup,approach", "1800,fault,"},
      {"2300,clear,", "2300,fault,"},
      {"2300,clear,", "2300,heat,1 1"},
      {"2500,start,enabled", "2500,fault,"},
  };
  record();
  char *text = read_text("events.csv");
  for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
    char changed[2048];
    char *at = strstr(text, changes[i][0]);
    ck_assert_msg(at != NULL, "%s", changes[i][0]);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, changes[i][1], at + strlen(changes[i][0]));
    write_text(recording_folder, "events.csv", changed);
    ck_assert_msg(ethd_recording_verify(recording_folder, false, NULL, message) < 0, "%s passed", changes[i][1]);
  }
  free(text);
}

/* A recording of the plane isn't one of space. */
TEST(test_other_front) {
  record();
  write_text(recording_folder, "config.ini", "[arm]\n");
  ck_assert_int_eq(ethd_recording_verify(recording_folder, false, NULL, message), ETHD_E_SYNTAX);
  ck_assert_msg(strstr(message, "tick.npy: other columns than those of this version of libethd"), "%s", message);
}

FIXTURE(set_up, tear_down)
