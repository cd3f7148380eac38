/* Where the camera's driver listens, and to whom. */
#include <netdb.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

#include "finger/camera.h"
#include "unit/camera_rig.h"
#include "unit/suite.h"

TEST(test_refused) {
  static const struct {
    const char *listen, *from, *says;
  } rows[] = {
      {NULL, NULL, "x.ini: device.listen is missing: an address and a port as 127.0.0.1:9871 is allowed"},
      {"localhost:9871", NULL, "x.ini:2: device.listen: found \"localhost:9871\", an address and a port"},
      {"127.0.0.1", NULL, "x.ini:2: device.listen: found \"127.0.0.1\", an address and a port"},
      {"127.0.0.1:99999", NULL, "x.ini:2: device.listen: "},
      {"127.0.0.1:0", NULL, "x.ini:2: device.listen: "},
      {"127.0.0.1:", NULL, "x.ini:2: device.listen: "},
      {"127.0.0.1:9871x", NULL, "x.ini:2: device.listen: "},
      {"127.0.0.1:000009871", NULL, "x.ini:2: device.listen: "},
      {":9871", NULL, "x.ini:2: device.listen: "},
      {"[]:9871", NULL, "x.ini:2: device.listen: "},
      {"[::1:9871", NULL, "x.ini:2: device.listen: "},
      {"1111111111111111111111111111111111111111111111111111111111111111111111111111111111111111111111111:9871", NULL,
       "x.ini:2: device.listen: "},
      {"0.0.0.0:9871", NULL, "127.0.0.1 is allowed, and others with `from`: a sender to this address moves the ring"},
      {"[::]:9871", NULL, "127.0.0.1 is allowed, and others with `from`"},
      {"[::2]:9871", NULL, "127.0.0.1 is allowed, and others with `from`"},
      {"[::1:0:1]:9871", NULL, "127.0.0.1 is allowed, and others with `from`"},
      {"[0:0:1::1]:9871", NULL, "127.0.0.1 is allowed, and others with `from`"},
      {"[1::1]:9871", NULL, "127.0.0.1 is allowed, and others with `from`"},
      {"127.0.0.1:9871", "bridge", "x.ini:3: device.from: found \"bridge\", the bridge's address"},
  };
  char message[ETHD_MESSAGE_MAX];
  void *device;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const ethd_setting settings[] = {{"listen", rows[i].listen, 2}, {"from", rows[i].from, 3}};
    uint32_t count = !rows[i].listen ? 0 : rows[i].from ? 2 : 1;
    message[0] = 0;
    ck_assert_int_lt(open_camera(settings, count, &device, message), 0);
    ck_assert_msg(strstr(message, rows[i].says) != NULL, "%s", message);
  }
}

/* Opens the camera on `host` while a child sends exposures there from the address `own`; the driver listens to
   `from`. */
static ethd_status open_beside(const char *host, const char *from, const char *own, char *message) {
  const struct addrinfo hints = {.ai_flags = AI_NUMERICHOST, .ai_socktype = SOCK_DGRAM};
  struct addrinfo *at, *mine;
  char listen[64];
  void *device;
  char port[8];
  close(sender()); /* finds a free port */
  snprintf(port, sizeof port, "%u", ntohs(address.sin_port));
  snprintf(listen, sizeof listen, strchr(host, ':') ? "[%s]:%s" : "%s:%s", host, port);
  ck_assert_int_eq(getaddrinfo(host, port, &hints, &at), 0);
  ck_assert_int_eq(getaddrinfo(own, NULL, &hints, &mine), 0);
  int fd = socket(at->ai_family, SOCK_DGRAM, 0);
  ck_assert_int_eq(bind(fd, mine->ai_addr, mine->ai_addrlen), 0);
  pid_t child = fork();
  if (child == 0)
    for (uint32_t i = 0;; i++) {
      char text[64];
      const int n = snprintf(text, sizeof text, "{\"seq\": %u, \"t\": %.3f}", i, 0.002 * i);
      (void)!sendto(fd, text, (size_t)n, 0, at->ai_addr, at->ai_addrlen);
      usleep(2000);
    }
  const ethd_setting settings[] = {{"listen", listen, 2}, {"patience", *message ? "0.3" : "30", 3}, {"from", from, 4}};
  ethd_status status = open_camera(settings, from ? 3 : 2, &device, message);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  if (!status) ethd_driver_camera.close(device);
  close(fd);
  freeaddrinfo(at);
  freeaddrinfo(mine);
  return status;
}

/* Whoever can send to the camera's port moves the ring, so with `from` all others' datagrams pass unseen. A message
   that isn't empty asks for little patience. */
TEST(test_only_the_bridge) {
  char message[ETHD_MESSAGE_MAX] = "";
  ck_assert_msg(open_beside("127.0.0.1", "127.0.0.2", "127.0.0.2", message) == ETHD_OK, "%s", message);
  strcpy(message, "little");
  ck_assert_int_eq(open_beside("127.0.0.1", "127.0.0.2", "127.0.0.3", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "no datagram came in 0.3 s") != NULL, "%s", message);
  strcpy(message, "little");
  ck_assert_int_eq(open_beside("127.0.0.1", "::1", "127.0.0.1", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "no datagram came in 0.3 s") != NULL, "%s", message);
}

TEST(test_longer_addresses) {
  char message[ETHD_MESSAGE_MAX] = "";
  int fd = socket(AF_INET6, SOCK_DGRAM, 0);
  const struct sockaddr_in6 own = {.sin6_family = AF_INET6, .sin6_addr = IN6ADDR_LOOPBACK_INIT};
  bool is_known = fd >= 0 && bind(fd, (const struct sockaddr *)&own, sizeof own) == 0;
  close(fd);
  if (!is_known) return; /* a machine without IPv6 */
  ck_assert_msg(open_beside("::1", NULL, "::1", message) == ETHD_OK, "%s", message);
  ck_assert_msg(open_beside("::1", "::1", "::1", message) == ETHD_OK, "%s", message);
  strcpy(message, "little");
  ck_assert_int_eq(open_beside("::1", "::2", "::1", message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "no datagram came in 0.3 s") != NULL, "%s", message);
}

TEST(test_taken_port) {
  char listen[64], expected[96], message[ETHD_MESSAGE_MAX] = "";
  void *device;
  int fd = sender();
  ck_assert_int_eq(bind(fd, (struct sockaddr *)&address, sizeof address), 0);
  snprintf(listen, sizeof listen, "127.0.0.1:%u", ntohs(address.sin_port));
  snprintf(expected, sizeof expected, "%s: Address already in use", listen);
  ck_assert_int_eq(open_camera(&(ethd_setting){"listen", listen, 2}, 1, &device, message), ETHD_E_DEVICE);
  ck_assert_str_eq(message, expected);
  close(fd);
}
