/* The proximity ring's true driver on its true firmware: four boards in simavr behind a pseudo-terminal. They run by
   themselves while the driver opens, then tick by tick on the virtual clock. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sys/prctl.h>
#include <sys/wait.h>

#include "ethd/driver.h"
#include "ethd/fault.h"
#include "unit/rig.h"
#include "unit/ring_scene.h"
#include "unit/suite.h"

#define TICK 1000000
#define VIRTUAL INT64_C(4000000000000000000)

static const ethd_driver *const driver = &ethd_driver_ring;
static char folder[] = "/tmp/ethd-board-XXXXXX", message[ETHD_MESSAGE_MAX];

/* ---- the far end ---- */

typedef struct boards {
  pid_t pid;
  FILE *to, *from;
  ethd__calibration truth;
} boards;

static const char *in_build(const char *name) {
  static char path[4][512];
  static int turn;
  const char *build = getenv("BUILD");
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[turn], "%s/%s", build ? build : "build", name);
  return path[turn];
}

static void boards_start(boards *b, const char *option) {
  int to[2], from[2];
  char link[64], line[256];
  snprintf(link, sizeof link, "%s/port", folder);
  ck_assert(pipe(to) == 0 && pipe(from) == 0);
  b->truth = rod_truth(1);
  b->truth.level = ETHD__LEVEL_LAW;
  b->pid = fork();
  if (b->pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    dup2(to[0], STDIN_FILENO), dup2(from[1], STDOUT_FILENO);
    close(to[1]), close(from[0]);
    execl(in_build("tests/ring_board"), "ring_board", "--baud-matters", "--link", link,
          in_build("firmware/proximity_ring.elf"), option, (char *)NULL);
    _exit(127);
  }
  close(to[0]), close(from[1]);
  b->to = fdopen(to[1], "w"), b->from = fdopen(from[0], "r");
  ck_assert(b->pid > 0 && b->to && b->from);
  ck_assert_msg(fgets(line, sizeof line, b->from) && !strncmp(line, "port ", 5), "no board");
}

static void boards_end(boards *b) {
  int status;
  fclose(b->to);
  kill(b->pid, SIGTERM);
  ck_assert_int_eq(waitpid(b->pid, &status, 0), b->pid);
  ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  fclose(b->from);
}

/* While they step: one line, and its answer awaited. */
static void tell(boards *b, const char *text) {
  char line[256];
  fprintf(b->to, "%s\n", text);
  fflush(b->to);
  do ck_assert_msg(fgets(line, sizeof line, b->from) && strncmp(line, "error", 5), "%s: %s", text, line);
  while (strncmp(line, "ok ", 3));
}

/* What the sensors see of a rod at `centre`; NULL: of nothing. */
static void show(boards *b, const ethd_vec *centre) {
  double d[ETHD_RAYS];
  if (centre) ethd_fit_rays(ROD_RING, ROD_RADIUS, *centre, d);
  for (int k = 0; k < ETHD_RAYS; k++)
    fprintf(b->to, "%.0f ", rod_counts(&b->truth, k, centre ? d[k] : (double)NAN, 0, 0));
  fprintf(b->to, "\n");
  fflush(b->to);
}

/* ---- the driver's end ---- */

typedef struct run {
  boards boards;
  void *device;
  int64_t now_ns, begin_ns;
  ethd_sense sense;
} run;

static ethd_status open_driver(boards *b, const char *baud, void **device) {
  static ethd_setup setup;
  const ethd_setting settings[] = {
      {"port", "port", 1}, {"calibration", "ring.ini", 2}, {"baud", baud, 3}, {"patience", "5", 4}};
  char path[80];
  setup = ethd_setup_default();
  snprintf(path, sizeof path, "%s/ring.ini", folder);
  ck_assert_msg(ethd__calibration_save(&b->truth, path, message) == ETHD_OK, "%s", message);
  const ethd_device_def def = {&setup, settings, 4, folder, "x.ini", 1, NULL};
  ethd_status status = driver->open(&def, device, message);
  if (status && *device) driver->close(*device), *device = NULL;
  return status;
}

static void tick(run *r) {
  char answer[256];
  r->now_ns += TICK;
  fprintf(r->boards.to, "run 0.001\n");
  fflush(r->boards.to);
  do ck_assert_ptr_nonnull(fgets(answer, sizeof answer, r->boards.from));
  while (strncmp(answer, "ok ", 3));
  (void)!driver->service(r->device, 0, r->now_ns); /* fails while it is unplugged */
  r->sense = (ethd_sense){.time_ns = r->now_ns};
  ck_assert_int_eq(driver->read(r->device, r->now_ns, &r->sense), ETHD_OK);
}

/* The finger goes its way from the instant begin_ns on. */
static void finger_tick(run *r) {
  ethd_vec centre = scene_finger(1e-9 * (double)(r->now_ns - r->begin_ns));
  show(&r->boards, &centre);
  ck_assert_ptr_nonnull(fgets((char[256]){0}, 256, r->boards.from)); /* its ok */
  tick(r);
}

static void begin(run *r, const char *option, const char *baud) {
  memset(r, 0, sizeof *r);
  boards_start(&r->boards, option);
  show(&r->boards, NULL);
  ck_assert_msg(open_driver(&r->boards, baud, &r->device) == ETHD_OK, "%s", message);
  tell(&r->boards, "step");
  r->now_ns = VIRTUAL;
  for (int i = 0; i < 50; i++) tick(r);
  r->begin_ns = r->now_ns;
}

static void end(run *r) {
  driver->close(r->device);
  boards_end(&r->boards);
}

static double figure(const run *r, const char *name) {
  ethd_figure figures[ETHD_FIGURES_MAX];
  uint32_t n = driver->figures(r->device, figures, ETHD_FIGURES_MAX);
  for (uint32_t i = 0; i < n; i++)
    if (!strcmp(figures[i].name, name)) return figures[i].value;
  ck_abort_msg("no figure %s", name);
}

/* Distance of the centre that the reading gives from where the finger was at its instant. */
static double error(const run *r) {
  static const double p[ETHD_PARAMS_MAX];
  ethd_fit fit;
  ethd_finger finger;
  ck_assert_int_eq(ethd_fit_prepare(ETHD_FIT_KASA, p, ROD_RING, ROD_RADIUS, &fit, NULL), ETHD_OK);
  if (ethd_fit_step(&fit, r->sense.rays, &finger) != ETHD_OK) return INFINITY;
  ethd_vec e = ethd_vec_sub(finger.centre, scene_finger(1e-9 * (double)(r->sense.sample_ns - r->begin_ns)));
  return sqrt(ethd_vec_dot(e, e));
}

/* Ticks with a moving finger until the row is seen, or not seen any more. */
static int until(run *r, ethd_fault row, bool seen) {
  int ticks = 0;
  do finger_tick(r);
  while (!!(r->sense.faults & ETHD_FAULT_BIT(row)) != seen && ++ticks < 500);
  return ticks;
}

/* ---- tests ---- */

static void follow_finger(const char *option, const char *baud) {
  run r;
  int readings = 0;
  double worst = 0, sum = 0;
  begin(&r, option, baud);
  for (int i = 0; i < 1500; i++) {
    finger_tick(&r);
    if (i < 500 || !(r.sense.have & ETHD_HAVE_RAYS)) continue; /* at first the ring was empty, and its clock is found */
    double e = error(&r);
    worst = fmax(worst, e), sum += e, readings++;
    ck_assert_int_le(r.sense.sample_ns, r.now_ns);
  }
  printf("%s Bd: %d readings in 1 s; finger to %.3f mm in the mean, %.3f at most\n", baud, readings,
         1e3 * sum / readings, 1e3 * worst);
  ck_assert_int_ge(readings, 298);
  ck_assert_int_le(readings, 302);
  ck_assert_double_le(worst, 0.5e-3); /* at up to 0.3 m/s: ticks, skew and what the clock's envelope leaves */
  ck_assert(figure(&r, "ring frames corrupt") == 0 && figure(&r, "ring frames lost") == 0);
  end(&r);
}

TEST(test_finger) { follow_finger(NULL, "500000"); }

TEST(test_finger_slow) { follow_finger("--slow", "400000"); }

TEST(test_speed) {
  boards b;
  void *device;
  boards_start(&b, NULL);
  show(&b, NULL);
  ck_assert_int_eq(open_driver(&b, "400000", &device), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "is its baud rate 400000?") != NULL, "%s", message);
  boards_end(&b);
}

static const struct {
  const char *command, *back;
  ethd_fault row;
  int most; /* ticks until the row is seen */
} faults[] = {
    {"mute 5", "unmute 5", ETHD_FAULT_SENSOR, 30},      {"short 12", "unshort 12", ETHD_FAULT_SENSOR, 30},
    {"scl 2", "unscl 2", ETHD_FAULT_SENSOR, 30},        {"hang 3", NULL, ETHD_FAULT_SENSOR, 30},
    {"corrupt 9", NULL, ETHD_FAULT_FRAME_LOST, 15},     {"lose 20", NULL, ETHD_FAULT_FRAME_LOST, 15},
    {"reset 0", NULL, ETHD_FAULT_BOARD_CLOCK, 30},      {"hang 0", NULL, ETHD_FAULT_FRAME_LOST, 30},
    {"link-short", "link-free", ETHD_FAULT_SENSOR, 30}, {"unplug", "plug", ETHD_FAULT_FRAME_LOST, 15},
};

static void meet_fault(run *r, int i) {
  int64_t rows = 0;
  uint32_t readings = 0;
  tell(&r->boards, faults[i].command);
  int ticks = until(r, faults[i].row, true);
  printf("%-12s row %d seen %d ms after it\n", faults[i].command, (int)faults[i].row, ticks);
  ck_assert_msg(ticks <= faults[i].most, "%s: row %d not seen in %d ms", faults[i].command, (int)faults[i].row, ticks);
  if (faults[i].back) tell(&r->boards, faults[i].back);
  for (int k = 0; k < 300; k++) finger_tick(r);
  for (int k = 0; k < 100; k++) {
    finger_tick(r);
    rows |= r->sense.faults | r->sense.grave;
    if (!(r->sense.have & ETHD_HAVE_RAYS)) continue;
    readings++;
    ck_assert_double_le(error(r), 1e-3);
  }
  ck_assert_msg(rows == 0 && readings >= 29, "%s: rows %#llx, %u readings", faults[i].command, (unsigned long long)rows,
                readings);
}

/* Each is seen as its row, and gone after it. */
TEST(test_faults) {
  run r;
  begin(&r, NULL, "500000");
  for (int i = 0; i < 200; i++) finger_tick(&r);
  ck_assert_int_eq(r.sense.faults | r.sense.grave, 0);
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) meet_fault(&r, (int)i);
  ck_assert(figure(&r, "ring port opened") == 2);
  end(&r);
}

/* ---- files ---- */

static void set_up(void) { ck_assert_ptr_nonnull(mkdtemp(folder)); }

static void tear_down(void) {
  char path[80];
  snprintf(path, sizeof path, "%s/ring.ini", folder);
  unlink(path);
  snprintf(path, sizeof path, "%s/port", folder);
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0);
}

FIXTURE(set_up, tear_down)

int suite_begin(void) {
  if (!access(in_build("tests/ring_board"), X_OK) && !access(in_build("firmware/proximity_ring.elf"), R_OK)) return 0;
  puts("SKIP: simavr's library or avr-gcc, for the ring's firmware, is absent");
  return 77;
}
