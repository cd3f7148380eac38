/* Place and Jacobian of an arm of six joints in space, a UR5e, at 1024 postures. */
#include <math.h>
#include <string.h>

#include "arm/linkage.h"
#include "bench/bench.h"
#include "bench/peers.h"
#include "unit/draw.h"

enum { PLACES = 1024, JOINTS = ETHD__PEER_JOINTS, NUMBERS = ETHD__PEER_LINKAGE };

const double bench_ur5e[JOINTS][4] = {{0, M_PI / 2, 0.1625, 0}, {-0.425, 0, 0, 0},         {-0.3922, 0, 0, 0},
                                      {0, M_PI / 2, 0.1333, 0}, {0, -M_PI / 2, 0.0997, 0}, {0, 0, 0.0996, 0}};

typedef struct workload {
  double in[PLACES][JOINTS], out[PLACES][NUMBERS];
  ethd__linkage linkage;
  const ethd__peer_linkage *peer;
  void *peer_self;
} workload;

static void make_places(workload *w) {
  const double none[3] = {0};
  const ethd__axes base = ethd__axes_at(none, none);
  ethd__dh_row dh[JOINTS];
  for (uint64_t i = 0; i < PLACES; i++)
    for (uint64_t k = 0; k < JOINTS; k++) w->in[i][k] = draw(8 * i + k, -M_PI, M_PI);
  for (int k = 0; k < JOINTS; k++)
    dh[k] = (ethd__dh_row){bench_ur5e[k][0], bench_ur5e[k][2], bench_ur5e[k][1], bench_ur5e[k][3]};
  ethd__linkage_make(ETHD__DH_STANDARD, dh, JOINTS, &base, (ethd_vec3){0, 0, 0}, (ethd_vec3){0, 0, 1}, &w->linkage);
}

static void ours(void *data) {
  workload *w = data;
  ethd__tool tool;
  for (int i = 0; i < PLACES; i++) {
    ethd__linkage_place(&w->linkage, w->in[i], &tool);
    ethd_vec3_put(tool.x, w->out[i]);
    for (int k = 0; k < JOINTS; k++) {
      ethd_vec3_put(tool.j[k], w->out[i] + 3 + 6 * k);
      ethd_vec3_put(tool.axis[k], w->out[i] + 6 + 6 * k);
    }
  }
}

static void peer(void *data) {
  workload *w = data;
  w->peer->work(w->peer_self, (const double(*)[JOINTS])w->in, w->out, PLACES);
}

/* ---- error: against products of 4x4 matrices in long double ---- */

typedef long double matrix[3][4];

static void append(matrix m, const double row[4], long double q) {
  const long double c = cosl(q + row[3]), s = sinl(q + row[3]), ca = cosl(row[1]), sa = sinl(row[1]);
  const long double by[3][4] = {
      {c, -s * ca, s * sa, row[0] * c}, {s, c * ca, -c * sa, row[0] * s}, {0, sa, ca, row[2]}};
  matrix was;
  memcpy(was, m, sizeof was);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++) {
      m[i][k] = k == 3 ? was[i][3] : 0;
      for (int l = 0; l < 3; l++) m[i][k] += was[i][l] * by[l][k];
    }
}

static void exact(const double *q, long double out[NUMBERS]) {
  matrix m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  long double at[JOINTS][3];
  for (int k = 0; k < JOINTS; k++) {
    for (int i = 0; i < 3; i++) {
      at[k][i] = m[i][3];
      out[6 + 6 * k + i] = m[i][2];
    }
    append(m, bench_ur5e[k], q[k]);
  }
  for (int i = 0; i < 3; i++) out[i] = m[i][3];
  for (int k = 0; k < JOINTS; k++)
    for (int i = 0; i < 3; i++) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      const long double *axis = out + 6 + 6 * k;
      out[3 + 6 * k + i] = axis[a] * (out[b] - at[k][b]) - axis[b] * (out[a] - at[k][a]);
    }
}

static double error_of(const workload *w) {
  double worst = 0;
  for (int i = 0; i < PLACES; i++) {
    long double out[NUMBERS];
    exact(w->in[i], out);
    for (int k = 0; k < NUMBERS; k++) worst = fmax(worst, (double)fabsl(w->out[i][k] - out[k]));
  }
  return worst;
}

void bench_linkage(const char *folder, int quick) {
  static const char *const libraries[] = {"kdl", "mujoco"};
  static workload w[3];
  bench_entry entries[3] = {{"libethd", ours, &w[0], PLACES, 0}};
  size_t count = 1;
  printf("\nkinematics in space: place and Jacobian of a UR5e, 6 joints; largest error against long double, m and 1\n");
  make_places(&w[0]);
  for (size_t i = 0; i < 2; i++) {
    const ethd__peer_linkage *found = bench_peer(libraries[i], "peer_linkage");
    if (!found) continue;
    memcpy(w[count].in, w[0].in, sizeof w[0].in);
    w[count].peer = found;
    w[count].peer_self = found->create(bench_ur5e);
    entries[count] = (bench_entry){found->name, peer, &w[count], PLACES, 0};
    count++;
  }
  bench_race(entries, count, quick ? 0.3 : 3);
  FILE *csv = bench_csv(folder, "linkage",
                        "# UR5e: place and Jacobian at 1024 postures\n"
                        "# error: the largest over outputs and postures, m and 1\n",
                        BENCH_RACE);
  printf("  %-28s %8s %10s %12s\n", "", "ns", "error", "times ours");
  for (size_t i = 0; i < count; i++) {
    const double error = error_of(entries[i].data);
    printf("  %-28s %8.1f %10.1e %12.1f\n", entries[i].name, entries[i].ns, error, entries[i].ns / entries[0].ns);
    bench_row(csv, "place and Jacobian of 6 joints", entries[i].name, entries[i].ns, error);
    if (i > 0) w[i].peer->destroy(w[i].peer_self);
  }
  for (size_t i = 1; i < count; i++)
    printf("  goal: never slower than %s: %s\n", entries[i].name, bench_verdict(entries[i].ns >= entries[0].ns));
  bench_close();
}
