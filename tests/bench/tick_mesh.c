/* What the surfaces of a mesh cost in a tick: the example mesh.c around a ball of triangles. It looks at all triangles within
   10 mm more than the nearest one's distance, here about 1 of 140. */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "bench/peers.h"
#include "bench/tick.h"
#include "cli/cli.h"
#include "ethd/surface.h"
#include "unit/draw.h"

enum { PLACES = 256, MOST = 16 };

#define RADIUS 0.2 /* m */
#define RANGE 0.15

typedef struct meshing {
  const ethd__peer_mesh *peer;
  void *self;
  double x[2][PLACES][3]; /* along a way, 1 mm a tick; anywhere, so that every triangle comes from memory */
  int anywhere;
  ethd_surface found[MOST];
} meshing;

/* Writes a ball of rings of triangles, 4 rings^2 - 4 rings of them, as text of the format obj. */
static void write_ball(FILE *out, int rings) {
  const int around = 2 * rings;
  for (int i = 0; i <= rings; i++)
    for (int k = 0; k < around; k++) {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * k / around;
      fprintf(out, "v %.9g %.9g %.9g\n", RADIUS * sin(polar) * cos(turn), RADIUS * sin(polar) * sin(turn),
              RADIUS * cos(polar));
    }
  for (int i = 0; i < rings; i++)
    for (int k = 0; k < around; k++) {
      const int a = i * around + k + 1, b = i * around + (k + 1) % around + 1;
      if (i > 0) fprintf(out, "f %d %d %d\n", a, a + around, b);
      if (i < rings - 1) fprintf(out, "f %d %d %d\n", b, a + around, b + around);
    }
}

static void work(void *data) {
  meshing *m = data;
  for (int i = 0; i < PLACES; i++)
    bench_sink += m->peer->surfaces(m->self, m->x[m->anywhere][i], RANGE, m->found, MOST);
}

/* 60 to 90 mm before the ball's surface. */
static void put_places(meshing *m) {
  for (uint64_t k = 0; k < PLACES; k++) {
    const double turn = 1e-3 * (double)k / (RADIUS + 0.075);
    const ethd_vec3 along = {0.6 * cos(turn), 0.6 * sin(turn), 0.4},
                    any = {draw(4 * k, -1, 1), draw(4 * k + 1, -1, 1), draw(4 * k + 2, -1, 1)};
    ethd_vec3_put(ethd_vec3_scale((RADIUS + 0.075) / ethd_vec3_norm(along), along), m->x[0][k]);
    ethd_vec3_put(ethd_vec3_scale((RADIUS + draw(4 * k + 3, 0.06, 0.09)) / ethd_vec3_norm(any), any), m->x[1][k]);
  }
}

void ethd__tick_mesh(int quick) {
  static const int rings[] = {20, 160};
  static meshing m[4];
  const ethd__peer_mesh *peer = bench_peer("mesh", "peer_mesh");
  bench_entry all[4];
  char path[] = "/tmp/ethd-ball-XXXXXX.obj";
  if (!peer) return;
  const int fd = mkstemps(path, 4);
  if (fd < 0) ethd__fail(ETHD_EXIT_FAILED, "%s can't be made", path);
  for (int i = 0; i < 4; i++) {
    FILE *out = fopen(path, "we");
    if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s can't be written", path);
    write_ball(out, rings[i / 2]);
    fclose(out);
    m[i] = (meshing){.peer = peer, .self = peer->create(path), .anywhere = i % 2};
    if (!m[i].self) ethd__fail(ETHD_EXIT_FAILED, "%s can't be read", path);
    put_places(&m[i]);
    all[i] = (bench_entry){"", work, &m[i], PLACES, 0};
  }
  close(fd);
  unlink(path);
  bench_race(all, 4, quick ? 0.2 : 2);
  for (int i = 0; i < 4; i += 2)
    printf("surfaces of a mesh of %d triangles by %s: %.1f us a tick, %.1f us where each tick is elsewhere\n",
           4 * rings[i / 2] * (rings[i / 2] - 1), peer->name, all[i].ns / 1000, all[i + 1].ns / 1000);
  for (int i = 0; i < 4; i++) peer->destroy(m[i].self);
}
