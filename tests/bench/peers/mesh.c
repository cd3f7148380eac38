// flags: -Wno-return-type -lassimp $([ -d /usr/include/embree4 ] && echo -lembree4 || echo -lembree3)
// The example mesh.c as it is: assimp reads, Embree finds.
#define main mesh_main
#include "../../../apps/examples/mesh.c"
#undef main
#include <stdlib.h>

#include "bench/peers.h"

static void *create(const char *path) {
  mesh *m = calloc(1, sizeof *m);
  if (m && load(path, m)) return m;
  free(m);
  return NULL;
}

static uint32_t surfaces(void *self, const double x[3], double range, ethd_surface *out, uint32_t most) {
  return surfaces_near(self, ethd_vec3_of(x), range, out, most);
}

static void destroy(void *self) {
  mesh *m = self;
  rtcReleaseScene(m->scene);
  rtcReleaseDevice(m->device);
  aiReleaseImport(m->file);
  free(m);
}

extern const ethd__peer_mesh peer_mesh;
const ethd__peer_mesh peer_mesh = {"Embree", create, surfaces, destroy};
