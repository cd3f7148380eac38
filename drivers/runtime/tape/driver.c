/* A recorded session as a device: read gives the recorded samples, and write compares the commands with the recorded
   ones. So the same programs can run a session again without its hardware.

       [device]
       driver = replay
       folder = session1          written by ethd-run --record

   The torque of each tick must be equal to the bit. During a soft start both joints must have the same share of it, and
   this share must rise. Differences are counted and make stop return ETHD_E_DIFFERS. A late tick in real time changes
   the periods and thus the commands; on a virtual clock every difference is a real one. After the last tick the device
   can't be read.

   A device gives samples and takes torques, but a program posts the setups. So the commands of the session (transition,
   set, ack, enable) must be given again at the same instants, for instance by the same lines on the standard input of
   ethd-run --virtual; a missing command shows as a difference. ethd-replay --verify takes the commands from the
   recording itself. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/driver.h"
#include "tape/tape.h"
#include "text/error_text.h"
#include "text/text.h"

typedef struct replay {
  ethd__tape tape;
  size_t next;     /* the row that read gives next */
  size_t answered; /* rows whose command has come, without the safe command at the end */
  int64_t waits;   /* periods without a sample */
  double share;    /* of the recorded torque in the last command */
  uint64_t compared, different;
  double first; /* the first row that differs, -1: none */
  bool runs;    /* the replay runs; a start after a fault doesn't begin again */
  char remark[288];
} replay;

/* ---- opening ---- */

static const char *const keys[] = {"folder", NULL};

static ethd_status load(const ethd_device_def *def, replay *r, char *message) {
  const ethd_setting *folder = NULL;
  ethd_status status = ethd_settings_read(&ethd_driver_replay, def, NULL, &folder, message);
  if (status) return status;
  if (!folder)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.folder: the replay needs the folder of a recording",
                     def->file ? def->file : "the defaults");
  ETHD__FREED char *path = ethd__path_join(def->folder, folder->value);
  return path ? ethd__tape_load(path, &r->tape, message) : ethd__no_memory(message, NULL);
}

static void replay_close(void *device) {
  replay *r = device;
  if (!r) return;
  ethd__tape_free(&r->tape);
  free(r);
}

static ethd_status replay_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  replay *r = *out = calloc(1, sizeof *r);
  if (!r) return ETHD_E_MEMORY;
  ethd_status status = load(def, r, message);
  snprintf(
      r->remark, sizeof r->remark,
      "tick %zu of the recording had the command %s; without the same commands at the same times the replay differs",
      r->tape.changed, r->tape.change);
  return status;
}

static ethd_status replay_start(void *device) {
  replay *r = device;
  r->share = 0;
  if (r->runs) return ETHD_OK;
  r->runs = 1;
  r->next = r->answered = 0;
  r->waits = 0;
  r->compared = r->different = 0;
  r->first = -1;
  return ETHD_OK;
}

/* ---- [rt] ---- */

/* Replays the recording; the missed periods before a sample give no sample. */
static ethd_status replay_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  replay *r = device;
  (void)now_ns;
  if (r->next == r->tape.count) return ETHD_E_DEVICE;
  const ethd_sense *s = &r->tape.rows[r->next].sense;
  if (r->waits < s->missed) {
    r->waits++;
    return ETHD_STATUS_STALE;
  }
  r->waits = 0;
  r->next++;
  *out = *s;
  return ETHD_OK;
}

static bool same_share(const double torque[2], const double recorded[2], double share) {
  for (int j = 0; j < 2; j++)
    if (!(fabs(torque[j] - share * recorded[j]) <= 1e-15 * fabs(recorded[j]))) return false;
  return true;
}

/* Returns true if a command is the row's; *share is its share of the recorded torque. */
static bool is_same(const replay *r, const ethd_trace *row, const ethd_command *c, double *share) {
  int big = fabs(row->tau[1]) > fabs(row->tau[0]);
  *share = r->share;
  if (c->safe) {
    *share = 0;
    return row->fault != 0 || r->share == 0;
  }
  if (row->tau[big] == 0 || memcmp(c->torque, row->tau, sizeof row->tau) == 0) {
    if (row->tau[big] != 0) *share = 1;
    return c->torque[0] == row->tau[0] && c->torque[1] == row->tau[1];
  }
  *share = c->torque[big] / row->tau[big];
  return *share >= r->share && *share < 1 && same_share(c->torque, row->tau, *share);
}

static ethd_status replay_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  replay *r = device;
  (void)now_ns;
  if (r->next == r->answered || r->waits) return ETHD_OK;
  r->answered = r->next;
  r->compared++;
  if (is_same(r, &r->tape.rows[r->next - 1], command, &r->share)) return ETHD_OK;
  if (!r->different++) r->first = (double)(r->next - 1);
  return ETHD_OK;
}

/* A recording has no motors. */
static void replay_safe(void *device) ETHD_RT { (void)device; }

/* ---- [main] ---- */

static ethd_status replay_stop(void *device) {
  replay *r = device;
  r->runs = 0;
  return r->different ? ETHD_E_DIFFERS : ETHD_OK;
}

static ethd_limits replay_limits(const void *device) { return ((const replay *)device)->tape.limits; }

static ethd_dynamics replay_dynamics(const void *device) { return ((const replay *)device)->tape.dynamics; }

static uint32_t replay_figures(const void *device, ethd_figure *out, uint32_t max) {
  const replay *r = device;
  const ethd_figure all[] = {{"recorded ticks", "1", (double)r->tape.count},
                             {"replayed ticks", "1", (double)r->next},
                             {"compared commands", "1", (double)r->compared},
                             {"different commands", "1", (double)r->different},
                             {"first difference at tick", "1", r->first}};
  uint32_t n = (uint32_t)(sizeof all / sizeof *all) - (r->different ? 0 : 1);
  if (n > max) n = max;
  memcpy(out, all, n * sizeof *out);
  return n;
}

static const char *replay_remark(const void *device, uint32_t i) {
  const replay *r = device;
  return i == 0 && r->tape.changed < r->tape.count ? r->remark : NULL;
}

const ethd_driver ethd_driver_replay = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "replay",
    .brief = "a recorded session: its samples, and its commands to compare with",
    .keys = keys,
    .open = replay_open,
    .start = replay_start,
    .read = replay_read,
    .write = replay_write,
    .safe = replay_safe,
    .stop = replay_stop,
    .close = replay_close,
    .limits = replay_limits,
    .dynamics = replay_dynamics,
    .figures = replay_figures,
    .remark = replay_remark,
    .prepare = replay_open, /* it touches no device */
};
