/* Recordings: a folder that replays bit for bit, and says where it doesn't. */
#include <math.h>
#include <sys/stat.h>

#include "draw.h"
#include "record/recording_parts.h"
#include "unit/recorded.h"

#define CONFIG                                                                                          \
  "# a wall\n[scene]\nfile = walls.scene ; the left one\n[transition]\nb_d = 70\n[limits]\nspeed = 5\n" \
  "[velocity]\nmethod = kalman"

static void set_up(void) { recorded_set_up(CONFIG, "walls.scene", "halfplane -1 0 -0.238\n"); }

/* ---- a program that records ---- */

typedef struct program {
  ethd_recording *recording;
  ethd_setup setup;
  ethd_control *control;
  int64_t tick;
} program;

static void event(program *p, const char *kind, const char *detail) {
  ck_assert_int_eq(ethd_recording_event(p->recording, kind, detail), ETHD_OK);
}

static void create(program *p) {
  ethd_error error;
  ethd_control_destroy(p->control);
  ck_assert_int_eq(ethd_control_create(&p->setup, &p->control, &error), ETHD_OK);
}

static void post(program *p) {
  ethd_error error;
  ck_assert_int_eq(ethd_control_post(p->control, &p->setup, &error), ETHD_OK);
}

/* Ring and finger swing into the wall at x = 0.238 and out again. */
static void run(program *p, int ticks) {
  for (int i = 0; i < ticks; i++, p->tick++) {
    double t = 0.001 * (double)p->tick, x = 0.256 + 0.01 * cos(40 * t), y = 0.25 + 0.004 * sin(13 * t);
    ethd_sense sense;
    ethd_command command;
    ethd_trace trace;
    ethd_event e;
    memset(&sense, 0, sizeof sense);
    sense.time_ns = p->tick * 1000000;
    sense.have = ETHD_HAVE_FINGER;
    ck_assert_int_eq(ethd_arm_angles(&p->setup.arm, (ethd_vec){x, y}, -1, sense.q), ETHD_OK);
    sense.finger[0] = x - 0.003 + 1e-4 * draw_normal((uint64_t)p->tick);
    sense.finger[1] = y;
    sense.finger_v[0] = -0.4 * sin(40 * t);
    memset(&trace, 0xff, sizeof trace);
    (void)ethd_control_step(p->control, &sense, &command, &trace);
    while (ethd_control_poll(p->control, &e) == ETHD_OK) continue;
    ck_assert_int_eq(ethd_recording_tick(p->recording, &trace), ETHD_OK);
  }
}

static void record(void) {
  program p = {.setup = config->setup};
  ck_assert_msg(ethd_recording_create(recording_folder, config, true, &p.recording, message) == ETHD_OK, "%s", message);
  create(&p);
  run(&p, 100);
  event(&p, "start", "tap 1, \"again\"");
  create(&p);
  run(&p, 100);
  event(&p, "transition", "smooth");
  ck_assert_int_eq(ethd_config_transition(config, "smooth", &p.setup, message), ETHD_OK);
  post(&p);
  run(&p, 50);
  event(&p, "set", "contact.k_e 2000");
  event(&p, "set", "contact.b_e 30");
  ck_assert_int_eq(ethd_config_set(config, "contact.k_e", "2000", &p.setup, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_set(config, "contact.b_e", "30", &p.setup, message), ETHD_OK);
  post(&p);
  run(&p, 50);
  event(&p, "transition", "offset"); /* b_d was dropped by smooth */
  ck_assert_int_eq(ethd_config_transition(config, "offset", &p.setup, message), ETHD_OK);
  post(&p);
  run(&p, 100);
  event(&p, "setup", "offset"); /* the configuration's: b_d = 70, k_e = 2500 */
  event(&p, "set", "limits.torque 0.5");
  p.setup = config->setup;
  ck_assert_int_eq(ethd_config_set(config, "limits.torque", "0.5", &p.setup, message), ETHD_OK);
  create(&p);
  run(&p, 200);
  event(&p, "set", "limits.speed 0.01"); /* a fault: stops, latched */
  ck_assert_int_eq(ethd_config_set(config, "limits.speed", "0.01", &p.setup, message), ETHD_OK);
  post(&p);
  run(&p, 20);
  event(&p, "fault", "the ring is too fast");
  run(&p, 20);
  event(&p, "set", "limits.speed 5");
  event(&p, "clear", "");
  ck_assert_int_eq(ethd_config_set(config, "limits.speed", "5", &p.setup, message), ETHD_OK);
  post(&p);
  ethd_control_acknowledge(p.control);
  run(&p, 60);
  ck_assert_int_eq(ethd_recording_close(p.recording, message), ETHD_OK);
  ethd_control_destroy(p.control);
}

/* ---- tests ---- */

TEST(test_replays_to_the_bit) {
  char says[256];
  record();
  ck_assert_msg(verify() == ETHD_OK, "%s", message);
  snprintf(says, sizeof says, "%s: 700 ticks, equal to the bit", recording_folder);
  ck_assert_str_eq(message, says);
  ck_assert_int_eq(ethd_recording_verify(recording_folder, true, &(int){1}, message), ETHD_E_UNFINISHED);
  ck_assert_msg(strstr(message, "rec: stopped: 0 of 700 ticks are equal to the bit") != NULL, "%s", message);
}

/* Writes tick.npy anew as versions before `finger_noise` and `learnt` did. */
static void make_older(void) {
  ethd_column then[64];
  char path[128], *row, *rows;
  size_t n = 0, bytes = 0, count;
  void *read;
  ethd_npy *npy;
  snprintf(path, sizeof path, "%s/tick.npy", recording_folder);
  ck_assert_int_eq(ethd_npy_read(path, ethd_trace_columns, sizeof(ethd_trace), &read, &count, message), ETHD_OK);
  row = rows = malloc(count * sizeof(ethd_trace));
  ck_assert_ptr_nonnull(rows);
  for (size_t i = 0; i < count; i++)
    for (const ethd_column *c = ethd_trace_columns; c->name; c++) {
      if (c->newer) continue;
      memcpy(row, (const char *)read + i * sizeof(ethd_trace) + c->offset, 8 * c->count);
      row += 8 * c->count;
    }
  for (const ethd_column *c = ethd_trace_columns; c->name; c++) {
    ck_assert(c->newer || (strcmp(c->name, "finger_noise") && strcmp(c->name, "learnt")));
    if (c->newer) continue;
    then[n] = *c;
    then[n++].offset = (uint32_t)bytes;
    bytes += 8 * c->count;
  }
  then[n].name = NULL;
  ck_assert_int_eq(ethd_npy_create(path, then, bytes, &npy, message), ETHD_OK);
  ck_assert_int_eq(ethd_npy_append(npy, rows, count), ETHD_OK);
  ck_assert_int_eq(ethd_npy_close(npy), ETHD_OK);
  free(rows);
  free(read);
}

/* Columns that versions have added can't be asked for in what earlier ones recorded. */
TEST(test_older_recording) {
  record();
  make_older();
  replays("rec: 700 ticks, equal to the bit");
}

TEST(test_files) {
  record();
  holds("config.ini", "# a wall\n[scene]\nfile = scene.scene\n[transition]\nb_d = 70\n[limits]\nspeed = 5\n"
                      "[velocity]\nmethod = kalman\n");
  holds("scene.scene", "halfplane -1 0 -0.238\n");
  holds("events.csv", "row,kind,detail\n100,start,\"tap 1, \"\"again\"\"\"\n200,transition,smooth\n"
                      "250,set,contact.k_e 2000\n250,set,contact.b_e 30\n300,transition,offset\n"
                      "400,setup,offset\n400,set,limits.torque 0.5\n600,set,limits.speed 0.01\n"
                      "620,fault,the ring is too fast\n640,set,limits.speed 5\n640,clear,\n700,end,closed\n");
}

TEST(test_says_what_differs) {
  static const flipped changes[] = {{350, offsetof(ethd_trace, tau) + 8, "rec: tick 350: tau[1]: recorded "},
                                    {120, offsetof(ethd_trace, beta), "rec: tick 120: beta: recorded "},
                                    {0, offsetof(ethd_trace, state), "rec: tick 0: state: recorded 1, replayed 0"},
                                    {699, offsetof(ethd_trace, v), "rec: tick 699: v[0]: recorded "}};
  record();
  bits_matter(sizeof(ethd_trace), changes, sizeof changes / sizeof *changes);
}

TEST(test_events_matter) {
  static const char *const changes[][2] = {{"100,start,", "101,start,"},
                                           {"200,transition,smooth", "200,fault,smooth"},
                                           {"250,set,contact.k_e 2000", "250,set,contact.k_e 2001"},
                                           {"400,setup,offset", "400,setup,smooth"},
                                           {"300,transition,offset", "301,transition,offset"},
                                           {"400,set,limits.torque 0.5", "400,fault,"},
                                           {"640,clear,", "640,fault,"}};
  record();
  events_matter(changes, sizeof changes / sizeof *changes);
}

/* A program that was killed leaves no end; a tick.npy that was cut isn't what the end says. */
TEST(test_the_end_counts) {
  static const struct {
    const char *end, *says;
    ethd_status status;
  } ends[] = {{"", "700 ticks, equal to the bit, but the recording was never closed: later ones may be lost",
               ETHD_E_UNFINISHED},
              {"700,fault,the recorder lost rows\n", "but the recording was never closed", ETHD_E_UNFINISHED},
              {"701,end,closed\n", "end: row: found 701, but there are 700 ticks", ETHD_E_DIFFERS},
              {"700,end,closed\n", "700 ticks, equal to the bit", ETHD_OK}};
  char changed[2048];
  record();
  char *text = read_text("events.csv"), *end = strstr(text, "700,end,closed\n");
  ck_assert_ptr_nonnull(end);
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
    snprintf(changed, sizeof changed, "%.*s%s", (int)(end - text), text, ends[i].end);
    write_text(recording_folder, "events.csv", changed);
    ck_assert_int_eq(verify(), ends[i].status);
    ck_assert_msg(strstr(message, ends[i].says) != NULL, "%s", message);
  }
  free(text);
}

/* A recording may begin with hot motors, which its rows don't tell. */
TEST(test_heat) {
  program p = {.setup = config->setup};
  const double heat[2] = {0.93, 1.01};
  p.setup.limits.nominal_torque = 0.05;
  for (int told = 0; told < 2; told++) {
    ck_assert_int_eq(ethd_recording_create(recording_folder, config, true, &p.recording, message), ETHD_OK);
    event(&p, "set", "limits.nominal_torque 0.05");
    if (told) event(&p, "heat", "0.93000000000000005 1.01");
    event(&p, "start", "in the middle");
    create(&p);
    ethd_control_set_heat(p.control, heat);
    run(&p, 100);
    ck_assert_int_eq(ethd_recording_close(p.recording, message), ETHD_OK);
    ck_assert_int_eq(verify(), told ? ETHD_OK : ETHD_E_DIFFERS);
  }
  ethd_control_destroy(p.control);
}

TEST(test_bad_events) {
  static const char *const bads[][2] = {
      {"", "events.csv:1: the first line must be row,kind,detail"},
      {"row,kind\n", "events.csv:1: the first line must be row,kind,detail"},
      {"row,kind,detail\n5,start\n", "events.csv:2: no row,kind,detail"},
      {"row,kind,detail\nx,start,\n", "events.csv:2: no row,kind,detail"},
      {"row,kind,detail\n-1,start,\n", "events.csv:2: no row,kind,detail"},
      {"row,kind,detail\n5,start,\n4,start,\n", "events.csv:3: row: found 4, 5 or more is allowed"},
      {"row,kind,detail\n5,begin,\n", "events.csv:2: begin: an unknown kind of event; setup, "},
      {"row,kind,detail\n5,heat,0.5\n", "events.csv:2: heat: two numbers from 0 to 1e9 are allowed"},
      {"row,kind,detail\n5,heat,0.5 inf\n", "events.csv:2: heat: two numbers from 0 to 1e9 are allowed"},
      {"row,kind,detail\n5,set,contact.k_e\n", "events.csv:2: set: section.key value is allowed"},
      {"row,kind,detail\n5,set,contact.k_e -1\n", "events.csv:2: set: contact.k_e: found \"-1\", 0 to 1000000 N/m"},
      {"row,kind,detail\n5,transition,odd\n", "events.csv:2: transition: transition.law: found \"odd\", abrupt"}};
  char says[256];
  record();
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    write_text(recording_folder, "events.csv", bads[i][0]);
    ck_assert_int_lt(verify(), 0);
    snprintf(says, sizeof says, "%s/%s", recording_folder, bads[i][1]);
    ck_assert_msg(strncmp(message, says, strlen(says)) == 0, "%s\nsays %s", bads[i][0], message);
  }
}

TEST(test_missing_files) {
  static const char *const names[] = {"config.ini", "tick.npy", "events.csv", "scene.scene"};
  char from[128], to[128];
  ck_assert_int_lt(verify(), 0);
  record();
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    snprintf(from, sizeof from, "%s/%s", recording_folder, names[i]);
    snprintf(to, sizeof to, "%s/hidden", folder);
    ck_assert_int_eq(rename(from, to), 0);
    ck_assert_int_lt(verify(), 0);
    ck_assert_msg(strstr(message, names[i]) && strstr(message, "No such file"), "%s", message);
    ck_assert_int_eq(rename(to, from), 0);
  }
}

TEST(test_no_place) {
  ethd_recording *recording;
  char path[128];
  snprintf(path, sizeof path, "%s/file", folder);
  write_text(folder, "file", "no folder");
  ck_assert_int_eq(ethd_recording_create(path, config, false, &recording, message), ETHD_E_FILE);
  ck_assert_ptr_null(recording);
  ck_assert_int_eq(ethd_recording_create("/nowhere/rec", config, false, &recording, message), ETHD_E_FILE);
  ck_assert_str_eq(message, "/nowhere/rec: No such file or directory");
}

FIXTURE(set_up, recorded_tear_down)
