/* The proximity ring's driver on a pty, on the virtual clock: what comes, what is missing, unplugged and plugged
   in again. ETHD_REPLUGS: how often (5). */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <time.h>

#include "ethd/driver.h"
#include "ethd/fault.h"
#include "proximity_ring/settings.h"
#include "unit/pty.h"
#include "unit/rig.h"
#include "unit/ring_scene.h"

#define TICK 1000000
#define VIRTUAL INT64_C(4000000000000000000) /* far from CLOCK_MONOTONIC: nothing waits */

static const ethd_driver *const driver = &ethd_driver_ring;
static char folder[] = "/tmp/ethd-ring-XXXXXX", link_path[64], message[ETHD_MESSAGE_MAX];

static void set_up(void) {
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(link_path, sizeof link_path, "%s/port", folder);
}

static void tear_down(void) {
  char path[80];
  unlink(link_path);
  snprintf(path, sizeof path, "%s/ring.ini", folder);
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0);
}

/* ---- the far end ---- */

typedef struct board {
  ring_scene scene;
  int master, watch; /* watch: on the slave, to see what has got through */
  atomic_int stop;
  bool finger; /* in it while the driver opens */
  pthread_t thread;
} board;

/* The kernel hands a pty's bytes over in its own time: a tick waits for them. */
static void send_bytes(const board *b, const uint8_t wire[ETHD__FRAME_WIRE]) {
  struct timespec pause = {.tv_nsec = 20000};
  int before = 0, now = 0;
  ck_assert_int_eq(ioctl(b->watch, FIONREAD, &before), 0);
  ck_assert_int_eq(write(b->master, wire, ETHD__FRAME_WIRE), ETHD__FRAME_WIRE);
  for (int i = 0; i < 100000 && now < before + ETHD__FRAME_WIRE; i++) {
    ck_assert_int_eq(ioctl(b->watch, FIONREAD, &now), 0);
    if (now < before + ETHD__FRAME_WIRE) nanosleep(&pause, NULL);
  }
}

static void send_frame(const board *b, const ethd__ring_frame *frame) {
  uint8_t wire[ETHD__FRAME_WIRE];
  ethd__frame_encode(frame, wire);
  send_bytes(b, wire);
}

static ethd__ring_frame empty_frame(const ring_scene *s, uint32_t i) {
  ethd__ring_frame f = scene_frame(s, i);
  for (int k = 0; k < ETHD_RAYS; k++)
    f.counts[k] = (uint16_t)rod_counts(&s->truth, k, (double)NAN, 5, i * 16ull + (uint64_t)k);
  return f;
}

/* While the driver opens: frames of an empty ring, many times as fast as real time. */
static void *send_frames(void *board_) {
  board *b = board_;
  struct timespec pause = {.tv_nsec = 200000};
  for (uint32_t i = 0; !atomic_load(&b->stop); i++, nanosleep(&pause, NULL)) {
    uint8_t wire[ETHD__FRAME_WIRE];
    ethd__ring_frame f = b->finger ? scene_frame(&b->scene, i) : empty_frame(&b->scene, i);
    ethd__frame_encode(&f, wire);
    (void)!write(b->master, wire, sizeof wire); /* when nobody reads they are gone, as a UART's */
  }
  return NULL;
}

static void plug(board *b) {
  char path[64];
  b->master = pty_open(link_path, path);
  b->watch = open(path, O_RDWR | O_NOCTTY | O_CLOEXEC);
  ck_assert(b->master >= 0 && b->watch >= 0);
}

static void unplug(board *b) {
  if (b->master < 0) return;
  close(b->master);
  close(b->watch);
  b->master = -1;
}

/* ---- opening ---- */

/* As a caller must: what a failed open leaves is closed. */
static ethd_status open_or_close(const ethd_device_def *def, void **device) {
  ethd_status status = driver->open(def, device, message);
  if (status && *device) driver->close(*device), *device = NULL;
  return status;
}

static ethd_status open_with(board *b, const ethd_setting *settings, uint32_t count, void **device) {
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, folder, "x.ini", 1, NULL};
  atomic_store(&b->stop, 0);
  ck_assert_int_eq(pthread_create(&b->thread, NULL, send_frames, b), 0);
  ethd_status status = open_or_close(&def, device);
  atomic_store(&b->stop, 1);
  pthread_join(b->thread, NULL);
  return status;
}

/* What is still on its way, up to a mark behind it. */
static void drain(const board *b) {
  static const uint8_t mark[4] = {0xee, 0xee, 0xee, 0xee};
  struct timespec pause = {.tv_nsec = 100000};
  uint8_t last[4] = {0};
  ck_assert_int_eq(write(b->master, mark, sizeof mark), sizeof mark);
  for (int i = 0; i < 100000 && memcmp(last, mark, sizeof mark) != 0;) {
    memmove(last, last + 1, 3);
    if (read(b->watch, &last[3], 1) == 1) continue;
    memmove(last + 1, last, 3);
    nanosleep(&pause, NULL);
    i++;
  }
  ck_assert_mem_eq(last, mark, sizeof mark);
}

/* A ring with its calibration in a file, opened; the line is quiet. */
static void *open_ring(board *b) {
  static const ethd_setting settings[] = {
      {"port", "port", 1}, {"calibration", "ring.ini", 2}, {"delay", "0.0042", 3}, {"patience", "30", 4}};
  char path[80];
  void *device;
  *b = (board){.scene = {rod_truth(1), 5, VIRTUAL}, .master = -1};
  b->scene.truth.level = ETHD__LEVEL_LAW;
  snprintf(path, sizeof path, "%s/ring.ini", folder);
  ck_assert_msg(ethd__calibration_save(&b->scene.truth, path, message) == ETHD_OK, "%s", message);
  plug(b);
  ck_assert_msg(open_with(b, settings, 4, &device) == ETHD_OK, "%s", message);
  ck_assert_int_eq(driver->units(device), 1);
  drain(b);
  return device;
}

TEST(test_refused) {
  static const struct {
    const char *key, *value, *says;
  } rows[] = {
      {"calibration", "nowhere.ini", "nowhere.ini: No such file"},
      {"prot", "x", "x.ini:2: device.prot: ring knows port, calibration, baud, delay"},
      {"baud", "fast", "x.ini:2: device.baud: found \"fast\", 9600 to 12000000 1/s is allowed"},
      {"patience", "-1", "x.ini:2: device.patience: found \"-1\", 0.05 to 60 s is allowed"},
      {"empty", "no", "x.ini:2: device.empty: found \"no\", check|trust is allowed"},
      {"empty", "trust", "device.empty = trust: the calibration has no dark of sensor 0; empty = check measures it"},
  };
  board b = {.scene = {rod_truth(1), 5, 0}};
  void *device;
  plug(&b);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const ethd_setting settings[] = {{"port", "port", 1}, {rows[i].key, rows[i].value, 2}, {"patience", "30", 3}};
    ck_assert_int_lt(open_with(&b, settings, strcmp(rows[i].key, "patience") ? 3 : 2, &device), 0);
    ck_assert_msg(strstr(message, rows[i].says) != NULL, "%s", message);
    ck_assert_ptr_null(device);
  }
  ck_assert_int_lt(open_with(&b, NULL, 0, &device), 0);
  ck_assert_str_eq(message, "x.ini: device.port is missing: the ring's serial port, as /dev/ttyUSB0");
  unplug(&b);
}

TEST(test_refused_by_what_comes) {
  static const ethd_setting settings[] = {{"port", "port", 1}, {"patience", "0.3", 2}};
  static const ethd_setting patient[] = {{"port", "port", 1}, {"patience", "30", 2}};
  static ethd_setup setup;
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, 2, folder, "x.ini", 1, NULL};
  board b = {.scene = {rod_truth(1), 5, 0}, .finger = true};
  void *device;
  plug(&b);
  ck_assert_int_eq(open_or_close(&def, &device), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "nothing came in 0.3 s: is the sensor connected and powered?"));
  ck_assert_int_eq(open_with(&b, patient, 2, &device), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "are allowed in an empty ring: remove the object") != NULL, "%s", message);
  unlink(link_path);
  ck_assert_int_eq(open_or_close(&def, &device), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "port: No such file or directory"));
  unplug(&b);
}

/* ---- ticks ---- */

typedef struct run {
  board board;
  void *device;
  int64_t now_ns;
  uint32_t next; /* frame */
  uint64_t rays;
  ethd_sense sense;
} run;

static void begin(run *r) {
  memset(r, 0, sizeof *r);
  r->device = open_ring(&r->board);
  r->now_ns = VIRTUAL;
}

/* What may become of frame i; false: it is lost. */
typedef bool (*mangle)(ethd__ring_frame *frame, uint32_t i);

/* A tick: the frames that are due are sent, or not; then service and read. */
static ethd_status tick(run *r, mangle how) {
  r->now_ns += TICK;
  for (; scene_arrival(&r->board.scene, r->next) <= r->now_ns; r->next++) {
    ethd__ring_frame f = scene_frame(&r->board.scene, r->next);
    if (r->board.master >= 0 && (!how || how(&f, r->next))) send_frame(&r->board, &f);
  }
  ethd_status status = driver->service(r->device, 0, r->now_ns);
  r->sense = (ethd_sense){.time_ns = r->now_ns};
  ck_assert_int_eq(driver->read(r->device, r->now_ns, &r->sense), ETHD_OK);
  if (r->sense.have & ETHD_HAVE_RAYS) {
    r->rays++;
    ck_assert_int_le(r->sense.sample_ns, r->now_ns);
  }
  return status;
}

static void end(run *r) {
  driver->close(r->device);
  unplug(&r->board);
}

TEST(test_readings) {
  run r;
  begin(&r);
  for (uint32_t i = 0; i < 2000; i++) {
    tick(&r, NULL);
    if (!(r.sense.have & ETHD_HAVE_RAYS)) continue;
    uint32_t frame = r.next - 1;
    ethd__ring_reading reading = {0};
    memcpy(reading.rays, r.sense.rays, sizeof reading.rays);
    ck_assert_double_le(scene_error(&reading, frame), 0.08e-3);
    /* arrivals are seen at ticks: the envelope finds those that weren't late */
    if (i > 1000)
      ck_assert_int_le(
          llabs(r.sense.sample_ns - VIRTUAL - (int64_t)(1e9 * scene_time(frame)) - 1000 * (int64_t)ETHD__MIDDLE_US),
          400000);
    ck_assert_int_eq(r.sense.faults | r.sense.grave, 0);
  }
  ck_assert_uint_eq(r.rays, r.next);
  ethd_figure figures[ETHD_FIGURES_MAX];
  uint32_t n = driver->figures(r.device, figures, ETHD_FIGURES_MAX);
  ck_assert(n > 0 && !strcmp(figures[0].name, "ring frames") && figures[0].value >= r.next);
  ck_assert_uint_eq(driver->figures(r.device, figures, 3), 3);
  ck_assert_ptr_nonnull(driver->remark(r.device, 0));
  ck_assert_ptr_null(driver->remark(r.device, 1));
  end(&r);
}

/* A tick that is late may meet a reading that was taken after its own instant; the reading waits for the next one. */
TEST(test_younger_than_the_tick) {
  run r;
  begin(&r);
  while (r.rays < 20) tick(&r, NULL);
  int64_t stamp = r.sense.sample_ns;
  ethd__ring_frame f = scene_frame(&r.board.scene, r.next);
  send_frame(&r.board, &f);
  r.now_ns += 5 * TICK;
  ck_assert_int_eq(driver->service(r.device, 0, r.now_ns), ETHD_OK);
  const int64_t now[] = {stamp, stamp + 1000, r.now_ns, r.now_ns + TICK}, have[] = {0, 0, ETHD_HAVE_RAYS, 0};
  for (int i = 0; i < 4; i++) {
    ethd_sense s = {.time_ns = now[i]};
    ck_assert_int_eq(driver->read(r.device, now[i], &s), ETHD_OK);
    ck_assert_int_eq(s.have, have[i]);
    if (have[i]) ck_assert(s.sample_ns > stamp + 1000 && s.sample_ns <= now[i]);
  }
  end(&r);
}

/* ---- rows of the fault table: behaviour/fault_rows.c, test_ring_board.c, and one here ---- */

static uint32_t onset;

/* All sensors count 2000 more after a while: a row, and a sentence. */
static bool all_brighter(ethd__ring_frame *f, uint32_t i) {
  for (int k = 0; k < ETHD_RAYS && i > onset; k++)
    f->counts[k] = (uint16_t)fmin(f->counts[k] + fmin(20.0 * (i - onset), 2000), 65000);
  return true;
}

TEST(test_drift) {
  run r;
  const char *said = NULL;
  onset = 60;
  begin(&r);
  for (int n = 0; n < 4000 && !(r.sense.faults & ETHD_FAULT_BIT(ETHD_FAULT_SENSOR)); n++) tick(&r, all_brighter);
  ck_assert(r.sense.faults & ETHD_FAULT_BIT(ETHD_FAULT_SENSOR));
  ck_assert(!(r.sense.grave & ETHD_FAULT_BIT(ETHD_FAULT_SENSOR)));
  for (uint32_t i = 0; (said = ethd_driver_ring.remark(r.device, i)) && !strstr(said, "have drifted together"); i++)
    continue;
  ck_assert_msg(said && strstr(said, "mm too large"), "%s", said ? said : "no remark");
  end(&r);
}

/* ---- a line to which nobody listened ---- */

/* Frames wait while the device is open and not started, and while a program is halted. None of them is a reading, since
   nobody knows when it came. The first one that comes afterwards is one, with its instant. */
TEST(test_waiting_frames) {
  run r;
  begin(&r);
  for (int pause = 0; pause < 2; pause++) {
    for (int k = 0; k < 60; k++, r.next++) {
      ethd__ring_frame f = scene_frame(&r.board.scene, r.next);
      send_frame(&r.board, &f);
    }
    r.now_ns = VIRTUAL + (2 + 5 * pause) * INT64_C(1000000000);
    ck_assert_int_eq(driver->service(r.device, 0, r.now_ns), ETHD_OK);
    r.sense = (ethd_sense){.time_ns = r.now_ns};
    ck_assert_int_eq(driver->read(r.device, r.now_ns, &r.sense), ETHD_OK);
    ck_assert_int_eq(r.sense.have, 0);
    while (scene_arrival(&r.board.scene, r.next) <= r.now_ns) r.next++;
    const uint64_t before = r.rays;
    const int64_t from = r.now_ns;
    while (r.rays == before) ck_assert_int_lt((tick(&r, NULL), r.now_ns), from + 20 * TICK);
    ck_assert_int_le(llabs(r.sense.sample_ns - VIRTUAL - (int64_t)(1e9 * scene_time(r.next - 1))), 6 * TICK);
    ck_assert_int_eq((r.sense.faults | r.sense.grave) & ~(pause ? ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST) : 0), 0);
  }
  end(&r);
}

/* ---- unplugged ---- */

TEST(test_replug) {
  const char *wanted = getenv("ETHD_REPLUGS");
  int replugs = wanted ? atoi(wanted) : 5;
  uint64_t lost = 0;
  run r;
  begin(&r);
  for (int i = 0; i < replugs; i++) {
    uint64_t sent = 0, before;
    for (int k = 0; k < 40 + i % 9; k++) tick(&r, NULL);
    unplug(&r.board);
    for (int k = 0; k < 30 + i % 7; k++) tick(&r, NULL);
    ck_assert(r.sense.faults & ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST)); /* lasts */
    plug(&r.board);
    while (r.sense.faults & ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST)) ck_assert_int_le((tick(&r, NULL), ++sent), 2000);
    before = r.rays;
    uint32_t from = r.next;
    for (int k = 0; k < 100; k++) tick(&r, NULL);
    lost += r.next - from - (r.rays - before);
  }
  ck_assert_uint_eq(lost, 0);
  ethd_figure figures[ETHD_FIGURES_MAX];
  uint32_t n = driver->figures(r.device, figures, ETHD_FIGURES_MAX);
  for (uint32_t i = 0; i < n; i++)
    if (!strcmp(figures[i].name, "ring port opened")) ck_assert(figures[i].value == replugs + 1);
  printf("unplugged and plugged in again %d times, %llu readings, none lost while it was plugged in\n", replugs,
         (unsigned long long)r.rays);
  end(&r);
}

FIXTURE(set_up, tear_down)
