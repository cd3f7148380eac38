/* Recordings of the front in space: they replay to the bit through sense and near surfaces alone, and say where they don't. */
#include <math.h>

#include "unit/recorded.h"

#define SOLIDS "material soft k_e=900\nhalfspace 1 0 0 0.2\nsphere 0.2 0.1 0 0.05 material=soft\n"
#define CONFIG(file) "[space]\nacceleration = 20\nspeed = 3\n[scene]\nfile = " file "\n[ability]\ndelay = 0.005\n"

static void set_up(void) { recorded_set_up(CONFIG("a.solids"), "a.solids", SOLIDS); }

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
  record();
  replays("rec: 2600 ticks, equal to the bit");
}

TEST(test_files) {
  record();
  holds("config.ini", CONFIG("scene.scene"));
  holds("scene.scene", SOLIDS);
}

/* A number of the trace, of the sense and of a surface: none may change by a bit. */
TEST(test_says_what_differs) {
  static const flipped changes[] = {{500, offsetof(ethd_space_trace, command) + 8, "tick 500: command[1]: recorded "},
                                    {700, offsetof(ethd_space_trace, sense.finger), "tick 700: xf[0]: recorded "},
                                    {300, offsetof(ethd_space_trace, near), "tick 300: "},
                                    {200, offsetof(ethd_space_trace, state), "tick 200: state: recorded "}};
  record();
  bits_matter(sizeof(ethd_space_trace), changes, sizeof changes / sizeof *changes);
  /* what found no room isn't there to be counted again */
  flip(sizeof(ethd_space_trace), 100, offsetof(ethd_space_trace, overflow));
  ck_assert_msg(verify() == ETHD_OK, "%s", message);
}

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
  events_matter(changes, sizeof changes / sizeof *changes);
}

/* A recording of the plane isn't one of space. */
TEST(test_other_front) {
  record();
  write_text(recording_folder, "config.ini", "[arm]\n");
  ck_assert_int_eq(verify(), ETHD_E_SYNTAX);
  ck_assert_msg(strstr(message, "tick.npy: other columns than those of this version of libethd"), "%s", message);
}

FIXTURE(set_up, recorded_tear_down)
