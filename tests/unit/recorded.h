/* A folder with a configuration and a recording in it, for the tests of recordings of either front. */
#ifndef ETHD_TESTS_RECORDED_H
#define ETHD_TESTS_RECORDED_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "denormals.h"
#include "ethd/record.h"
#include "text/text.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];
static char folder[32], recording_folder[64];
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

/* The recording's file holds this. */
static void holds(const char *name, const char *expected) {
  char *text = read_text(name);
  ck_assert_str_eq(text, expected);
  free(text);
}

/* Makes the folder, and loads its configuration. */
static void recorded_set_up(const char *ini, const char *scene, const char *scene_text) {
  char path[128];
  (void)ethd__denormals_flush();
  strcpy(folder, "/tmp/ethd-recording-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/c.ini", folder);
  snprintf(recording_folder, sizeof recording_folder, "%s/rec", folder);
  write_text(folder, scene, scene_text);
  write_text(folder, "c.ini", ini);
  ck_assert_msg(ethd_config_load(path, &config, message) == ETHD_OK, "%s", message);
}

static void recorded_tear_down(void) {
  char command[64];
  ethd_config_free(config);
  snprintf(command, sizeof command, "rm -r %s", folder);
  ck_assert_int_eq(system(command), 0);
}

static ethd_status verify(void) { return ethd_recording_verify(recording_folder, true, NULL, message); }

/* The recording replays, and the message begins with its folder and this. */
static void replays(const char *says) {
  ck_assert_msg(verify() == ETHD_OK, "%s", message);
  ck_assert_msg(strstr(message, says) != NULL, "%s", message);
}

/* Flips the lowest bit of a byte of a row, whose size this is. */
static void flip(size_t size, size_t row, size_t offset) {
  char path[128];
  snprintf(path, sizeof path, "%s/tick.npy", recording_folder);
  FILE *file = fopen(path, "r+b");
  ck_assert_ptr_nonnull(file);
  unsigned char head[10], byte;
  ck_assert_uint_eq(fread(head, 1, 10, file), 10);
  long at = 10 + head[8] + 256 * head[9] + (long)(row * size + offset);
  ck_assert(fseek(file, at, SEEK_SET) == 0 && fread(&byte, 1, 1, file) == 1);
  byte ^= 1;
  ck_assert(fseek(file, at, SEEK_SET) == 0 && fwrite(&byte, 1, 1, file) == 1 && fclose(file) == 0);
}

typedef struct flipped {
  size_t row, offset;
  const char *says;
} flipped;

/* Each of these bits matters, and the message says where it is. */
static void bits_matter(size_t size, const flipped *changes, size_t count) {
  for (size_t i = 0; i < count; i++) {
    flip(size, changes[i].row, changes[i].offset);
    ck_assert_int_eq(verify(), ETHD_E_DIFFERS);
    ck_assert_msg(strstr(message, changes[i].says) != NULL, "%s", message);
    flip(size, changes[i].row, changes[i].offset);
  }
  ck_assert_int_eq(verify(), ETHD_OK);
}

/* Each event matters: changed so, or a row late, the replay differs. */
static void events_matter(const char *const changes[][2], size_t count) {
  char *text = read_text("events.csv");
  for (size_t i = 0; i < count; i++) {
    char changed[2048], *at = strstr(text, changes[i][0]);
    ck_assert_msg(at != NULL, "%s", changes[i][0]);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, changes[i][1], at + strlen(changes[i][0]));
    write_text(recording_folder, "events.csv", changed);
    ck_assert_msg(verify() < 0, "%s passed", changes[i][1]);
  }
  free(text);
}

#endif
