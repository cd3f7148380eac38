/* The camera's driver on a port of the loopback that is free. */
#ifndef ETHD_TESTS_CAMERA_RIG_H
#define ETHD_TESTS_CAMERA_RIG_H

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "ethd/driver.h"
#include "unit/rig.h"

static struct sockaddr_in address; /* set by sender() */

static int sender(void) {
  socklen_t length = sizeof address;
  int fd = socket(AF_INET, SOCK_DGRAM, 0), probe = socket(AF_INET, SOCK_DGRAM, 0);
  address = (struct sockaddr_in){.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
  ck_assert_int_eq(bind(probe, (struct sockaddr *)&address, sizeof address), 0); /* a port that is free */
  ck_assert_int_eq(getsockname(probe, (struct sockaddr *)&address, &length), 0);
  close(probe);
  return fd;
}

static ethd_status open_camera(const ethd_setting *settings, uint32_t count, void **device, char *message) {
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, ".", "x.ini", 1, NULL};
  ethd_status status = ethd_driver_camera.open(&def, device, message);
  if (status && *device) ethd_driver_camera.close(*device), *device = NULL;
  return status;
}

#endif
