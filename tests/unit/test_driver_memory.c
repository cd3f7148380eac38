/* Memory that runs out at any allocation while the drivers read, write and open things: one message that says so,
   nothing is kept, and no half of a file takes another's place. By standing in the way of the C library. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/driver.h"
#include "ethd/record.h"
#include "ethd/sim.h"
#include "inject/script.h"
#include "servo/map.h"
#include "tape/tape.h"
#include "text/csv.h"
#include "text/ini.h"
#include "text/text.h"
#include "unit/rig.h"
#include "unit/scarce_memory.h"

#ifdef SCARCE_MEMORY_SKIPPED
int main(void) {
  puts("SKIP: a sanitizer's build has an allocator of its own");
  return 77;
}
#else

/* ---- what is tried ---- */

static char message[ETHD_MESSAGE_MAX], folder[64], path[160];

static const char *in_folder(const char *name) {
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void put_file(const char *name, const char *text) {
  FILE *f = fopen(in_folder(name), "w");
  ck_assert_ptr_nonnull(f);
  fputs(text, f);
  ck_assert_int_eq(fclose(f), 0);
}

static ethd_status load_config(void) {
  ethd_config *config;
  ethd_status status = ethd_config_load(in_folder("c.ini"), &config, message);
  ethd_config_free(config);
  return status;
}

static ethd_status read_table(void) {
  static const char *const wanted[] = {"t_s", "x_m", NULL};
  ethd_csv csv;
  ethd_status status = ethd_csv_read_columns(in_folder("t.csv"), wanted, &csv, message);
  if (!status) ethd_csv_free(&csv);
  return status;
}

static ethd_status write_table(void) {
  ethd_csv_out *out = ethd_csv_create(in_folder("out.csv"), "a,b", message);
  if (!out) return ETHD_E_FILE;
  ethd_csv_number(out, 1.5);
  ethd_csv_word(out, "word");
  ethd_csv_row(out);
  return ethd_csv_close(out, message);
}

static ethd_status read_script(void) {
  ethd__script script;
  ethd_status status = ethd__script_load(in_folder("s.inject"), (ethd__script_of){1e-3, false}, &script, message);
  if (!status) ethd__script_free(&script);
  return status;
}

static ethd_status read_map(void) {
  static ethd__servo_map map;
  return ethd__servo_map_load("apps/config/svd48v.map", "svd48v.map", &map, message);
}

static bool is_other;

/* A plant that is loaded in spite of all is the whole plant. */
static ethd_status read_plant(void) {
  static ethd_plant whole;
  ethd_plant plant;
  ethd_status status = ethd_plant_load("apps/config/n.plant", &plant, message);
  if (!status && !counting) whole = plant;
  is_other |= !status && memcmp(&plant, &whole, sizeof plant) != 0;
  return status;
}

static ethd_status record(void) {
  static ethd_trace trace;
  ethd_config *config;
  ethd_recording *recording;
  ethd_status status = ethd_config_load(in_folder("c.ini"), &config, message);
  if (!status) status = ethd_recording_create(in_folder("rec"), config, true, &recording, message);
  for (int i = 0; !status && i < 3; i++) status = ethd_recording_tick(recording, &trace);
  if (!status) status = ethd_recording_close(recording, message);
  ethd_config_free(config);
  return status;
}

static ethd_status verify(void) { return ethd_recording_verify(in_folder("made"), false, NULL, message); }

static ethd_status load_tape(void) {
  ethd__tape tape;
  ethd_status status = ethd__tape_load(in_folder("made"), &tape, message);
  ethd__tape_free(&tape);
  return status;
}

/* Several drivers as one device, with faults by a script. */
static ethd_status open_device(void) {
  const ethd_setup setup = ethd_setup_default();
  const ethd_setting settings[] = {{"inject", "s.inject", 3}, {"excite.torque", "0.2", 4}};
  const ethd_device_def def = {&setup, settings, 2, folder, "c.ini", 1, NULL};
  ethd_device *device;
  ethd_status status = ethd_device_open("sim, excite", NULL, &def, &device, message);
  if (!status) ethd_device_close(device);
  return status;
}

static const struct {
  const char *name;
  ethd_status (*run)(void);
} jobs[] = {{"configuration", load_config}, {"table", read_table},    {"table out", write_table},
            {"script", read_script},        {"map", read_map},        {"plant", read_plant},
            {"recording", record},          {"verification", verify}, {"tape", load_tape},
            {"device", open_device}};

static void begin(void) {
  strcpy(folder, "/tmp/ethd-memory-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  put_file("wall.scene", "halfplane -1 0 -0.238\ncircle 0.1 0.1 0.01\n");
  put_file("c.ini", "[scene]\nfile = wall.scene\n[transition]\nlaw = offset\n[device]\ndriver = sim\n");
  put_file("t.csv", "t_s,other,x_m\n0,1,2\n1,2,3\n");
  put_file("s.inject", "0.5 q1 nan for=0.01\n1 read stale\n");
}

static void end(void) {
  char command[160];
  snprintf(command, sizeof command, "rm -r %s", folder);
  ck_assert_int_eq(system(command), 0);
}

/* A recording of three ticks of a controller, which verifies. */
static void make_recording(void) {
  ethd_config *config;
  ethd_recording *recording;
  ethd_control *control;
  ck_assert_int_eq(ethd_config_load(in_folder("c.ini"), &config, message), ETHD_OK);
  ck_assert_msg(!ethd_recording_create(in_folder("made"), config, false, &recording, message), "%s", message);
  ck_assert_int_eq(ethd_recording_event(recording, "setup", "offset"), ETHD_OK);
  ck_assert_int_eq(ethd_control_create(&config->setup, &control, NULL), ETHD_OK);
  for (int i = 0; i < 3; i++) {
    motion m = rig_at(0.01, 0, 0.001);
    ethd_sense sense = rig_sense(&config->setup.arm, &m);
    ethd_command command;
    ethd_trace trace = {0};
    sense.time_ns = (i + 1) * (int64_t)1000000;
    ck_assert_int_eq(ethd_control_step(control, &sense, &command, &trace), ETHD_OK);
    ck_assert_int_eq(ethd_recording_tick(recording, &trace), ETHD_OK);
  }
  ck_assert_int_eq(ethd_recording_close(recording, message), ETHD_OK);
  ethd_control_destroy(control);
  ethd_config_free(config);
}

TEST_LOOP(test_any_allocation, 0, sizeof jobs / sizeof *jobs) {
  long n = 0, failed = 0;
  begin();
  make_recording();
  ck_assert_msg(!jobs[_i].run(), "%s: %s", jobs[_i].name, message); /* what is made once is there from here on */
  for (bool is_over = false; !is_over; n++) {
    message[0] = 0;
    live = 0, counting = 1, allowed = n;
    ethd_status status = jobs[_i].run();
    is_over = allowed > 0;
    allowed = -1, counting = 0;
    ck_assert_msg(live == 0, "%s, allocation %ld: %d blocks are kept", jobs[_i].name, n, live);
    ck_assert_msg(!is_other, "%s, allocation %ld: something else was read", jobs[_i].name, n);
    if (!status) continue;
    failed++;
    ck_assert_msg(status < 0 && strstr(message, "memory"), "%s, allocation %ld: %d: %s", jobs[_i].name, n, status,
                  message);
    ck_assert_ptr_null(strpbrk(message, "\n\r"));
  }
  ck_assert_msg(failed > 0, "%s: nothing failed", jobs[_i].name);
  ck_assert_msg(!jobs[_i].run(), "%s: %s", jobs[_i].name, message);
  printf("%s: %ld of %ld allocations end it\n", jobs[_i].name, failed, n - 1);
  end();
}
#endif
