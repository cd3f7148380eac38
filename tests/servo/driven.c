#include "servo/driven.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "text/text.h"

const ethd_driver *const servo = &ethd_driver_servo;
ethd_setup setup;
mock drive;
void *device;
char message[ETHD_MESSAGE_MAX], folder[] = "/tmp/ethd-servo-XXXXXX";
int64_t now;
ethd_sense sense;
ethd_status last;

int is_virtual = 1;

ethd_status open_with(ethd_setting *settings, uint32_t count) {
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, folder, "d.ini", is_virtual, NULL};
  ethd_status status = servo->open(&def, &device, message);
  if (status && device) servo->close(device), device = NULL;
  return status;
}

void open_device(void) {
  mock_start(&drive, 0);
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  ck_assert_msg(open_with(settings, 2) == ETHD_OK, "%s", message);
  now = 0;
}

void start_device(void) {
  open_device();
  ck_assert_int_eq(servo->start(device), ETHD_OK);
}

void close_device(void) {
  servo->close(device);
  mock_stop(&drive);
}

ethd_status tick(double torque1, double torque2) {
  const ethd_command command = {{torque1, torque2}, 0, 0};
  now += TICK;
  (void)!servo->service(device, 0, now);
  memset(&sense, 0, sizeof sense);
  last = servo->read(device, now, &sense);
  (void)!servo->write(device, now, &command);
  return last;
}

char *map_text(void) {
  char *text, path[64];
  size_t length;
  snprintf(path, sizeof path, "%s/plant.map", folder);
  ck_assert_int_eq(ethd_text_read(path, 1 << 16, &text, &length, message), ETHD_OK);
  return text;
}

ethd_status open_map(const char *text, const ethd_setting *more) {
  char path[64];
  snprintf(path, sizeof path, "%s/changed.map", folder);
  ck_assert_int_eq(ethd_text_write(path, text, strlen(text), message), ETHD_OK);
  mock_start(&drive, 0);
  ethd_setting settings[3] = {{"map", "changed.map", 1}, {"port", drive.port, 2}};
  if (more) settings[2] = *more;
  ethd_status status = open_with(settings, more ? 3 : 2);
  now = 0;
  unlink(path);
  return status;
}

ethd_status open_changed(const char *was, const char *now_) {
  char *text = map_text(), *at = strstr(text, was), *all;
  ck_assert_msg(at != NULL, "no %s", was);
  ck_assert_int_ge(asprintf(&all, "%.*s%s%s", (int)(at - text), text, now_, at + strlen(was)), 0);
  ethd_status status = open_map(all, NULL);
  free(text);
  free(all);
  return status;
}

int shows(ethd_fault row) { return (sense.faults & ETHD_FAULT_BIT(row)) != 0; }

int ticks_until(ethd_fault row, int most) {
  int n = 0;
  do tick(0.1, 0);
  while (++n <= most && !shows(row));
  return n;
}

int32_t raw(int at) { return (int16_t)drive.words[at]; }

static mock_act from_to(void *user, uint64_t n, int function) {
  const _Atomic uint64_t *range = user;
  (void)function;
  return (mock_act){n >= range[0] && n < range[1] ? (mock_kind)range[2] : MOCK_ANSWER, (int32_t)range[3], 0};
}

static _Atomic uint64_t range[4];

void spoil(uint64_t count, mock_kind kind, int code) {
  range[0] = drive.requests;
  range[1] = range[0] + count;
  range[2] = (uint64_t)kind;
  range[3] = (uint64_t)code;
  drive.user = range;
  drive.act = from_to;
}

static void write_map(const char *path) {
  char *text;
  size_t length;
  ck_assert_int_eq(ethd_text_read("apps/config/plant.map", 1 << 16, &text, &length, message), ETHD_OK);
  memcpy(strstr(text, "response = 0.003 "), "response = 0.25  ", 17);
  memcpy(strstr(text, "drain = 0.0008 "), "drain = 0.0200 ", 15);
  ck_assert_int_eq(ethd_text_write(path, text, length, message), ETHD_OK);
  free(text);
}

void driven_set_up(void) {
  char path[64];
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/plant.map", folder);
  write_map(path);
}

void driven_tear_down(void) {
  char path[64];
  snprintf(path, sizeof path, "%s/plant.map", folder);
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0);
}
