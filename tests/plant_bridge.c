/* A plant behind registers: the simulated arm and finger in real time, as the words of apps/config/plant.map, for any
   Modbus server that wants a drive behind it. Datagrams on 127.0.0.1, all numbers big endian 16-bit words:

     W address count words...   -> 18 words: all registers
     R                          -> 18 words
     F                          -> text: "t ring_x ring_y finger_x finger_y torque1 torque2", SI

   plant_bridge [--plant n] [--speed 0.4] [--period 1.6] [--finger 0] [--lock-step 1] [--watchdog 0.05]; says "port N"
   first, and a summary at the end of stdin. The finger taps along -x, again and again after the first period; time
   begins when the drive is first enabled, and is the system's; in lock-step a millisecond passes with every new word in
   `counter`, and none otherwise. With --finger 0 the ring never feels it. */
#include <arpa/inet.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "ethd/sim.h"

#define STEP 2e-4   /* s of the plant's own clock */
#define TICK 1e-3   /* s that pass with a set-point, in lock-step */
#define SAMPLES 200 /* a second of the finger's path */
#define SECONDS 3600
#define NM 1e-4 /* a raw torque at the motor */
#define RATIO 9.80
#define COUNTS (4000 * RATIO / 6.283185307179586)

enum {
  CONTROL,
  TORQUE1,
  TORQUE2,
  COUNTER,
  STATUS,
  POSITION1,
  POSITION2 = 7,
  MEASURED1 = 9,
  VOLTAGE = 11,
  READING_X,
  READING_Y = 14,
  READINGS = 16,
  READING_AGE,
  WORDS
};

static struct {
  uint16_t words[WORDS];
  ethd_sim *sim;
  ethd_sense sense;
  double begun, last_set; /* s, monotonic; begun < 0: not yet */
  int64_t steps, reading_ns;
  uint64_t trips, sets;
  int lock_step;
  double clock;    /* s, in lock-step */
  double watchdog; /* s without a set-point, then zero torque */
} plant = {.begun = -1, .watchdog = 0.05};

static double now(void) {
  struct timespec t;
  if (plant.lock_step) return plant.clock;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void fail(const char *what) {
  fprintf(stderr, "plant_bridge: %s\n", what);
  exit(1);
}

/* ---- the finger: reaches along -x, waits in the wall, comes back slowly ---- */

static double smooth(double s) { return s <= 0 ? 0 : s >= 1 ? 1 : s * s * s * (10 + s * (6 * s - 15)); }

static ethd_path make_path(double speed, double period) {
  static ethd_path_sample samples[SAMPLES * SECONDS];
  const double from = 0.29, to = 0.238, reach = 1.875 * (from - to) / speed;
  for (size_t i = 0; i < SAMPLES * SECONDS; i++) {
    double t = (double)i / SAMPLES, s = fmod(t, period) - 0.3;
    double x = from + (to - from) * (smooth(s / reach) - smooth((s - reach - 0.3) / 0.6));
    samples[i] = (ethd_path_sample){t, t < period ? from : x, 0.25};
  }
  return (ethd_path){.samples = samples, .sample_count = SAMPLES * SECONDS};
}

static void make_plant(const char *name, double speed, double period, int finger) {
  char path[256], message[ETHD_MESSAGE_MAX];
  ethd_sim_def def = {.arm = {ETHD_ARM_PARALLEL, 0.25, 0.25},
                      .ring_radius = 0.012,
                      .period = STEP,
                      .step = STEP,
                      .tolerance = ETHD_SIM_FAST};
  ethd_error error;
  snprintf(path, sizeof path, "apps/config/%s.plant", name);
  if (ethd_plant_load(path, &def.plant, message)) fail(message);
  if (!finger) def.plant.pad_stiffness = 0;
  ethd_sim_tap tap = {
      .seed = 1, .finger_radius = def.plant.finger_radius, .commanded = speed, .path = make_path(speed, period)};
  if (ethd_sim_create(&def, &plant.sim, &error) || ethd_sim_start(plant.sim, &tap)) fail("the plant can't start");
}

/* ---- registers ---- */

static void put32(int at, uint32_t bits) {
  plant.words[at] = (uint16_t)(bits >> 16);
  plant.words[at + 1] = (uint16_t)bits;
}

static void put_float(int at, double value) {
  float f = (float)value;
  uint32_t bits;
  memcpy(&bits, &f, sizeof bits);
  put32(at, bits);
}

static void show(void) {
  const ethd_sense *s = &plant.sense;
  put32(POSITION1, (uint32_t)(int32_t)rint(s->q[0] * COUNTS));
  put32(POSITION2, (uint32_t)(int32_t)rint(s->q[1] * COUNTS));
  for (int i = 0; i < 2; i++) plant.words[MEASURED1 + i] = plant.words[STATUS] & 2 ? plant.words[TORQUE1 + i] : 0;
  plant.words[VOLTAGE] = 480;
  double age = 1e-9 * (double)(s->time_ns - plant.reading_ns);
  plant.words[READING_AGE] = (uint16_t)fmin(65535, rint(1e6 * age));
}

static void step(void) {
  ethd_command command = {.safe = !(plant.words[STATUS] & 2)};
  for (int i = 0; i < 2 && !command.safe; i++) command.torque[i] = RATIO * NM * (int16_t)plant.words[TORQUE1 + i];
  ethd_sim_write(plant.sim, &command);
  ethd_sim_read(plant.sim, &plant.sense);
  plant.steps++;
  if (!(plant.sense.have & ETHD_HAVE_CENTRE)) return;
  put_float(READING_X, plant.sense.centre[0]);
  put_float(READING_Y, plant.sense.centre[1]);
  plant.reading_ns = plant.sense.sample_ns;
  plant.words[READINGS]++;
}

/* Up to now, in steps; a drive whose master is silent lets go. */
static void advance(void) {
  double t = now();
  if (plant.begun < 0) return;
  for (; (double)plant.steps * STEP < t - plant.begun - STEP / 2; step()) {
    if (!(plant.words[STATUS] & 2) || plant.begun + (double)plant.steps * STEP - plant.last_set < plant.watchdog)
      continue;
    plant.words[STATUS] &= (uint16_t)~2;
    plant.trips++;
  }
}

static void heed(void) {
  uint16_t *w = plant.words;
  plant.last_set = now();
  plant.sets++;
  if (w[CONTROL] == 2) w[STATUS] &= (uint16_t)~1;
  if (w[CONTROL] == 0) w[STATUS] &= (uint16_t)~2;
  if (w[CONTROL] == 1 && !(w[STATUS] & 2)) {
    w[STATUS] |= 2;
    w[CONTROL] = 3; /* taken: an old command doesn't enable again */
    if (plant.begun < 0) plant.begun = plant.last_set;
  }
}

static void answer(int fd, const uint8_t *q, ssize_t length, const struct sockaddr_in *to) {
  uint8_t out[2 * WORDS];
  advance();
  if (length >= 5 && q[0] == 'W') {
    int at = q[1] << 8 | q[2], count = q[3] << 8 | q[4];
    uint16_t counter = plant.words[COUNTER];
    for (int i = 0; i < count && at + i < STATUS && 6 + 2 * i < length; i++)
      plant.words[at + i] = (uint16_t)(q[5 + 2 * i] << 8 | q[6 + 2 * i]);
    heed();
    if (plant.words[COUNTER] != counter) plant.clock += TICK;
    advance();
  }
  show();
  for (int i = 0; i < WORDS; i++) {
    out[2 * i] = (uint8_t)(plant.words[i] >> 8);
    out[2 * i + 1] = (uint8_t)plant.words[i];
  }
  sendto(fd, out, sizeof out, 0, (const struct sockaddr *)to, sizeof *to);
}

static void tell(int fd, const struct sockaddr_in *to) {
  char out[256];
  ethd_truth truth;
  advance();
  show();
  ethd_sim_truth(plant.sim, &truth);
  int n = snprintf(out, sizeof out, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g", truth.t, truth.ring[0], truth.ring[1],
                   truth.finger[0], truth.finger[1], RATIO * NM * (int16_t)plant.words[MEASURED1],
                   RATIO * NM * (int16_t)plant.words[MEASURED1 + 1]);
  sendto(fd, out, (size_t)n, 0, (const struct sockaddr *)to, sizeof *to);
}

int main(int argc, char **argv) {
  const char *name = "n";
  double speed = 0.4, period = 1.6;
  int finger = 1;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!strcmp(argv[i], "--plant"))
      name = argv[i + 1];
    else if (!strcmp(argv[i], "--speed"))
      speed = atof(argv[i + 1]);
    else if (!strcmp(argv[i], "--period"))
      period = atof(argv[i + 1]);
    else if (!strcmp(argv[i], "--finger"))
      finger = atoi(argv[i + 1]);
    else if (!strcmp(argv[i], "--lock-step"))
      plant.lock_step = atoi(argv[i + 1]);
    else if (!strcmp(argv[i], "--watchdog"))
      plant.watchdog = atof(argv[i + 1]);
    else
      fail("--plant, --speed, --period, --finger, --lock-step and --watchdog are known");
  }
  make_plant(name, speed, period, finger);
  ethd_sim_read(plant.sim, &plant.sense);
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)}, from;
  socklen_t size = sizeof at;
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  if (bind(fd, (struct sockaddr *)&at, size) || getsockname(fd, (struct sockaddr *)&at, &size)) fail("no port");
  printf("port %u\n", ntohs(at.sin_port));
  fflush(stdout);
  for (;;) {
    struct pollfd wait[2] = {{fd, POLLIN, 0}, {0, POLLIN, 0}};
    uint8_t q[512];
    char rest[64];
    if (poll(wait, 2, 20) < 0) break;
    advance(); /* also while nobody asks */
    if (wait[1].revents && read(0, rest, sizeof rest) <= 0) break;
    if (!(wait[0].revents & POLLIN)) continue;
    size = sizeof from;
    ssize_t n = recvfrom(fd, q, sizeof q, 0, (struct sockaddr *)&from, &size);
    if (n >= 1 && q[0] == 'F')
      tell(fd, &from);
    else if (n >= 1)
      answer(fd, q, n, &from);
  }
  printf("plant: %.3f s, %llu set-points, the watchdog let go %llu times\n", (double)plant.steps * STEP,
         (unsigned long long)plant.sets, (unsigned long long)plant.trips);
  return 0;
}
