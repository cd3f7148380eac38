/* What the proximity ring's 16 sensors see of the plant behind plant_bridge: asks it where ring and finger are, and
   tells ring_board the counts, a thousand times a second. The ring is empty until the plant's time begins,
   and from a line "out" on stdin to a line "in".

   ring_feed PLANT_PORT BOARD_PORT FINGER_RADIUS [DARK]; ends with stdin. */
#include <arpa/inet.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "ethd/estimate.h"
#include "proximity_ring/calibration.h"

#define RING_RADIUS 0.012

static int line_to(const char *port) {
  struct sockaddr_in at = {
      .sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK), .sin_port = htons((uint16_t)atoi(port))};
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  if (connect(fd, (struct sockaddr *)&at, sizeof at)) exit(1);
  return fd;
}

/* Sensors are never quite still: a few counts, evenly. */
static double noise(void) {
  static uint64_t state = 1;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return 8 * ((double)(state >> 40) * 0x1p-24 - 0.5);
}

/* A ray that meets nothing counts the dark. */
static void counts(const ethd__calibration *law, const double *rays, double dark, char *out, size_t room) {
  size_t n = 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    double c = isnan(rays[k]) ? dark : ethd__sensor_counts(&law->sensors[k], fmax(rays[k], 0));
    n += (size_t)snprintf(out + n, room - n, "%s%d", k ? " " : "", (int)rint(fmin(fmax(c + noise(), 0), 65535)));
  }
}

/* Whether the finger is in the ring, by the last line on stdin; false: it has ended. */
static int hear(int *is_out) {
  char text[64];
  struct pollfd in = {0, POLLIN, 0};
  if (poll(&in, 1, 1) == 0) return 1;
  ssize_t n = read(0, text, sizeof text - 1);
  if (n <= 0) return 0;
  text[n] = 0;
  *is_out = strstr(text, "out") != NULL;
  return 1;
}

int main(int argc, char **argv) {
  if (argc < 4) return 2;
  int plant = line_to(argv[1]), board = line_to(argv[2]);
  double radius = atof(argv[3]), dark = argc > 4 ? atof(argv[4]) : 200;
  ethd__calibration law = ethd__calibration_default();
  for (int k = 0; k < ETHD_RAYS; k++) law.sensors[k].dark = dark;
  int is_out = 0;
  while (hear(&is_out)) {
    double t, ring[2], finger[2], rays[ETHD_RAYS];
    char text[256];
    if (send(plant, "F", 1, 0) != 1) continue;
    struct pollfd answer = {plant, POLLIN, 0};
    if (poll(&answer, 1, 1000) != 1) continue;
    ssize_t n = recv(plant, text, sizeof text - 1, 0);
    if (n <= 0) continue;
    text[n] = 0;
    if (sscanf(text, "%lf %lf %lf %lf %lf", &t, &ring[0], &ring[1], &finger[0], &finger[1]) != 5) continue;
    ethd_fit_rays(RING_RADIUS, radius, (ethd_vec){finger[0] - ring[0], finger[1] - ring[1]}, rays);
    for (int k = 0; (is_out || !(t > 0)) && k < ETHD_RAYS; k++) rays[k] = (double)NAN;
    counts(&law, rays, dark, text, sizeof text);
    (void)!send(board, text, strlen(text), 0);
  }
  return 0;
}
