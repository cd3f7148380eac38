#include "behaviour/fault_ring.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

#include "proximity_ring/decoder.h"
#include "unit/pty.h"
#include "unit/ring_rod.h"

fault_board board;

static ethd__calibration truth;
static int master;
static uint32_t seq;
static atomic_int stop;
static pthread_t thread;
static char folder[64];

static void send_frame(const double *rays, uint32_t t_us) {
  ethd__ring_frame f = {
      .type = ETHD__FRAME_TYPE, .seq = (uint16_t)seq, .t_us = t_us, .flags = seq ? 0 : ETHD__FRAME_FIRST};
  uint8_t wire[ETHD__FRAME_WIRE];
  for (int k = 0; k < ETHD_RAYS; k++) {
    f.counts[k] = (uint16_t)rod_counts(&truth, k, rays ? rays[k] : (double)NAN, 5, (uint64_t)seq * 16 + (uint64_t)k);
    if (board.silent >> k & 1) f.counts[k] = ETHD__FRAME_MISSING;
  }
  if (board.silent) f.flags |= ETHD__FRAME_SENSOR_MISSING;
  seq++;
  ethd__frame_encode(&f, wire);
  if (board.drops > 0 && board.drops--) return;
  if (board.garbles > 0 && board.garbles--) wire[20] ^= 4;
  (void)!write(master, wire, sizeof wire);
}

static void *send_empty(void *unused) {
  const struct timespec pause = {.tv_nsec = 1500000};
  (void)unused;
  for (uint32_t i = 0; !atomic_load(&stop); i++, nanosleep(&pause, NULL))
    send_frame(NULL, (uint32_t)((uint64_t)i * 1000000 / ETHD__FRAME_RATE));
  return NULL;
}

void fault_board_plug(void) {
  char message[ETHD_MESSAGE_MAX];
  board = (fault_board){.drops = 0};
  truth = rod_truth(1);
  truth.level = ETHD__LEVEL_LAW;
  strcpy(folder, "/tmp/ethd-board-XXXXXX");
  if (!mkdtemp(folder)) fault_rig_fail("mkdtemp");
  snprintf(board.calibration, sizeof board.calibration, "%s/ring.ini", folder);
  if (ethd__calibration_save(&truth, board.calibration, message)) fault_rig_fail("%s", message);
  master = pty_open(NULL, board.port);
  if (master < 0) fault_rig_fail("pty");
  seq = 0;
  atomic_store(&stop, 0);
  if (pthread_create(&thread, NULL, send_empty, NULL)) fault_rig_fail("thread");
}

void fault_board_run(void) {
  atomic_store(&stop, 1);
  pthread_join(thread, NULL);
  seq = 0;
}

void fault_board_tick(const ethd_sense *now) {
  if (!(now->have & ETHD_HAVE_RAYS)) return;
  board.frames++;
  send_frame(now->rays, (uint32_t)(now->sample_ns / 1000 + board.jump_us));
}

void fault_board_unplug(void) {
  unlink(board.calibration);
  rmdir(folder);
  close(master);
}
