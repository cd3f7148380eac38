#include "calibrate/guided.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "proximity_ring/empty.h"
#include "proximity_ring/port.h"
#include "text/error_text.h"
#include "text/text.h"

#define WAIT_MS 20
#define SILENCE 100 /* waits without a frame until the line counts as silent */
#define TRIES 5
#define SPREAD 0.01 /* of the counts, sd: if it is more, the rod moves */
#define SPREAD_LEAST 40

typedef struct guided {
  const ethd__guided_options *o;
  ethd__ring_port port;
  ethd__decoder decoder;
  ethd__places *places;
  char *message;
} guided;

/* ---- counts ---- */

typedef struct sums {
  double n[ETHD_RAYS], s[ETHD_RAYS], ss[ETHD_RAYS];
  int frames;
} sums;

static void add(sums *to, const ethd__ring_frame *f) {
  to->frames++;
  for (int k = 0; k < ETHD_RAYS; k++) {
    double c = f->counts[k];
    if (f->counts[k] == ETHD__FRAME_MISSING) continue;
    to->n[k]++;
    to->s[k] += c;
    to->ss[k] += c * c;
  }
}

/* Drops the old frames from before a step. */
static void forget(guided *g) {
  uint8_t bytes[4096];
  while (ethd__ring_port_read(&g->port, 0, bytes, sizeof bytes) > 0) {
  }
  ethd__decoder_restart(&g->decoder);
}

static ethd_status collect(guided *g, sums *out) {
  uint8_t bytes[4096];
  int silent = 0;
  memset(out, 0, sizeof *out);
  forget(g);
  while (out->frames < g->o->frames && !ethd__stop) {
    int64_t got = ethd__ring_port_read(&g->port, WAIT_MS, bytes, sizeof bytes);
    int before = out->frames;
    const uint8_t *at = bytes;
    ethd__ring_frame f;
    if (got < 0) return ethd__say(g->message, ETHD_E_DEVICE, "%s: the line is gone", g->o->port);
    while (ethd__decoder_next(&g->decoder, &at, bytes + got, &f)) add(out, &f);
    silent = out->frames > before ? 0 : silent + 1;
    if (silent == SILENCE)
      return ethd__say(g->message, ETHD_E_DEVICE, "%s: no frames: is the ring powered, is %u its baud?", g->o->port,
                       g->o->baud);
    ethd__progress((uint64_t)out->frames, (uint64_t)g->o->frames, "frames");
  }
  ethd__progress(1, 1, "");
  return ETHD_OK;
}

/* Computes the means; returns the sensor whose counts exceed the allowed spread most, or -1. */
static int means(const sums *of, double counts[ETHD_RAYS]) {
  int moved = -1;
  double worst = 1;
  for (int k = 0; k < ETHD_RAYS; k++) {
    double mean = of->n[k] ? of->s[k] / of->n[k] : 0,
           sd = of->n[k] ? sqrt(fmax(0, of->ss[k] / of->n[k] - mean * mean)) : 0;
    double share = sd / fmax(SPREAD * mean, SPREAD_LEAST);
    counts[k] = 2 * of->n[k] >= of->frames ? mean : 0;
    if (share > worst) worst = share, moved = k;
  }
  return moved;
}

static ethd_status measure(guided *g, double counts[ETHD_RAYS]) {
  sums of;
  for (int i = 0; i < TRIES; i++) {
    ethd_status status = collect(g, &of);
    if (status) return status;
    int moved = means(&of, counts);
    if (moved < 0) return ETHD_OK;
    printf("  sensor %d isn't steady: measured again\n", moved);
    fflush(stdout);
  }
  printf("  not steady; used nevertheless\n");
  return ETHD_OK;
}

/* ---- steps ---- */

/* Asks, and returns the first letter of the answer, '\n' for Enter alone, 0 at the end of the input. */
static char ask(const char *what) {
  char line[64];
  printf("%s\n  Enter measures, s skips, b goes back, q ends: ", what);
  fflush(stdout);
  if (!fgets(line, sizeof line, stdin) || ethd__stop) return 0;
  return line[0];
}

static ethd_status ended(const guided *g) {
  return ethd__say(
      g->message, ETHD_E_ARGUMENT, "ended after %zu place%s; %s", g->places->count, ethd__s(g->places->count),
      g->o->record ? "they are kept: --in goes on with them" : "nothing was kept: use --record to keep the counts");
}

static ethd_status keep(const guided *g) {
  return g->o->record ? ethd__places_save(g->places, g->o->record, g->message) : ETHD_OK;
}

static ethd_status empty_ring(guided *g) {
  ethd__empty empty = {.frames = 1};
  ethd__calibration c = ethd__calibration_default();
  char answer = ask("\nThe empty ring: take everything out of it.");
  if (answer != '\n') return ended(g);
  ethd_status status = measure(g, g->places->dark);
  for (int k = 0; k < ETHD_RAYS; k++) {
    empty.seen[k] = g->places->dark[k] > 0 && g->places->dark[k] < ETHD__FRAME_SATURATED;
    empty.sum[k] = g->places->dark[k];
  }
  if (!status) status = ethd__empty_check(&empty, g->o->ring_radius, &c, g->message);
  for (int k = 0; k < ETHD_RAYS; k++) g->places->dark[k] = c.sensors[k].dark;
  return status;
}

static void describe(int i, double rod, char text[160]) {
  if (i == 0)
    snprintf(text, 160, "\nThe middle: the rod (%.1f mm across) in its sleeve, concentric with the ring.", 2e3 * rod);
  else
    snprintf(text, 160, "\nSensor %d: the rod pressed against the ring right at sensor %d (%.1f degrees).", i - 1,
             i - 1, 22.5 * (i - 1));
}

static ethd_status rod_places(guided *g) {
  char text[160];
  double counts[ETHD_RAYS];
  bool taken[ETHD__PLACES_GUIDED] = {false};
  for (int i = 0; i < ETHD__PLACES_GUIDED; i++) {
    describe(i, g->o->rod, text);
    char answer = ask(text);
    if (!answer || answer == 'q') return ended(g);
    if (answer == 's') continue;
    if (answer == 'b') {
      i = i ? i - 1 : 0;
      g->places->count -= taken[i];
      taken[i] = false;
      i--;
      continue;
    }
    ethd_status status = measure(g, counts);
    if (status) return status;
    taken[i] = ethd__places_add(g->places, ethd__place_at(g->o->ring_radius, g->o->rod, i), counts);
    if ((status = keep(g)) != ETHD_OK) return status;
  }
  return ETHD_OK;
}

ethd_status ethd__guided_run(const ethd__guided_options *o, ethd__places *out, char message[ETHD_MESSAGE_MAX]) {
  guided g = {.o = o, .port = {.path = (char *)o->port, .baud = o->baud, .fd = -1}, .places = out, .message = message};
  memset(out, 0, sizeof *out);
  out->ring_radius = o->ring_radius;
  out->rod = o->rod;
  ethd_status status = ethd__ring_port_open(&g.port, 0, message);
  if (!status) status = empty_ring(&g);
  if (!status) status = rod_places(&g);
  ethd__ring_port_close(&g.port);
  return status;
}
