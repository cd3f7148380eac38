/* The motion capture: bytes, the sender's clock, and the driver on the loopback. */
#include <arpa/inet.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ethd/driver.h"
#include "finger/camera.h"
#include "finger/inbox.h"
#include "unit/camera_rig.h"
#include "unit/draw.h"
#include "unit/rig.h"

/* As Python's struct packs them, and a CRC worked out by hand of the polynomial (tests/camera.sh sends them so,
   too). */
TEST(test_bytes) {
  static const uint8_t wire[ETHD__EXPOSURE_SIZE] = {'E',  'F',  'C',  '1',  0x02, 0x01, 0x00, 0x00, 0x00, 0xca, 0x9a,
                                                    0x3b, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                                    0xd0, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xd0, 0xbf, 0x00,
                                                    0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3f, 0x01, 0x00, 0x7e, 0x6d};
  ethd__exposure e;
  uint8_t again[ETHD__EXPOSURE_SIZE];
  ck_assert(ethd__exposure_decode(wire, sizeof wire, &e));
  ck_assert(e.seq == 258 && e.t_ns == 1000000000 && e.finger.x == 0.25 && e.finger.y == -0.25 && e.flags == 1);
  ck_assert(e.noise == 0x1p-10);
  ethd__exposure_encode(&e, again);
  ck_assert_mem_eq(wire, again, sizeof wire);
  ck_assert(!ethd__exposure_decode(wire, sizeof wire - 1, &e));
}

/* Datagrams that are late at random, now and then much; the sender's quartz is 50 ppm off: instants are right to 0.3
   ms. */
TEST(test_clock) {
  ethd__camera_clock c = {.delay = 11100000};
  const int64_t zero = INT64_MAX - 500000000; /* the sender's count wraps round on the way */
  double worst = 0;
  for (uint32_t i = 0; i < 5000; i++) {
    double t = i / 90.0, held = -0.2e-3 * log(1 - draw(i, 0, 1)) + (i % 50 == 7 ? 20e-3 : 0);
    int64_t host_ns = (int64_t)(1e9 * t), arrival = host_ns + c.delay + (int64_t)(1e9 * held), sample;
    ethd__exposure e = {
        .seq = i, .t_ns = (int64_t)((uint64_t)zero + (uint64_t)(host_ns + host_ns / 20000)), .flags = 1};
    ck_assert(ethd__camera_clock_step(&c, &e, arrival, &sample));
    ck_assert_int_le(sample, arrival - c.delay);
    if (i > 20) worst = fmax(worst, 1e-9 * fabs((double)(sample - host_ns)));
  }
  ck_assert_double_lt(worst, 0.3e-3);
  ck_assert(c.jumps == 0 && c.lost == 0);
}

/* Out of order, twice, missing: counted, and what is older than the last isn't used. A sender that begins anew is
   followed when its clock is placed. */
TEST(test_order) {
  ethd__camera_clock c = {.delay = 0};
  const uint32_t seq[] = {10, 11, 13, 12, 13, 14};
  const bool used[] = {true, true, true, false, false, true};
  int64_t sample;
  for (int i = 0; i < 6; i++) {
    ethd__exposure e = {.seq = seq[i], .t_ns = seq[i] * INT64_C(11111111)};
    ck_assert_int_eq(ethd__camera_clock_step(&c, &e, e.t_ns + 5, &sample), used[i]);
  }
  ck_assert_uint_eq(c.lost, 3);
  for (int i = 0; i < 6; i++) {
    ethd__exposure anew = {.seq = (uint32_t)i, .t_ns = i * INT64_C(11111111)};
    ck_assert_int_eq(ethd__camera_clock_step(&c, &anew, INT64_C(1000000000000) + anew.t_ns, &sample), i >= 4);
    if (i >= 4) ck_assert(sample == INT64_C(1000000000000) + anew.t_ns);
  }
  ck_assert_uint_eq(c.jumps, 1);
}

/* A bridge that runs for a while and is started again, or whose clock is set, under a network that holds every 50th
   datagram back for 30 ms, the first one afterwards too: readings come again by the fifth exposure and are never younger
   than their data. */
static void begin_again(int before, bool counts_anew, int64_t set_ns) {
  ethd__camera_clock c = {.delay = 5000000};
  int silent = 0;
  for (int i = 0; i < before + 400; i++) {
    bool again = i >= before;
    int64_t true_ns = INT64_C(1000000000000) + i * INT64_C(11111111) + (again && counts_anew ? 1000000000 : 0), sample;
    int64_t held = (int64_t)(1e6 * draw((uint64_t)i, 0, 1)) + (i % 50 == before % 50 ? 30000000 : 0);
    ethd__exposure e = {.seq = (uint32_t)(again && counts_anew ? i - before : i),
                        .t_ns = true_ns + (again ? set_ns : 0)};
    bool reads = ethd__camera_clock_step(&c, &e, true_ns + c.delay + held, &sample);
    if (reads && i > 20) ck_assert_int_le(sample, true_ns + 1000000);
    if (reads && i > 20) ck_assert_int_ge(sample, true_ns - 1000000);
    silent += again && !reads;
  }
  ck_assert_msg(silent == 4 && c.jumps == 1 && c.lost == 0,
                "%d exposures, the count %s, set by %" PRId64 " ns: %d without a reading, %" PRIu64 " jumps, %" PRIu64
                " lost",
                before, counts_anew ? "anew" : "on", set_ns, silent, c.jumps, c.lost);
}

TEST(test_started_again) {
  static const int before[] = {90, 450, 900, 999, 1001, 5400};
  static const int64_t set[] = {-100000000, -300000000, -1100000000, -5000000000,
                                100000000,  300000000,  1100000000,  5000000000};
  for (size_t i = 0; i < sizeof before / sizeof *before; i++) begin_again(before[i], true, 0);
  for (size_t i = 0; i < sizeof set / sizeof *set; i++) begin_again(450, false, set[i]);
  begin_again(5400, true, -INT64_C(60000000000)); /* its clock began with it */
  begin_again(450, true, -300000000);
}

/* ---- the driver ---- */

static void send_exposure(int fd, uint32_t seq, ethd_vec finger, uint16_t flags) {
  ethd__exposure e = {.seq = seq, .t_ns = seq * INT64_C(11000000), .finger = finger, .noise = 2e-4, .flags = flags};
  uint8_t wire[ETHD__EXPOSURE_SIZE];
  ethd__exposure_encode(&e, wire);
  ck_assert_int_eq(sendto(fd, wire, sizeof wire, 0, (struct sockaddr *)&address, sizeof address), sizeof wire);
}

TEST(test_driver) {
  char listen[64], message[ETHD_MESSAGE_MAX] = "";
  int fd = sender();
  void *device;
  snprintf(listen, sizeof listen, "127.0.0.1:%u", ntohs(address.sin_port));
  const ethd_setting settings[] = {{"listen", listen, 2}, {"patience", "0.05", 3}, {"delay", "0.01", 4}};
  ck_assert_int_eq(open_camera(settings, 3, &device, message), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "no exposure came in 0.05 s, 0 other datagrams: does the bridge run?"));
  /* a bridge that sends while it is opened: a child of this test */
  pid_t child = fork();
  if (child == 0)
    for (uint32_t i = 0;; i++) send_exposure(fd, i, (ethd_vec){1, 1}, 1), usleep(2000);
  const ethd_setting patient[] = {{"listen", listen, 2}, {"patience", "30", 3}, {"delay", "0.01", 4}};
  ethd_status status = open_camera(patient, 3, &device, message);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  ck_assert_msg(status == ETHD_OK, "%s", message);
  ethd_limits limits = ethd_driver_camera.limits(device);
  ck_assert_double_eq_tol(limits.finger_age, 0.01 + 3 / 90.0, 1e-12);
  /* what waits when it starts came nobody knows when: none of it is a reading */
  ethd_sense s = {0};
  for (uint32_t i = 0; i < 100; i++) send_exposure(fd, i, (ethd_vec){1, 1}, 1);
  for (int i = 0; i < 1000; i++) (void)!ethd_driver_camera.service(device, 0, INT64_C(900000000));
  (void)!ethd_driver_camera.read(device, INT64_C(900000000), &s);
  ck_assert_int_eq(s.have | s.faults, 0);
  send_exposure(fd, 0, (ethd_vec){1, 1}, 1); /* an old sender */
  for (int i = 0; i < 1000; i++) (void)!ethd_driver_camera.service(device, 0, INT64_C(1000000000));
  (void)!ethd_driver_camera.read(device, INT64_C(1000000000), &s);
  ck_assert_int_eq(s.have, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
  ck_assert_int_eq(ethd_driver_camera.service(device, 0, INT64_C(4989000000)), ETHD_OK);
  for (uint32_t i = 0; i < 20; i++) {
    int64_t now = INT64_C(5000000000) + i * INT64_C(11000000);
    if (i != 5) send_exposure(fd, 1000000 + i, (ethd_vec){0.25 + 1e-3 * i, 0.2}, i != 9);
    if (i == 12) (void)!sendto(fd, "garbage", 7, 0, (struct sockaddr *)&address, sizeof address);
    ck_assert_int_eq(ethd_driver_camera.service(device, 0, now), ETHD_OK);
    s = (ethd_sense){0};
    ck_assert_int_eq(ethd_driver_camera.read(device, now, &s), ETHD_OK);
    ck_assert_int_eq(s.have, i < 4 || i == 5 || i == 9 ? 0 : ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
    if (s.have) ck_assert(s.centre[0] == 0.25 + 1e-3 * i && s.centre[1] == 0.2 && s.finger_noise == 2e-4);
    if (s.have) ck_assert_int_eq(s.sample_ns, now - 10000000);
    if (i > 4) /* the first four place the new sender's clock */
      ck_assert_int_eq(s.faults, i == 6 || i == 12 ? ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST) : 0);
  }
  /* silence is told by the next tick that is due */
  s = (ethd_sense){0};
  (void)!ethd_driver_camera.read(device, INT64_C(5000000000) + 30 * INT64_C(11000000), &s);
  ck_assert_int_eq(s.faults, ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST));
  ethd_driver_camera.close(device);
  close(fd);
}

/* The first datagrams came late: the clock is placed 6 ms earlier by the third. Instants don't go back. */
TEST(test_instants_keep_their_order) {
  ethd__inbox inbox;
  memset(&inbox, 0, sizeof inbox);
  ck_assert_int_eq(ethd__inbox_open(&inbox, 300), ETHD_OK);
  const int64_t told[] = {-500, 10000, 13300, 10600, 13900}, kept[] = {-500, 10000, 13300, 13301, 13900};
  for (int i = 0; i < 5; i++) {
    ethd__inbox_stamp(&inbox, told[i], 20000 + i);
    ck_assert_int_eq(inbox.newest.sample_ns, kept[i]);
    ck_assert_int_eq(inbox.newest.arrival_ns, 20000 + i);
  }
  ethd__inbox_close(&inbox);
}

/* A reading that is younger than the tick is given at the next one, once. */
TEST(test_younger_than_the_tick) {
  ethd__inbox inbox;
  memset(&inbox, 0, sizeof inbox);
  ck_assert_int_eq(ethd__inbox_open(&inbox, 90), ETHD_OK);
  inbox.newest =
      (ethd__sighting){.sample_ns = 1000500, .arrival_ns = 1000700, .have = ETHD_HAVE_CENTRE, .centre = {0.2, 0.1}};
  ethd__inbox_judge(&inbox, true);
  ethd__inbox_put(&inbox);
  const int64_t now[] = {1000000, 1000499, 1000500, 2000000}, have[] = {0, 0, ETHD_HAVE_CENTRE, 0};
  for (int i = 0; i < 4; i++) {
    ethd_sense s;
    memset(&s, 0, sizeof s);
    ethd__inbox_read(&inbox, now[i], &s);
    ck_assert_int_eq(s.have, have[i]);
    ck_assert_int_eq(s.faults, 0);
    ck_assert(s.sample_ns == (have[i] ? 1000500 : 0) && s.centre[0] == (have[i] ? 0.2 : 0));
  }
  ethd__inbox_close(&inbox);
}
