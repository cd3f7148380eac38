/* day FOLDER HOURS [MINUTES]: hours of simulated operation under one process, on the virtual clock: sessions of ten
   minutes with their recordings (the last two are kept); a swap or a new gain every 0.7 s, faults by a script that
   is another one in each session, acknowledged and enabled again. Nothing may be lost: rows, ticks of the file, faults
   told; every eighth recording is replayed to the bit; memory stays what it was after the second session. For MINUTES
   of the day at most; run again, it goes on at the next session (FOLDER/state). One line a session. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "ethd/record.h"
#include "run/session.h"
#include "unit/draw.h"

#define SESSION 600.0 /* s */
#define PACE 0.7      /* s from command to command */
#define VERIFIED 8    /* sessions */

typedef struct day {
  const char *folder;
  uint64_t session, ticks, faults, swaps; /* so far, all processes */
  double spent;                           /* s */
  long resident;                          /* pages, after the second session of this process */
} day;

static char message[ETHD_MESSAGE_MAX];

static int fail(const day *d, const char *what) {
  fprintf(stderr, "session %" PRIu64 ": %s %s\n", d->session, what, message);
  return 1;
}

static long resident(void) {
  long size = 0, pages = 0;
  FILE *f = fopen("/proc/self/statm", "r");
  if (f && fscanf(f, "%ld %ld", &size, &pages) != 2) pages = 0;
  if (f) fclose(f);
  return pages;
}

static FILE *open_in(const day *d, const char *name, const char *mode, char path[512]) {
  snprintf(path, 512, "%s/%s", d->folder, name);
  return fopen(path, mode);
}

/* Faults of every kind a script knows, one about every 20 s. */
static int write_files(const day *d, double seconds, char config[512]) {
  static const char *const kinds[] = {
      "q1 nan",           "reading drop for=0.3",         "write fail for=0.02", "fault9 set", "read fail for=0.01",
      "q2 offset by=0.3", "centre noise by=0.0002 for=1", "q freeze for=0.2"};
  char path[512];
  FILE *script = open_in(d, "day.inject", "w", path), *wall = open_in(d, "day.scene", "w", path),
       *ini = open_in(d, "day.ini", "w", config);
  if (!script || !wall || !ini) return 1;
  for (uint64_t i = 0; 20.0 * (double)i + 2 < seconds; i++)
    fprintf(script, "%.3f %s\n", 20.0 * (double)i + draw(1000 * d->session + i, 1, 19),
            kinds[draw_bits(7 * d->session + i) % 8]);
  fputs("halfplane -1 0 -0.238\ncircle 0.24 0.3 0.02\npolyline 0.22 0.2 0.24 0.22 0.22 0.24\n", wall);
  fputs("[device]\ndriver = sim\nplant = n\ninject = day.inject\n[scene]\nfile = day.scene\n[limits]\ntorque = 1.25\n"
        "finger_age = 0.05\nspeed = 5\nstop_time = 1\n",
        ini);
  return fclose(script) | fclose(wall) | fclose(ini);
}

static int swap(day *d, ethd__session *s, uint64_t i) {
  static const ethd_transition_law *const laws[] = {&ethd_transition_smooth, &ethd_transition_offset,
                                                    &ethd_transition_abrupt, &ethd_transition_predictive};
  uint64_t r = draw_bits(i ^ d->session << 32);
  ethd__setup_copy setup = s->setup;
  char detail[64];
  const ethd_transition_law *law = laws[r % 4];
  double k = 500 + (double)(r >> 8 & 2047);
  if (r >> 40 & 1) {
    ethd_setup_transition(&setup.plane, law);
    snprintf(detail, sizeof detail, "%s", law->law.id);
  } else {
    if (ethd_setup_set(&setup.plane, "contact.k_e", k, NULL)) return 1;
    snprintf(detail, sizeof detail, "contact.k_e %.17g", k);
  }
  d->swaps++;
  return ethd__session_post(s, &setup, r >> 40 & 1 ? "transition" : "set", detail, message) != ETHD_OK;
}

static void recover(ethd__session *s) {
  if (ethd__recorder_fault(&s->recorder)) ethd_loop_acknowledge(s->loop);
  ethd__session_tick(s);
  ethd__session_tick(s);
  if (!ethd_loop_armed(s->loop)) (void)!ethd__session_enable(s);
}

static int run(day *d, double seconds, const char *recording) {
  static ethd__session s;
  char config[512];
  if (write_files(d, seconds, config)) return fail(d, "its files can't be written");
  ethd__session_options o = {.config = config, .record = recording, .replace = true, .is_virtual = true};
  o.loop = ethd_loop_default();
  if (ethd__session_open(&o, &s, message)) return fail(d, "not opened:");
  double due = PACE;
  for (uint64_t i = 0; ethd__session_time(&s) < seconds;) {
    ethd__session_tick(&s);
    if (ethd__session_time(&s) < due) continue;
    due += PACE;
    if (ethd_loop_armed(s.loop) ? swap(d, &s, i++) : (recover(&s), 0)) return fail(d, "not posted:");
  }
  ethd__session_halt(&s, false);
  ethd_loop_stats stats;
  ethd_status status = ethd__session_end(&s, message);
  ethd_loop_read(s.loop, &stats);
  const ethd__recorder *r = &s.recorder;
  bool whole = !r->failed && !r->lost && !stats.rows_lost && r->rows == stats.ticks && r->kept == r->rows;
  for (int row = 1; row < ETHD_FAULT_COUNT; row++) d->faults += stats.faults[row];
  d->ticks += stats.ticks;
  ethd__session_free(&s);
  if (status) return fail(d, "ended:");
  return whole ? 0 : fail(d, "rows are lost");
}

static void forget(const char *recording) {
  char command[600]; /* a name of our own making */
  snprintf(command, sizeof command, "rm -rf '%s'", recording);
  if (system(command)) perror(recording);
}

static int session(day *d, double seconds) {
  char path[512], old[512];
  snprintf(path, sizeof path, "%s/%" PRIu64, d->folder, d->session);
  snprintf(old, sizeof old, "%s/%" PRIu64, d->folder, d->session - 2);
  if (run(d, seconds, path)) return 1;
  if (d->session % VERIFIED == 0 && ethd_recording_verify(path, false, NULL, message)) return fail(d, "not equal:");
  if (d->session > 1) forget(old);
  return 0;
}

static int keep_state(const day *d) {
  char path[512], kept[512];
  FILE *f = open_in(d, "state.new", "w", path);
  snprintf(kept, sizeof kept, "%s/state", d->folder);
  if (!f) return 1;
  fprintf(f, "%" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %.1f\n", d->session, d->ticks, d->faults, d->swaps,
          d->spent);
  return fclose(f) || rename(path, kept);
}

int main(int argc, char **argv) {
  day d = {.folder = argc > 2 ? argv[1] : ""};
  double hours = argc > 2 ? atof(argv[2]) : 0, most = argc > 3 ? 60 * atof(argv[3]) : INFINITY,
         began = 1e-9 * (double)ethd__clock_now();
  if (!(hours > 0) || strchr(d.folder, '\'')) return fprintf(stderr, "day FOLDER HOURS [MINUTES]\n"), 2;
  char path[512];
  mkdir(d.folder, 0777);
  FILE *state = open_in(&d, "state", "r", path);
  if (state && fscanf(state, "%" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %lf", &d.session, &d.ticks, &d.faults,
                      &d.swaps, &d.spent) != 5)
    return fprintf(stderr, "%s: not a state\n", path), 1;
  if (state) fclose(state);
  for (int here = 0; (double)d.session * SESSION < hours * 3600 && 1e-9 * (double)ethd__clock_now() - began < most;
       here++) {
    double start = 1e-9 * (double)ethd__clock_now();
    if (session(&d, fmin(SESSION, hours * 3600 - (double)d.session * SESSION))) return 1;
    d.session++;
    d.spent += 1e-9 * (double)ethd__clock_now() - start;
    if (keep_state(&d)) return fail(&d, "the state can't be kept");
    if (here == 1) d.resident = resident();
    if (here > 1 && resident() > d.resident + 512) return fail(&d, "memory grows");
    double done = (double)d.session * SESSION / 3600;
    printf("%.2f of %g h: %" PRIu64 " ticks, %" PRIu64 " faults, %" PRIu64 " swaps, %ld MB, %.0f s; %.0f s are left\n",
           fmin(done, hours), hours, d.ticks, d.faults, d.swaps, resident() * 4 / 1024, d.spent,
           d.spent * fmax(hours / done - 1, 0));
    fflush(stdout);
  }
  return d.faults && d.swaps ? 0 : fail(&d, "nothing happened");
}
