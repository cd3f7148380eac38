#include "unit/readers.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "ethd/config.h"
#include "ethd/scene.h"
#include "ethd/solids.h"
#include "finger/camera.h"
#include "inject/script.h"
#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"
#include "record/npy_parts.h"
#include "study/protocol.h"
#include "text/csv.h"
#include "text/ini.h"
#include "unit/config_text.h"
#include "unit/readers_device.h"

static int judged(ethd_status status, const char *message) {
  if (status == ETHD_OK) return 1;
  return status < 0 && message[0] == 'x' && strchr(message, ':') && !strpbrk(message, "\n\r\033") ? 0 : -1;
}

/* ---- scenes and drawings ---- */

static int refused(ethd_status status, const void *made, const ethd_error *error) {
  bool said = status < 0 && error->status == status && error->line >= 1 && error->name[0];
  return said && !made && !strpbrk(error->name, "\n\r\033") ? 0 : -1;
}

static int read_scene(const char *text, size_t length) {
  ethd_scene *scene;
  ethd_error error;
  ethd_status status = ethd_scene_parse(text, length, &scene, &error);
  if (status != ETHD_OK) return refused(status, scene, &error);
  const ethd_vec x = {0.3, 0.7};
  ethd_touch touch;
  ethd_nearest q;
  ethd_scene_query(scene, x, &q);
  size_t found = ethd_scene_touches(scene, x, 1, &touch, 1);
  ethd_scene_destroy(scene);
  if (q.object >= 0 && !(isfinite(q.distance) && fabs(ethd_vec_norm(q.n) - 1) < 1e-12)) return -1;
  return found && touch.distance != q.distance ? -1 : 1;
}

static void grow_scene(FILE *out, int rows) {
  for (int i = 0; i < rows; i++) fprintf(out, "circle %d.5 %d 0.25 # %d\n", i % 997, i / 997, i);
}

static int read_solids(const char *text, size_t length) {
  ethd_solids *solids;
  ethd_error error;
  ethd_status status = ethd_solids_parse(text, length, &solids, &error);
  if (status != ETHD_OK) return refused(status, solids, &error);
  ethd_solids_info info;
  ethd_surface nearest;
  const ethd_vec3 x = {0.3, 0.7, -0.2};
  ethd_solids_describe(solids, &info);
  size_t found = ethd_solids_surfaces(solids, NULL, x, INFINITY, &nearest, 1);
  ethd_solids_destroy(solids);
  if (found != info.objects) return -1;
  return !found || fabs(ethd_vec3_norm(nearest.n) - 1) < 1e-12 ? 1 : -1;
}

static void grow_solids(FILE *out, int rows) {
  for (int i = 0; i < rows; i++) fprintf(out, "sphere %d.5 %d 1 0.25 # %d\n", i % 997, i / 997, i);
}

/* ---- tables ---- */

static int read_ini(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_ini ini;
  ethd_status status = ethd_ini_parse(text, length, "x", "plugins.file", NULL, &ini, message);
  if (status == ETHD_OK) ethd_ini_free(&ini);
  return judged(status, message);
}

static void grow_ini(FILE *out, int rows) { /* comments, for keys are at most 512 */
  fputs("[a]\nkey = 1\n", out);
  for (int i = 0; i < rows; i++) fprintf(out, "; %d: a comment of some length, and nothing else\n\n", i);
}

static int read_csv(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_csv csv;
  static const char *const wanted[] = {"t_s", "x_m", NULL};
  bool finite = true;
  ethd_status status = ethd_csv_parse(text, length, "x", length % 2 ? wanted : NULL, &csv, message);
  for (size_t k = 0; !status && k < csv.rows * csv.columns; k++) finite &= !isinf(csv.values[k]);
  if (status == ETHD_OK) ethd_csv_free(&csv);
  return finite ? judged(status, message) : -1;
}

static void grow_csv(FILE *out, int rows) {
  fputs("t_s,x_m,y_m\n", out);
  for (int i = 0; i < rows; i++) fprintf(out, "%d.001,0.%d,-1e-%d\n", i, i, i % 99);
}

static int read_config(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_config *config;
  ethd_status status = ethd_config_parse(text, length, "x", "/nowhere", &config, message);
  if (status != ETHD_OK) return config ? -1 : judged(status, message);
  bool is_good = config->is_space ? ethd_space_check(&config->space, NULL) == ETHD_OK
                                  : ethd_setup_check(&config->setup, NULL) == ETHD_OK;
  ethd_config_free(config);
  return is_good ? 1 : -1;
}

static int read_calibration(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__calibration calibration;
  return judged(ethd__calibration_parse(text, length, "x", &calibration, message), message);
}

/* ---- recordings ---- */

static int read_npy(const char *text, size_t length) {
  static const ethd_column columns[] = {{"n", "1", 1, 0, 'i', false},
                                        {"x", "m", 16, 8, 'f', false},
                                        {"y", "m", 1, 136, 'f', true},
                                        {NULL, NULL, 0, 0, 0, false}};
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__npy_shape shape = {.columns = columns};
  ethd_status status = ethd__npy_parse(text, length, "x", &shape, message);
  if (status == ETHD_OK && (shape.data > length || shape.count > (length - shape.data) / shape.row_bytes)) return -1;
  return judged(status, message);
}

/* ---- frames of a device, and scripts of faults ---- */

static void grow_frames(FILE *out, int rows) {
  for (int i = 0; i < rows; i++) {
    uint8_t wire[ETHD__FRAME_WIRE];
    ethd__frame_encode(&(ethd__ring_frame){.type = ETHD__FRAME_TYPE, .seq = (uint16_t)i, .t_us = 2000u * (unsigned)i},
                       wire);
    fwrite(wire, 1, sizeof wire, out);
  }
}

static int read_script(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__script script;
  bool is_good = true;
  ethd_status status = ethd__script_parse(text, length, "x", (ethd__script_of){0.001, false}, &script, message);
  for (uint32_t k = 0; k < script.count; k++) {
    const ethd__injection *in = &script.at[k];
    is_good &= in->until_ns > in->from_ns && in->from_ns >= 0 && in->first + in->count <= ETHD_FAULT_COUNT;
  }
  ethd__script_free(&script);
  return is_good ? judged(status, message) : -1;
}

static void grow_script(FILE *out, int rows) {
  for (int i = 0; i < rows; i++) fprintf(out, "%d.25 q1 offset by=0.5 for=0.1 # %d\n", i, i);
}

/* A position that comes out can be; the clock's instant for it is never later than its arrival. */
static int read_exposure(const char *text, size_t length) {
  char why[ETHD_MESSAGE_MAX] = "", message[ETHD_MESSAGE_MAX];
  ethd__exposure e;
  ethd__camera_clock clock = {.delay = 11100000};
  int64_t sample_ns = 0;
  if (!ethd__exposure_decode(text, length, &e, why)) {
    snprintf(message, sizeof message, "x: %.500s", why);
    return *why ? judged(ETHD_E_SYNTAX, message) : -1;
  }
  const double sum = fabs(e.finger.x) + fabs(e.finger.y) + fabs(e.finger.z), v = ethd_vec3_norm(e.v);
  if (!ethd__camera_clock_step(&clock, &e, 1000, &sample_ns) || sample_ns != 1000 - clock.delay) return -1;
  return e.axes <= 3 && sum <= 3e6 && v <= 2e6 && e.noise >= 0 && e.v_noise >= 0 && e.confidence <= 1 ? 1 : -1;
}

/* ---- studies ---- */

static int read_protocol(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__protocol protocol;
  ethd_status status = ethd__protocol_parse(text, length, "x", ".", &protocol, message);
  if (status != ETHD_OK) return judged(status, message);
  bool is_good = ethd__protocol_points(&protocol) >= 1 && protocol.attempts >= protocol.taps;
  ethd__protocol_free(&protocol);
  return is_good ? 1 : -1;
}

/* ---- the table ---- */

static const char *const table_words[] = {",", "\n",   "\"",    "\"\"",  "nan",          "inf", "1e999",
                                          "-", "\r\n", "0x1p9", "1.2.3", "\xef\xbb\xbf", NULL};
static const char *const ini_words[] = {"[",     "]",         "=",  "\n",   ";",       "#",
                                        "[a]\n", "key = 1\n", "\t", "\x01", "plugins", NULL};
static const char *const scene_words[] = {"circle ",
                                          "polygon ",
                                          "box 0 0 1 1 0\n",
                                          "material a k_e=1\n",
                                          " material=a",
                                          "halfplane ",
                                          "\n",
                                          "1e999",
                                          "nan",
                                          "-1",
                                          "0",
                                          "#",
                                          "segment 0 0 1 1\n",
                                          NULL};
static const char *const solid_words[] = {"sphere ",     "halfspace ", "box 0 0 0 1 1 1 0 0 1\n",
                                          "capsule ",    "circle ",    "material a k_e=1\n",
                                          " material=a", "\n",         "1e999",
                                          "nan",         "-1",         "1e-300",
                                          "#",           " 0",         NULL};
static const char *const config_words[] = {"inf",
                                           "nan",
                                           "-",
                                           "1e9",
                                           "law = spring\n",
                                           ";",
                                           "]",
                                           "[",
                                           "\t",
                                           "0x",
                                           " ",
                                           "\r\n",
                                           X50 X50 X50 X50,
                                           "preset = paper\n",
                                           "[plugins]\nfile = /nowhere\n",
                                           "method = kalman\n",
                                           "driver = ",
                                           "[device]\nq = 1\n",
                                           NULL};
static const char *const calibration_words[] = {"[sensor 3]\n", "[law]\n", "point0 = 1 1\n", "a = 1\n",
                                                "nan",          "-",       "level = gain\n", NULL};
static const char *const script_words[] = {"q1", "offset", " by=", " for=",  "inf",   "t",
                                           "-1", "nan",    "\n",   "fault9", "1e999", NULL};
static const char *const exposure_words[] = {
    "{",     "}",     "[",  "]",    ",",    ":",        "\"p\"",   "\"v\": [1, 2, 3]",
    "1e999", "\"t\"", "-1", "null", "true", "\"x\": 0", "\\u0000", NULL};
static const char *const study_words[] = {"[grid]", "[hand]\n", "taps = ", "1e999", "nan", ",",
                                          "=",      "\n",       "latin",   "-",     NULL};
static const char *const npy_words[] = {"'descr'",    "'<f8'", "(",    ")", ", ", "99999999999999999999",
                                        "'shape': (", "\n",    "True", NULL};
#define SENSOR(n) "[sensor " #n "]\ndark = 2e3\nserial = 1\npoint0 = 6e4 1e-3\npoint1 = 3e4 2e-3\n"
#define TEXT(text) (text), sizeof(text) - 1

const text_reader text_readers[] = {
    {"scene",
     TEXT("material soft k_e=500 b_e=10\nhalfplane -1 0 -0.238 material=soft\ncircle 0.2 0.2 0.01\nbox 1 1 2 1 0.5\n"
          "polygon 0 0 0.6 0 0.6 0.238 0.238 0.238\npolyline 0 0 1 1 2 0\ncapsule 0 0 1 0 0.1\n"),
     scene_words, read_scene, grow_scene, 20000},
    {"solids",
     TEXT("material soft k_e=500 b_e=10\nhalfspace 0 0 -1 0 material=soft\nsphere 0.2 0.2 0 0.01\n"
          "box 1 1 1 2 1 0.5\nbox 0 0 9 1 1 1 0.1 0.2 0.3\ncapsule 0 0 0 1 0 0 0.1\n"),
     solid_words, read_solids, grow_solids, 20000},
    {"ini",
     TEXT("[a]\nkey = 1\nword = some words ; and why\n[b]\nlist = 1, 2, 3\n# more\n[plugins]\nfile = a\nfile = b\n"),
     ini_words, read_ini, grow_ini, 2000},
    {"csv", TEXT("t_s,x_m,y_m\n0,1.5,-2e-3\n0.001,,nan\n0.002,7,8\n"), table_words, read_csv, grow_csv, 20000},
    {"config", TEXT(everything), config_words, read_config, NULL, 0},
    {"config_space", TEXT(everything_in_space), config_words, read_config, NULL, 0},
    {"calibration",
     TEXT("[calibration]\nlevel = table\ndate = x\nresidual = 1e-4\n" SENSOR(0) SENSOR(1) SENSOR(2) SENSOR(3) SENSOR(4)
              SENSOR(5) SENSOR(6) SENSOR(7) SENSOR(8) SENSOR(9) SENSOR(10) SENSOR(11) SENSOR(12) SENSOR(13) SENSOR(14)
                  SENSOR(15)),
     calibration_words, read_calibration, NULL, 0},
    {"npy",
     TEXT("\x93NUMPY\x01\x00\x76\x00{'descr': [('n', '<i8'), ('x', '<f8', (16,))], 'fortran_order': False, "
          "'shape': (0,), }                              \n"),
     npy_words, read_npy, NULL, 0},
    {"frames",
     TEXT("\x03\x01\x04\x01\x01\x01\x01\x01\x01\x01\x21\xe8\x03\xd0\x07\xb8\x0b\xa0\x0f\x88\x13\x70"
          "\x17\x58\x1b\x40\x1f\x28\x23\x10\x27\xf8\x2a\xe0\x2e\xc8\x32\xb0\x36\x98\x3a\x56\xd9\x00"
          "\x02\x01\x02\x01\x03\x05\x0d\x01\x02\x01\x21\xe9\x03\xd1\x07\xb9\x0b\xa1\x0f\x89\x13\x71"
          "\x17\x59\x1b\x41\x1f\x29\x23\x11\x27\xf9\x2a\xe1\x2e\xc9\x32\xb1\x36\x99\x3a\x7b\x55\x00"),
     readers_frame_words, readers_frames, grow_frames, 20000},
    {"map", TEXT(MAP_TCP), readers_map_words, readers_map, NULL, 0},
    {"serial", TEXT(MAP_SERIAL), readers_map_words, readers_map, NULL, 0},
    {"values", TEXT(MAP_VALUES), readers_map_words, readers_map, NULL, 0},
    {"arm", TEXT(ARM_TABLE), readers_arm_words, readers_arm, NULL, 0},
    {"inject",
     TEXT("0.500 q1 freeze for=0.1 # why\n612t rays nan for=inf\n0.7 reading delay by=0.02 for=0.2\n0.9 fault9 set\n"),
     script_words, read_script, grow_script, 128},
    {"exposure",
     TEXT("{\"seq\": 258, \"t\": 12.5, \"p\": [0.25, -0.1, 0.3], \"noise\": 0.013, \"v\": [0, 0, 0.4],\n"
          " \"v_noise\": 0.05, \"confidence\": 1}"),
     exposure_words, read_exposure, NULL, 0},
    {"study",
     TEXT(
         "[study]\nname = all\nseed = 18446744073709551615\nparticipants = 10\nstrategies = a, b ,c\nspeeds = low,0.3\n"
         "order = latin\ntaps = 10\nattempts = 100\nsurvey = on\n[validity]\nband_low = 0.05\nband_high = 0.1\n[grid]\n"
         "contact.k_e = 1,2,3\n"),
     study_words, read_protocol, NULL, 0},
    {NULL, NULL, 0, NULL, NULL, NULL, 0},
};
