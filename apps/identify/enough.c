#include "identify/enough.h"

#include <math.h>

#include "cli/cli.h"
#include "identify/shooting.h"
#include "text/text.h"

#define LEAST_WINDOWS 20
#define LEAST_WAY 20 /* counts, or as many thousandths of a rad of ideal encoders */
#define CLIPPED 0.9

/* Returns the number of windows; *way: rad, total motion of both joints in them. */
static size_t windows_of(const ethd__evidence *e, double *way) {
  size_t windows = 0, whole = (size_t)rint(ETHD__WINDOW / e->period);
  *way = 0;
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    windows += s->count / whole;
    for (size_t k = s->first + 1; k < s->first + s->count; k++)
      for (int j = 0; j < 2; j++) *way += fabs(e->q[k][j] - e->q[k - 1][j]);
  }
  return windows;
}

/* Gives the reason for the few windows. */
static _Noreturn void refuse_few(const ethd__evidence *e, size_t windows) {
  const char *name = e->folders[0];
  if (e->not_numbers > e->count / 2)
    ethd__fail(
        ETHD_EXIT_INPUT,
        "%s: angles or torques of %zu of %zu ticks aren't numbers: find the cause with ethd-conform, and record again",
        name, e->not_numbers, e->count);
  if (e->uneven > e->count / 2)
    ethd__fail(
        ETHD_EXIT_INPUT,
        "%s: %zu of %zu ticks don't come %g s after the one before, which is the period of its configuration: record "
        "again with a loop that keeps its period, as ethd-latency shows",
        name, e->uneven, e->count, e->period);
  ethd__fail(
      ETHD_EXIT_INPUT,
      "%s: %zu window%s of %g s without a stop, a fault or the finger near, at least %d are needed; record more, as "
      "ethd-identify --excite does",
      name, windows, ethd__s(windows), ETHD__WINDOW, LEAST_WINDOWS);
}

void ethd__evidence_enough(const ethd__evidence *e, double count) {
  const char *name = e->folders[0];
  double way;
  size_t windows = windows_of(e, &way);
  if (windows < LEAST_WINDOWS) refuse_few(e, windows);
  if (way < LEAST_WAY * (count > 0 ? count : 1e-3))
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: the arm hardly moves, %.3g rad in all: record one that does, as ethd-identify --excite does", name,
               way);
  if (e->clipped > CLIPPED)
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: the guard cut the torque in %.0f %% of the ticks, so that it hardly changes: record with gains or "
               "excitation below limits.torque, as ethd-identify --excite --share 0.5 does",
               name, 100 * e->clipped);
}
