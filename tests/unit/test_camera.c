/* The motion capture: datagrams, the sender's clock, and the driver on the loopback. */
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

TEST(test_datagram) {
  static const char whole[] =
      "{\"seq\": 258, \"t\": 12.5, \"p\": [0.25, -0.1, 0.3], \"noise\": 0.013, \"v\": [0, 1, 0.4],"
      " \"v_noise\": 0.05, \"confidence\": 0.75}",
                    least[] = "{\"t\":-1e-9,\"seq\":0}", plane[] = "{\"seq\": 4294967295, \"t\": 3, \"p\": [1, 2]}";
  char why[ETHD_MESSAGE_MAX] = "";
  ethd__exposure e;
  ck_assert_msg(ethd__exposure_decode(whole, sizeof whole - 1, &e, why), "%s", why);
  ck_assert(e.seq == 258 && e.t_ns == INT64_C(12500000000) && e.axes == 3 && e.noise == 0.013 && e.v_noise == 0.05);
  ck_assert(e.finger.x == 0.25 && e.finger.y == -0.1 && e.finger.z == 0.3 && e.confidence == 0.75);
  ck_assert(e.v.x == 0 && e.v.y == 1 && e.v.z == 0.4);
  ck_assert_msg(ethd__exposure_decode(least, sizeof least - 1, &e, why), "%s", why);
  ck_assert(e.seq == 0 && e.t_ns == -1 && e.axes == 0 && e.noise == 0 && e.v_noise == 0 && e.confidence == 1);
  ck_assert_msg(ethd__exposure_decode(plane, sizeof plane - 1, &e, why), "%s", why);
  ck_assert(e.seq == UINT32_MAX && e.axes == 2 && e.finger.x == 1 && e.finger.y == 2 && e.finger.z == 0);
}

/* Each wrong datagram is refused with the name of what is wrong. */
TEST(test_wrong_datagrams) {
  static const char *const wrong[][2] = {
      {"", "'[' or '{' expected"},
      {"EFC1", "'[' or '{' expected"},
      {"{\"seq\": 1}", "t"},
      {"{\"t\": 1}", "seq"},
      {"{\"seq\": 1.5, \"t\": 1}", "integer"},
      {"{\"seq\": -1, \"t\": 1}", "seq: 0 to 4294967295 is allowed"},
      {"{\"seq\": 4294967296, \"t\": 1}", "seq: 0 to 4294967295 is allowed"},
      {"{\"seq\": 1, \"t\": 1e10}", "t: seconds up to 9e9 are allowed"},
      {"{\"seq\": 1, \"t\": NaN}", "NaN"},
      {"{\"seq\": 1, \"t\": 1, \"t\": 1}", "duplicate"},
      {"{\"seq\": 1, \"t\": 1, \"pp\": [1, 2]}", "pp"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1]}", "p: two or three numbers"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 2, 3, 4]}", "p: two or three numbers"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, \"2\"]}", "p: two or three numbers"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 1000001]}", "p: two or three numbers within 1e6 m"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 2], \"noise\": -1}", "noise: 0 to 1 m is allowed"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 2], \"v\": [1, 2]}", "v and a v_noise over 0 belong together"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 2], \"v_noise\": 1}", "v and a v_noise over 0 belong together"},
      {"{\"seq\": 1, \"t\": 1, \"p\": [1, 2], \"v\": [1, 2, 3], \"v_noise\": 1}", "v: as many numbers as in p"},
      {"{\"seq\": 1, \"t\": 1, \"confidence\": 2}", "confidence: 0 to 1 is allowed"},
      {"{\"seq\": 1, \"t\": 1} {", "end of file expected"},
  };
  ethd__exposure e;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char why[ETHD_MESSAGE_MAX] = "";
    ck_assert_msg(!ethd__exposure_decode(wrong[i][0], strlen(wrong[i][0]), &e, why), "%s", wrong[i][0]);
    ck_assert_msg(strstr(why, wrong[i][1]) != NULL, "%s: %s", wrong[i][0], why);
  }
  char why[ETHD_MESSAGE_MAX], long_one[ETHD__EXPOSURE_SIZE + 2];
  memset(long_one, ' ', sizeof long_one);
  memcpy(long_one, "{\"seq\": 1, \"t\": 1}", 18);
  ck_assert(!ethd__exposure_decode(long_one, ETHD__EXPOSURE_SIZE + 1, &e, why));
  ck_assert(ethd__exposure_decode(long_one, ETHD__EXPOSURE_SIZE, &e, why));
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
    ethd__exposure e = {.seq = i, .t_ns = (int64_t)((uint64_t)zero + (uint64_t)(host_ns + host_ns / 20000))};
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

static void send_text(int fd, const char *text) {
  const ssize_t sent = sendto(fd, text, strlen(text), 0, (struct sockaddr *)&address, sizeof address);
  ck_assert_int_eq(sent, strlen(text));
}

/* The bridge's datagram at seq periods of 11 ms. */
static void send_exposure(int fd, uint32_t seq, ethd_vec finger, bool seen) {
  char text[256];
  const int n = snprintf(text, sizeof text, "{\"seq\": %u, \"t\": %.9f", seq, 0.011 * seq);
  if (seen)
    snprintf(text + n, sizeof text - (size_t)n, ", \"p\": [%.17g, %.17g], \"noise\": 2e-4}", finger.x, finger.y);
  else
    strcpy(text + n, "}");
  send_text(fd, text);
}

TEST(test_driver) {
  char listen[64], message[ETHD_MESSAGE_MAX] = "";
  int fd = sender();
  void *device;
  snprintf(listen, sizeof listen, "127.0.0.1:%u", ntohs(address.sin_port));
  const ethd_setting settings[] = {{"listen", listen, 2}, {"patience", "0.05", 3}, {"delay", "0.01", 4}};
  ck_assert_int_eq(open_camera(settings, 3, &device, message), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "no datagram came in 0.05 s: does the bridge run?"));
  /* a bridge that sends while it is opened: a child of this test */
  pid_t child = fork();
  if (child == 0)
    for (uint32_t i = 0;; i++) send_exposure(fd, i, (ethd_vec){1, 1}, true), usleep(2000);
  const ethd_setting patient[] = {{"listen", listen, 2}, {"patience", "30", 3}, {"delay", "0.01", 4}};
  ethd_status status = open_camera(patient, 3, &device, message);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  ck_assert_msg(status == ETHD_OK, "%s", message);
  ethd_limits limits = ethd_driver_camera.limits(device);
  ck_assert_double_eq_tol(limits.finger_age, 0.01 + 3 / 90.0, 1e-12);
  /* what waits when it starts came nobody knows when: none of it is a reading */
  ethd_sense s = {0};
  for (uint32_t i = 0; i < 100; i++) send_exposure(fd, i, (ethd_vec){1, 1}, true);
  for (int i = 0; i < 1000; i++) (void)!ethd_driver_camera.service(device, 0, INT64_C(900000000));
  (void)!ethd_driver_camera.read(device, INT64_C(900000000), &s);
  ck_assert_int_eq(s.have | s.faults, 0);
  send_exposure(fd, 0, (ethd_vec){1, 1}, true); /* an old sender */
  for (int i = 0; i < 1000; i++) (void)!ethd_driver_camera.service(device, 0, INT64_C(1000000000));
  (void)!ethd_driver_camera.read(device, INT64_C(1000000000), &s);
  ck_assert_int_eq(s.have, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
  ck_assert_int_eq(ethd_driver_camera.service(device, 0, INT64_C(4989000000)), ETHD_OK);
  for (uint32_t i = 0; i < 20; i++) {
    int64_t now = INT64_C(5000000000) + i * INT64_C(11000000);
    if (i != 5) send_exposure(fd, 1000000 + i, (ethd_vec){0.25 + 1e-3 * i, 0.2}, i != 9);
    if (i == 12) send_text(fd, "garbage");
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

/* In space a position needs three numbers; its velocity comes with it. */
TEST(test_in_space) {
  char listen[64], message[ETHD_MESSAGE_MAX] = "";
  const int fd = sender();
  const ethd_space_setup setup = ethd_space_setup_default();
  void *device;
  snprintf(listen, sizeof listen, "127.0.0.1:%u", ntohs(address.sin_port));
  const ethd_setting settings[] = {{"listen", listen, 2}, {"delay", "0.001", 3}, {"confidence", "0.6", 4}};
  const ethd_device_def def = {NULL, settings, 3, ".", "x.ini", 1, &setup};
  const pid_t child = fork();
  if (child == 0)
    for (uint32_t i = 0;; i++) send_exposure(fd, i, (ethd_vec){1, 1}, true), usleep(2000);
  const ethd_status status = ethd_driver_camera.open(&def, &device, message);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  ck_assert_msg(status == ETHD_OK, "%s", message);
  for (int i = 0; i < 1000; i++) (void)!ethd_driver_camera.service(device, 0, INT64_C(900000000));
  static const char *const texts[] = {
      "{\"seq\": 1, \"t\": 7.5, \"p\": [0.1, -0.2, 0.3], \"noise\": 0.013, \"v\": [1, 2, 3], \"v_noise\": 0.5}",
      "{\"seq\": 2, \"t\": 7.51, \"p\": [0.1, -0.2]}",
      "{\"seq\": 3, \"t\": 7.52, \"p\": [0.4, 0.5, 0.6], \"confidence\": 0.5}",
      "{\"seq\": 4, \"t\": 7.53, \"p\": [0.4, 0.5, 0.6], \"confidence\": 0.7}"};
  const int64_t have[] = {ETHD_SPACE_HAVE_READING | ETHD_SPACE_HAVE_READING_V, 0, 0, ETHD_SPACE_HAVE_READING};
  for (int i = 0; i < 4; i++) {
    const int64_t now = INT64_C(1000000000) + 10000000 * i;
    ethd_space_sense s = {0};
    send_text(fd, texts[i]);
    ck_assert_int_eq(ethd_driver_camera.service(device, 0, now), ETHD_OK);
    ck_assert_int_eq(ethd_driver_camera.read_space(device, now, &s), ETHD_OK);
    ck_assert_int_eq(s.have, have[i]);
    if (have[i]) ck_assert_int_eq(s.sample_ns, now - 1000000);
    if (i == 0)
      ck_assert(s.reading[2] == 0.3 && s.reading_noise == 0.013 && s.reading_v[1] == 2 && s.reading_v_noise == 0.5);
    if (i == 3) ck_assert(s.reading[0] == 0.4 && s.reading[2] == 0.6 && s.reading_noise == 0);
  }
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
      (ethd__sighting){.sample_ns = 1000500, .arrival_ns = 1000700, .have = ETHD_HAVE_CENTRE, .centre = {0.2, 0.1, 0}};
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
