/* The simulated plant of an arm in space: joints that follow commanded speeds by a second order, and where the tool is, at 1024
   periods of 2 ms. MuJoCo does the same with unit masses behind its first-order activation, in steps. */
#include <math.h>
#include <string.h>

#include "arm/servo.h"
#include "bench/bench.h"
#include "bench/peers.h"
#include "unit/draw.h"

enum { PERIODS = 1024, JOINTS = ETHD__PEER_JOINTS, NUMBERS = ETHD__PEER_FOLLOWING };

#define PERIOD 0.002    /* s */
#define FREQUENCY 150.0 /* rad/s */

typedef struct workload {
  double in[PERIODS][JOINTS], out[PERIODS][NUMBERS];
  ethd__arm_table table;
  const ethd__peer_following *peer;
  void *peer_self;
} workload;

static void ours(void *data) {
  workload *w = data;
  const double zero[JOINTS] = {0};
  ethd__arm_servo servo;
  ethd__tool tool;
  ethd__arm_servo_start(&w->table, zero, &servo);
  for (int i = 0; i < PERIODS; i++) {
    ethd__arm_servo_step(&servo, w->in[i]);
    for (int k = 0; k < JOINTS; k++) w->out[i][k] = servo.joint[k].q;
    ethd__linkage_place(&w->table.linkage, w->out[i], &tool);
    ethd_vec3_put(tool.x, w->out[i] + JOINTS);
    for (int k = 0; k < JOINTS; k++) {
      ethd_vec3_put(tool.j[k], w->out[i] + JOINTS + 3 + 6 * k);
      ethd_vec3_put(tool.axis[k], w->out[i] + JOINTS + 6 + 6 * k);
    }
  }
}

static void peer(void *data) {
  workload *w = data;
  w->peer->work(w->peer_self, (const double(*)[JOINTS])w->in, w->out, PERIODS);
}

static void begin(workload *w) {
  const double none[3] = {0};
  const ethd__axes base = ethd__axes_at(none, none);
  ethd__dh_row dh[JOINTS];
  for (int k = 0; k < JOINTS; k++)
    dh[k] = (ethd__dh_row){bench_ur5e[k][0], bench_ur5e[k][2], bench_ur5e[k][1], bench_ur5e[k][3]};
  ethd__linkage_make(ETHD__DH_STANDARD, dh, JOINTS, &base, (ethd_vec3){0, 0, 0}, (ethd_vec3){0, 0, 1},
                     &w->table.linkage);
  w->table.limits = (ethd_joint_limits){.count = JOINTS, .period = PERIOD};
  w->table.servo.frequency = FREQUENCY;
  w->table.servo.damping = 1;
  for (int i = 0; i < PERIODS; i++) /* reaches to and fro, and a tremble */
    for (int k = 0; k < JOINTS; k++)
      w->in[i][k] = sin((0.004 + 0.001 * k) * i) + draw((uint64_t)(JOINTS * i + k), -0.05, 0.05);
}

/* The largest error of a joint, rad: against y = v - u, y'' + 2 w y' + w^2 y = 0 in long double. */
static double error_of(const workload *w) {
  const long double f = FREQUENCY, T = PERIOD, decay = expl(-f * T);
  double worst = 0;
  for (int k = 0; k < JOINTS; k++) {
    long double q = 0, v = 0, a = 0;
    for (int i = 0; i < PERIODS; i++) {
      const long double u = w->in[i][k], y = v - u, c = a + f * y;
      const long double y1 = decay * (y + c * T), a1 = decay * (c - f * (y + c * T));
      q += u * T + (2 * y + a / f - 2 * y1 - a1 / f) / f;
      v = u + y1;
      a = a1;
      worst = fmax(worst, (double)fabsl(w->out[i][k] - q));
    }
  }
  return worst;
}

void bench_following(const char *folder, int quick) {
  enum { MOST = 3 };
  static workload w[MOST];
  bench_entry entries[MOST] = {{"libethd", ours, &w[0], PERIODS, 0}};
  size_t count = 1;
  printf("\nplant of an arm in space: a UR5e's joints follow speeds for 2 ms, place and Jacobian; largest error of a "
         "joint, rad\n");
  begin(&w[0]);
  for (const ethd__peer_following *p = bench_peer("mujoco", "peer_following"); p && p->name && count < MOST; p++) {
    memcpy(w[count].in, w[0].in, sizeof w[0].in);
    w[count].peer = p;
    w[count].peer_self = p->create(bench_ur5e, FREQUENCY, PERIOD);
    entries[count] = (bench_entry){p->name, peer, &w[count], PERIODS, 0};
    count++;
  }
  bench_race(entries, count, quick ? 0.3 : 3);
  FILE *csv = bench_csv(folder, "following",
                        "# UR5e: joints that follow speeds by a second order for a period of 2 ms, place and Jacobian\n"
                        "# error: the largest of a joint over 1024 periods, rad\n",
                        BENCH_RACE);
  printf("  %-28s %8s %10s %12s\n", "", "ns", "error", "times ours");
  for (size_t i = 0; i < count; i++) {
    const double error = error_of(entries[i].data);
    printf("  %-28s %8.1f %10.1e %12.1f\n", entries[i].name, entries[i].ns, error, entries[i].ns / entries[0].ns);
    bench_row(csv, "plant of an arm of 6 joints", entries[i].name, entries[i].ns, error);
    if (i > 0) w[i].peer->destroy(w[i].peer_self);
  }
  for (size_t i = 1; i < count; i++)
    printf("  goal: never slower than %s: %s\n", entries[i].name, bench_verdict(entries[i].ns >= entries[0].ns));
  bench_close();
}
