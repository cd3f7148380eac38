/* How late the loop wakes and how long its ticks take, beside cyclictest on the same machine. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "run/session.h"
#include "run/summary.h"
#include "text/csv.h"
#include "text/text.h"

#define DURATION 10.0 /* s */

static const char doc[] = "Runs the loop with a device (default: the simulated one), and prints how late it woke and "
                          "how long its ticks took. Then it runs cyclictest, if installed, for the same time, at the "
                          "same period and priority, and with the same DMA latency (none without --dma-latency). The "
                          "figures are valid for this machine and its load during the run.\v"
                          "Examples:\n"
                          "  ethd-latency --duration 60 --csv latency.csv\n"
                          "  gnuplot -e \"in='latency.csv'; out='latency.png'\" latency.gp";

enum { OPTION_CSV = 256, OPTION_CPU, OPTION_PRIORITY, OPTION_EARLY, OPTION_DMA, OPTION_ALONE };

static const struct argp_option options[] = {
    {"config", 'c', "C.ini", 0, "configuration (default: the simulated device)", 0},
    {"duration", 'd', "S", 0, "duration of the run, s (10)", 0},
    {"csv", OPTION_CSV, "OUT.csv", 0, "write the histograms, a row for each bin", 0},
    {"cpu", OPTION_CPU, "N", 0, "processor of the loop", 0},
    {"priority", OPTION_PRIORITY, "N", 0, "SCHED_FIFO priority of the loop (80)", 0},
    {"early-wake", OPTION_EARLY, "US", 0,
     "wake this many microseconds early, warm the caches and spin until the tick (0)", 0},
    {"dma-latency", OPTION_DMA, "US", 0, "hold /dev/cpu_dma_latency at this value, microseconds", 0},
    {"alone", OPTION_ALONE, NULL, 0, "don't run cyclictest", 0},
    {0},
};

static struct {
  ethd__session_options session;
  const char *csv;
  double duration;
  bool alone;
} arg = {.duration = DURATION};

static error_t parse(int key, char *text, struct argp_state *state) {
  ethd_loop_def *loop = &arg.session.loop;
  switch (key) {
  case 'c': arg.session.config = text; return 0;
  case 'd': arg.duration = ethd__option_number("--duration", text, 0.01, 1e6); return 0;
  case OPTION_CSV: arg.csv = text; return 0;
  case OPTION_CPU: loop->cpu = (int32_t)ethd__option_integer("--cpu", text, 0, 1023); return 0;
  case OPTION_PRIORITY: loop->priority = (int32_t)ethd__option_integer("--priority", text, 1, 99); return 0;
  case OPTION_EARLY: loop->early_wake = 1e-6 * ethd__option_number("--early-wake", text, 0, 1e5); return 0;
  case OPTION_DMA: loop->dma_latency = (int32_t)ethd__option_integer("--dma-latency", text, 0, 1000000); return 0;
  case OPTION_ALONE: arg.alone = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- cyclictest ---- */

/* Its process, then its histogram's rows: microseconds and a count. */
static void read_cyclictest(FILE *pipe, ethd_histogram *out) {
  char line[256];
  int process = fgets(line, sizeof line, pipe) ? atoi(line) : 0;
  while (fgets(line, sizeof line, pipe)) {
    long us, count;
    char after;
    if (sscanf(line, "%ld %ld %c", &us, &count, &after) != 2) continue;
    for (long i = 0; i < count; i++) ethd_histogram_add(out, us * 1000);
  }
  if (ethd__stop && process > 1) kill(process, SIGTERM); /* it would be waited for */
}

static bool run_cyclictest(double period, ethd_histogram *out) {
  char command[256];
  const ethd_loop_def *loop = &arg.session.loop;
  int n = snprintf(command, sizeof command, "echo $$; exec cyclictest -q -m -t 1 -p %d -i %ld -l %ld -h 20000",
                   loop->priority, (long)(1e6 * period), (long)(arg.duration / period));
  /* it would hold the DMA latency at 0 by itself, which keeps processors awake: fair is what the loop has */
  if (loop->dma_latency >= 0)
    n += snprintf(command + n, sizeof command - (size_t)n, " --latency=%d", loop->dma_latency);
  else
    n += snprintf(command + n, sizeof command - (size_t)n, " --laptop");
  if (loop->cpu >= 0) snprintf(command + n, sizeof command - (size_t)n, " -a %d", loop->cpu);
  strcat(command, " 2>/dev/null");
  FILE *pipe = popen(command, "r");
  if (!pipe) return false;
  read_cyclictest(pipe, out);
  return pclose(pipe) == 0 && out->count > 0;
}

/* ---- out ---- */

static void write_row(ethd_csv_out *out, uint32_t bin, const ethd_loop_stats *s, const ethd_histogram *peer) {
  ethd_csv_number(out, 1e-9 * (double)ethd_histogram_first(bin));
  ethd_csv_number(out, 1e-9 * (double)(ethd_histogram_last(bin) + 1));
  ethd_csv_integer(out, (int64_t)s->wake.counts[bin]);
  ethd_csv_integer(out, (int64_t)s->tick.counts[bin]);
  if (peer) ethd_csv_integer(out, (int64_t)peer->counts[bin]);
  ethd_csv_row(out);
}

static void write_csv(const ethd_loop_stats *s, const ethd_histogram *peer) {
  char message[ETHD_MESSAGE_MAX];
  ethd_csv_out *out =
      ethd_csv_create(arg.csv, peer ? "from_s,to_s,wake,tick,cyclictest" : "from_s,to_s,wake,tick", message);
  if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  for (uint32_t bin = 0; bin + 1 < ETHD_BINS; bin++)
    if (s->wake.counts[bin] || s->tick.counts[bin] || (peer && peer->counts[bin])) write_row(out, bin, s, peer);
  ethd__must(ethd_csv_close(out, message), message);
}

static void measure(ethd_loop_stats *out, int32_t *shortfalls, double *period) {
  static ethd__session session;
  char message[ETHD_MESSAGE_MAX];
  ethd__need(ethd__session_open(&arg.session, &session, message), message);
  while (!ethd__stop && !ethd_loop_ended(session.loop) && ethd__session_time(&session) < arg.duration) {
    ethd__progress((uint64_t)(1e3 * ethd__session_time(&session)), (uint64_t)(1e3 * arg.duration), "loop");
    usleep(10000);
    ethd__session_poll(&session);
  }
  ethd__progress(1, 1, "");
  ethd_loop_read(session.loop, out);
  *shortfalls = ethd_loop_shortfalls(session.loop);
  *period = session.period;
  ethd__session_halt(&session, ethd__stop);
  ethd_status status = ethd__session_end(&session, message);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  ethd__session_free(&session);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  static ethd_loop_stats stats;
  static ethd_histogram cyclictest;
  int32_t shortfalls;
  double period;
  arg.session.loop = ethd_loop_default();
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__container_keeper();
  ethd__hold_device();
  measure(&stats, &shortfalls, &period);
  bool peer = !arg.alone && !ethd__stop && run_cyclictest(period, &cyclictest);
  printf("%-10s %llu of %g s, %llu overrun%s, %llu period%s missed\n", "ticks", (unsigned long long)stats.ticks, period,
         (unsigned long long)stats.overruns, ethd__s(stats.overruns), (unsigned long long)stats.missed,
         ethd__s(stats.missed));
  ethd__durations_print(stdout, "wake-up", &stats.wake);
  ethd__durations_print(stdout, "tick", &stats.tick);
  if (peer)
    ethd__durations_print(stdout, "cyclictest", &cyclictest);
  else if (!arg.alone)
    printf("%-10s skipped: not installed (Debian: rt-tests), or not permitted\n", "cyclictest");
  if (!shortfalls) printf("%-10s none\n", "shortfalls");
  ethd__shortfalls_print(stdout, shortfalls);
  if (arg.csv) write_csv(&stats, peer ? &cyclictest : NULL);
  return ethd__end(ETHD_EXIT_DONE);
}
