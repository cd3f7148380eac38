/* Kinematics of the planar arm, before those of one in space: forward kinematics, Jacobian, J^T f and J^-1 e at 1024 places. */
#include <math.h>
#include <string.h>

#include "bench/bench.h"
#include "bench/peers.h"
#include "cli/cli.h"
#include "ethd/ethd.h"
#include "unit/draw.h"

enum { PLACES = 1024, NUMBERS = 6 };

#define LINK 0.25 /* m */
#define GOAL 14.0

typedef struct workload {
  ethd_arm arm;
  double in[PLACES][NUMBERS], out[PLACES][NUMBERS];
  const ethd__peer_kinematics *peer;
  void *peer_self;
} workload;

/* Makes poses everywhere but near a singularity, where our inverse is damped and others' are not. */
static void make_places(workload *w) {
  for (uint64_t i = 0; i < PLACES; i++) {
    double *in = w->in[i], side = i % 2 ? 1 : -1;
    in[0] = draw(8 * i, -M_PI, M_PI);
    in[1] = side * draw(8 * i + 1, 0.2, M_PI - 0.2);
    for (uint64_t k = 2; k < NUMBERS; k++) in[k] = draw(8 * i + k, -1, 1);
    if (w->arm.mechanism == ETHD_ARM_PARALLEL) in[1] += in[0];
  }
}

/* ---- contenders ---- */

static void finish(const double *in, ethd_vec x, const double j[4], const double j_inv[4], double *out) {
  ethd_vec tau = ethd_mat_mul_transposed(j, (ethd_vec){in[2], in[3]});
  ethd_vec e = ethd_mat_mul(j_inv, (ethd_vec){in[4], in[5]});
  const double all[NUMBERS] = {x.x, x.y, tau.x, tau.y, e.x, e.y};
  memcpy(out, all, sizeof all);
}

static void ours(void *data) {
  workload *w = data;
  ethd_pose pose;
  for (int i = 0; i < PLACES; i++) {
    ethd_arm_pose(&w->arm, w->in[i], &pose);
    finish(w->in[i], pose.x, pose.j, pose.j_inv, w->out[i]);
  }
}

/* Does the same with libm's functions, without damping. */
static void plain(void *data) {
  workload *w = data;
  for (int i = 0; i < PLACES; i++) {
    double a = w->in[i][0], b = w->in[i][0] + w->in[i][1];
    ethd_vec u = {LINK * cos(a), LINK * sin(a)}, v = {LINK * cos(b), LINK * sin(b)};
    double j[4] = {-(u.y + v.y), -v.y, u.x + v.x, v.x}, det = j[0] * j[3] - j[1] * j[2];
    double inverse[4] = {j[3] / det, -j[1] / det, -j[2] / det, j[0] / det};
    finish(w->in[i], ethd_vec_add(u, v), j, inverse, w->out[i]);
  }
}

static void peer(void *data) {
  workload *w = data;
  w->peer->work(w->peer_self, (const double(*)[NUMBERS])w->in, w->out, PLACES);
}

/* ---- error: against the same formulas in long double, each output over its largest value ---- */

static void exact(const workload *w, int i, long double out[NUMBERS]) {
  const double *in = w->in[i];
  int serial = w->arm.mechanism == ETHD_ARM_SERIAL;
  long double a = in[0], b = serial ? a + in[1] : in[1], l = LINK;
  long double ux = l * cosl(a), uy = l * sinl(a), vx = l * cosl(b), vy = l * sinl(b);
  long double j0 = serial ? -(uy + vy) : -uy, j1 = -vy, j2 = serial ? ux + vx : ux, j3 = vx;
  long double det = j0 * j3 - j1 * j2;
  out[0] = ux + vx;
  out[1] = uy + vy;
  out[2] = j0 * in[2] + j2 * in[3];
  out[3] = j1 * in[2] + j3 * in[3];
  out[4] = (j3 * in[4] - j1 * in[5]) / det;
  out[5] = (j0 * in[5] - j2 * in[4]) / det;
}

static double error_of(const workload *w) {
  double worst = 0;
  for (int k = 0; k < NUMBERS; k++) {
    double most = 0, largest = 0;
    for (int i = 0; i < PLACES; i++) {
      long double out[NUMBERS];
      exact(w, i, out);
      most = fmax(most, fabs((double)(w->out[i][k] - out[k])));
      largest = fmax(largest, fabs((double)out[k]));
    }
    worst = fmax(worst, most / largest);
  }
  return worst;
}

static void run(const char *folder, int quick) {
  static workload serial = {.arm = {ETHD_ARM_SERIAL, LINK, LINK}}, parallel = {.arm = {ETHD_ARM_PARALLEL, LINK, LINK}};
  static workload libm, kdl;
  make_places(&serial);
  make_places(&parallel);
  libm = kdl = serial;
  bench_entry entries[] = {{"libethd serial", ours, &serial, PLACES, 0},
                           {"libethd parallel", ours, &parallel, PLACES, 0},
                           {"plain C with libm serial", plain, &libm, PLACES, 0},
                           {NULL, peer, &kdl, PLACES, 0}};
  size_t count = 3;
  printf("kinematics: FK, J, J^T f and J^-1 e of a planar arm; error over the largest value, against "
         "long double\n");
  kdl.peer = bench_peer("kdl", "peer_kinematics");
  if (kdl.peer) {
    kdl.peer_self = kdl.peer->create(LINK, LINK);
    entries[count++].name = kdl.peer->name;
  }
  bench_race(entries, count, quick ? 0.3 : 3);
  FILE *csv = bench_csv(folder, "kinematics",
                        "# planar arm, links 0.25 m: FK, J, J^T f, J^-1 e at 1024 places\n"
                        "# error: the largest over outputs and places, over the output's largest value\n",
                        BENCH_RACE);
  printf("  %-28s %8s %10s %12s\n", "", "ns", "error", "times ours");
  for (size_t i = 0; i < count; i++) {
    double error = error_of(entries[i].data), times = entries[i].ns / entries[0].ns;
    printf("  %-28s %8.1f %10.1e %12.1f\n", entries[i].name, entries[i].ns, error, times);
    bench_row(csv, "error over the largest value", entries[i].name, entries[i].ns, error);
  }
  if (kdl.peer) {
    double times = entries[3].ns / entries[0].ns;
    printf("  goal: KDL takes %.0f times as long: %.1f, %s\n", GOAL, times, bench_verdict(times >= GOAL));
    kdl.peer->destroy(kdl.peer_self);
  }
  bench_close();
  bench_linkage(folder, quick);
  bench_following(folder, quick);
}

const bench bench_kinematics = {"kinematics", run};
