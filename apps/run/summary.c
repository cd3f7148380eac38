#include "run/summary.h"

#include <inttypes.h>
#include <string.h>

#include "cli/dropped.h"
#include "text/text.h"

void ethd__durations_print(FILE *out, const char *name, const ethd_histogram *h) {
  fprintf(out, "%-10s p50 %9.3f  p99 %9.3f  p99.9 %9.3f  max %9.3f us\n", name,
          1e-3 * (double)ethd_histogram_at(h, 0.5), 1e-3 * (double)ethd_histogram_at(h, 0.99),
          1e-3 * (double)ethd_histogram_at(h, 0.999), 1e-3 * (double)h->max);
}

void ethd__shortfalls_print(FILE *out, int32_t bits) {
  for (int i = 0; i < ETHD_SHORT_COUNT; i++)
    if (bits & 1 << i)
      fprintf(out, "not realtime: %s\n        mend: %s\n", ethd_shortfall_sentence(1 << i),
              ethd_shortfall_mend(1 << i));
}

/* A remark about something missing names its step of "From the box to the first touch", as "(step 3)" or "; step 3)".
   Returns the step's number; 0: the remark names none. */
static int step_of(const char *remark) {
  const char *at = strstr(remark, "step ");
  int step = 0;
  return at && sscanf(at, "step %d)", &step) == 1 ? step : 0;
}

static void tell(FILE *out, const char *remark, int *next) {
  int step = step_of(remark);
  fprintf(out, "device: %s\n", remark);
  if (step && (!*next || step < *next)) *next = step;
}

#define RIGHTS (ETHD_SHORT_FIFO | ETHD_SHORT_MLOCK | ETHD_SHORT_IO)

void ethd__remarks_print(FILE *out, ethd__session *s) {
  const char *remark;
  int32_t shortfalls = s->is_virtual ? 0 : ethd_loop_shortfalls(s->loop);
  int next = 0;
  for (uint32_t i = 0; (remark = ethd_device_remark(s->device, i)) != NULL; i++) tell(out, remark, &next);
  if (!s->is_virtual && !ethd__session_sees_finger(s)) tell(out, s->front->unseen, &next);
  ethd__shortfalls_print(out, shortfalls);
  if (next && shortfalls & RIGHTS) next = 1;
  if (next)
    fprintf(out, "next: step %d of \"From the box to the first touch\" in drivers/README.md, as said above\n", next);
}

static void print_fault(FILE *out, int fault, uint64_t n, int *none) {
  if (!n) return;
  fprintf(out, "%-10s %" PRIu64 " x %s\n", *none ? "faults" : "", n, ethd_fault_sentence((ethd_fault)fault));
  *none = 0;
}

/* Faults that stopped the ring come first. The stop at the end uses a speed limit of 0; its fault isn't counted. */
static void print_faults(FILE *out, const ethd__recorder *r, const ethd_loop_stats *stats) {
  int none = 1;
  for (int i = 0; i < ETHD_FAULT_COUNT; i++) print_fault(out, i, r->faults[i], &none);
  for (int i = 0; i < ETHD_FAULT_COUNT; i++)
    if (!r->faults[i] && i != ETHD_FAULT_SPEED) print_fault(out, i, stats->faults[i], &none);
  if (none) fprintf(out, "%-10s none\n", "faults");
}

/* The counters are the controller's; they begin at zero when the device is enabled. */
static void print_skipped(FILE *out, const ethd__session *s, const ethd_loop_stats *stats) {
  ethd_counters c;
  s->controller->counters(s->control, &c);
  fprintf(out,
          "%-10s %" PRIu64 " reading%s dropped, %" PRIu64 " contact%s without room, %" PRIu64
          " tick%s without room in the recorder\n",
          "skipped", c.readings_dropped, ethd__s(c.readings_dropped), c.contacts_lost, ethd__s(c.contacts_lost),
          stats->rows_lost, ethd__s(stats->rows_lost));
  const ethd_config *config = s->config;
  if (!config->scene && !config->solids)
    fprintf(out, "%-10s none: there is no wall; [scene] file = ... has one\n", "scene");
  if (!config->scene) return;
  fprintf(out, "%-10s queried in %" PRIu64 " of %" PRIu64 " tick%s", "scene", c.queried, c.ticks, ethd__s(c.ticks));
  ethd__dropped_print(out, config->scene);
  fputc('\n', out);
}

static void print_device(FILE *out, const ethd_loop_stats *stats) {
  if (stats->read_failures || stats->write_failures || stats->service_failures)
    fprintf(out, "%-10s failed %" PRIu64 " read%s, %" PRIu64 " write%s, %" PRIu64 " of its own\n", "device",
            stats->read_failures, ethd__s(stats->read_failures), stats->write_failures, ethd__s(stats->write_failures),
            stats->service_failures);
  if (stats->relaxes)
    fprintf(out, "%-10s %" PRIu64 " switch%s to secondary mode\n", "relaxes", stats->relaxes,
            stats->relaxes == 1 ? "" : "es");
}

/* Prints the device's own figures, durations in ms. */
static void print_figures(FILE *out, const ethd__session *s) {
  static ethd_figure figures[ETHD_FIGURES_MAX];
  uint32_t n = ethd_device_figures(s->device, figures, ETHD_FIGURES_MAX);
  for (uint32_t i = 0; i < n; i++) {
    bool is_time = !strcmp(figures[i].unit, "s");
    const char *unit = is_time ? "ms" : strcmp(figures[i].unit, "1") ? figures[i].unit : "";
    fprintf(out, "%-10s %-32s %10.6g %s\n", i ? "" : "figures", figures[i].name, figures[i].value * (is_time ? 1e3 : 1),
            unit);
  }
}

static void print_snapshot(FILE *out, const ethd__snapshot *s) {
  if (s->message[0]) fprintf(out, "%-10s not written: %s\n", "snapshot", s->message);
  if (s->written)
    fprintf(out, "%-10s %s: %zu tick%s around the first fault, %s\n", "snapshot", s->path, s->written,
            ethd__s(s->written), ethd_fault_sentence(s->fault));
}

/* ---- the manual's page ---- */

static const char *word(ethd_reaction reaction) {
  static const char *const words[] = {"", "count", "degrade", "stop", "zero", "refuse"};
  return words[reaction];
}

void ethd__faults_print(FILE *out) {
  fprintf(out,
          "Faults, the time until each is noticed, and its first and its grave reaction.\ncount: the fault is only "
          "counted. degrade: the ring goes on without the failed part.\nstop: the ring is braked until it stands, then "
          "as zero. zero: no torque, the device is disabled, and the\nfault is latched until it is acknowledged. "
          "refuse: nothing moves.\n\n"
          "row  %-20s%-9s%-9s%s\n",
          "noticed within", "at first", "at worst", "what");
  for (int i = 1; i < ETHD_FAULT_COUNT; i++)
    fprintf(out, "%3d  %-20s%-9s%-9s%s\n", i, ethd_fault_bound((ethd_fault)i),
            word(ethd_fault_reaction((ethd_fault)i, 0)), word(ethd_fault_reaction((ethd_fault)i, 1)),
            ethd_fault_sentence((ethd_fault)i));
}

static void print_recorded(FILE *out, const char *record, const ethd__recorder *r) {
  if (r->kept == r->written)
    fprintf(out, "%-10s %s: %" PRIu64 " tick%s\n", "recorded", record, r->written, ethd__s(r->written));
  else
    fprintf(out, "%-10s %s: %" PRIu64 " of %" PRIu64 " tick%s, %" PRIu64 " %s lost\n", "recorded", record, r->kept,
            r->written, ethd__s(r->written), r->written - r->kept, r->written - r->kept == 1 ? "is" : "are");
}

void ethd__summary_print(FILE *out, const ethd__session *s, const char *record) {
  static ethd_loop_stats stats;
  ethd_loop_read(s->loop, &stats);
  fprintf(out, "%-10s %" PRIu64 " of %g s\n", "ticks", stats.ticks, s->period);
  fprintf(out, "%-10s %" PRIu64 ", %" PRIu64 " period%s missed\n", "overruns", stats.overruns, stats.missed,
          ethd__s(stats.missed));
  if (s->is_virtual) {
    fprintf(out, "%-10s virtual: nothing ran in real time\n", "clock");
  } else {
    ethd__durations_print(out, "wake-up", &stats.wake);
    ethd__durations_print(out, "tick", &stats.tick);
  }
  print_faults(out, &s->recorder, &stats);
  print_device(out, &stats);
  print_skipped(out, s, &stats);
  print_figures(out, s);
  if (!atomic_load(&s->recorder.sees_finger))
    fprintf(out, "%-10s never measured: the ring didn't follow a finger\n", "finger");
  if (record) print_recorded(out, record, &s->recorder);
  print_snapshot(out, &s->recorder.snapshot);
  if (!s->is_virtual && !ethd_loop_shortfalls(s->loop)) fprintf(out, "%-10s none\n", "shortfalls");
  if (!s->is_virtual) ethd__shortfalls_print(out, ethd_loop_shortfalls(s->loop));
}
