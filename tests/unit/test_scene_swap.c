/* Scenes of 100 000 segments swapped in the middle of taps: a tick reads a few pages of them, whatever it does, so
   it isn't late; the old scene comes back by an event, isn't read any more, and is freed on [main]. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "unit/rig.h"

#define SEGMENTS 100000
#define PAGES_MAX 24 /* a tick reads at most; the scene has thousands */

/* ---- pages that are one scene's alone, each shut until it is read ---- */

static uintptr_t first, last, page;
static volatile int read_pages;

static void set(const ethd_scene *scene) {
  ethd_scene_info info;
  ethd_scene_describe(scene, &info);
  page = (uintptr_t)sysconf(_SC_PAGESIZE);
  first = ((uintptr_t)scene + page - 1) & ~(page - 1);
  last = ((uintptr_t)scene + info.bytes) & ~(page - 1);
}

static void shut(int how) { ck_assert_int_eq(mprotect((void *)first, last - first, how), 0); }

static void on_read(int number, siginfo_t *info, void *context) {
  uintptr_t at = (uintptr_t)info->si_addr & ~(page - 1);
  (void)context;
  if (at < first || at >= last || mprotect((void *)at, page, PROT_READ) != 0) {
    signal(number, SIG_DFL);
    return;
  }
  read_pages++;
}

static void watch(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_sigaction = on_read;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigaction(SIGSEGV, &action, NULL);
}

/* ---- taps ---- */

/* A wavy outline about the workspace, which meets the wall's place; or as many segments, 4 cm2 to each. */
static ethd_scene *large(int loose) {
  static double p[2 * SEGMENTS + 2], q[SEGMENTS][4];
  static ethd_object_def o[SEGMENTS];
  ethd_scene *scene;
  for (int i = 0; i <= SEGMENTS; i++) {
    double a = 2 * M_PI * (i % SEGMENTS) / SEGMENTS, r = 0.06 + 0.5e-3 * (cos(17 * a) + 1);
    p[2 * i] = 0.298 + r * cos(a);
    p[2 * i + 1] = 0.25 + r * sin(a);
  }
  for (int i = 0; i < SEGMENTS && loose; i++) {
    q[i][0] = 0.02 * (i % 316) - 3, q[i][1] = 0.02 * (i / 316) - 3;
    q[i][2] = q[i][0] + 0.01 * cos(i), q[i][3] = q[i][1] + 0.01 * sin(i);
    o[i] = (ethd_object_def){ETHD_SHAPE_SEGMENT, -1, q[i], 4, 0};
  }
  if (!loose) o[0] = (ethd_object_def){ETHD_SHAPE_POLYLINE, -1, p, 2 * SEGMENTS + 2, 0};
  ethd_scene_def def = {o, loose ? SEGMENTS : 1, NULL, 0};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, NULL), ETHD_OK);
  return scene;
}

static motion tap(int tick) {
  double d = 0.004 * cos(0.02 * tick) + 0.001, v = 0.08 * sin(0.02 * tick);
  motion m = rig_at(d, v, 0.001);
  m.x.y = m.xf.y = 0.25 + 0.01 * sin(0.005 * tick);
  return m;
}

TEST_LOOP(test_swapped_in_a_tap, 0, 2) {
  rig r;
  int swaps = 0, touched = 0, most = 0;
  rig_begin(&r, RIG_WALL, NULL);
  ethd_scene *held = NULL; /* the large one that rules or is about to */
  ethd_scene *given_back = NULL;
  watch();
  for (int tick = 0; tick < 3000; tick++) {
    if (tick % 150 == 149) {
      int to_large = held == NULL;
      if (to_large) set(held = large(_i));
      r.setup.scene = to_large ? held : r.scene;
      rig_post(&r);
      if (!to_large) given_back = held, held = NULL;
    }
    int watched = (held || given_back) && (tick % 150 == 149 || tick % 150 < 2 || tick % 50 == 20);
    if (watched) shut(PROT_NONE);
    read_pages = 0;
    motion m = tap(tick);
    rig_step(&r, &m);
    int pages = read_pages;
    touched += r.trace.contacts > 0 && held != NULL;
    if (pages > most) most = pages;
    ck_assert_msg(pages <= PAGES_MAX, "tick %d reads %d pages of %zu", tick, pages, (size_t)((last - first) / page));
    if (watched) shut(PROT_READ | PROT_WRITE);
    if (given_back && !r.trace.swap) { /* one tick later nothing has read it */
      ck_assert_int_eq(pages, 0);
      ethd_scene_destroy(given_back);
      given_back = NULL;
    }
    for (ethd_event e; (e = rig_poll(&r)).kind != 0;) {
      ck_assert_int_eq(e.kind, ETHD_EVENT_TAKEN);
      ck_assert(e.scene == (held ? r.scene : given_back) && e.tick == r.trace.tick);
      swaps++;
    }
  }
  ck_assert_int_eq(swaps, 20);
  ck_assert_int_gt(touched, 300);
  ck_assert_int_gt(most, 0);
  ck_assert_int_gt((int)((last - first) / page), 1000);
  printf("%s: at most %d of %d pages read in a tick\n", _i ? "segments" : "outline", most,
         (int)((last - first) / page));
  rig_close(&r);
  ethd_scene_destroy(held);
}
