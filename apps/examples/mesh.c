/* A closed mesh as the virtual world: an end effector in space follows a finger towards it and stands at its surface. The
   file (.obj, .stl, .ply, ...; m; triangles counterclockwise from outside) is read by assimp. Embree finds what is near.
     cc mesh.c -o mesh $(pkg-config --cflags --libs ethd assimp) -lembree4 -lm && ./mesh FILE      (Debian 12: -lembree3) */
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <ethd/ethd.h>
#include <stdio.h>

#define BEYOND 0.01 /* m: surfaces that are farther than the nearest by more than this are left out */

typedef struct mesh {
  const struct aiScene *file;
  RTCDevice device;
  RTCScene scene;
} mesh;

/* What a query has found. */
typedef struct mesh_query {
  const mesh *world;
  ethd_vec3 x;
  ethd_surface nearest;    /* the point nearest of all; on edges and corners it is on no face */
  double distance, height; /* m: of that point from X, and from X along its face's normal */
  ethd_surface *feet;      /* where X stands straight over a face, the nearest first */
  double foot_distance[ETHD_SURFACES_MAX];
  uint32_t count, most;
} mesh_query;

static ethd_vec3 corner(const struct aiMesh *part, uint32_t face, int k) {
  const struct aiVector3D v = part->mVertices[part->mFaces[face].mIndices[k]];
  return (ethd_vec3){v.x, v.y, v.z};
}

static ethd_vec3 along(ethd_vec3 from, ethd_vec3 to, double share) {
  return ethd_vec3_add(from, ethd_vec3_scale(share, ethd_vec3_sub(to, from)));
}

/* Returns the point of a triangle that is nearest to x (Ericson, Real-Time Collision Detection, 2005, 5.1.5). */
static ethd_vec3 nearest_point(ethd_vec3 a, ethd_vec3 b, ethd_vec3 c, ethd_vec3 x) {
  const ethd_vec3 ab = ethd_vec3_sub(b, a), ac = ethd_vec3_sub(c, a), ax = ethd_vec3_sub(x, a);
  const double d1 = ethd_vec3_dot(ab, ax), d2 = ethd_vec3_dot(ac, ax);
  if (d1 <= 0 && d2 <= 0) return a;
  const ethd_vec3 bx = ethd_vec3_sub(x, b), cx = ethd_vec3_sub(x, c);
  const double d3 = ethd_vec3_dot(ab, bx), d4 = ethd_vec3_dot(ac, bx);
  const double d5 = ethd_vec3_dot(ab, cx), d6 = ethd_vec3_dot(ac, cx);
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, b, d1 / (d1 - d3));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, c, d2 / (d2 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return along(b, c, (d4 - d3) / (d4 - d3 + d5 - d6));
  const double sum = va + vb + vc;
  return ethd_vec3_add(along(a, b, vb / sum), ethd_vec3_scale(vc / sum, ac));
}

static void add_foot(mesh_query *s, const ethd_surface *foot, double distance) {
  uint32_t i = s->count < s->most ? s->count++ : s->most;
  for (; i > 0 && s->foot_distance[i - 1] > distance; i--)
    if (i < s->most) s->feet[i] = s->feet[i - 1], s->foot_distance[i] = s->foot_distance[i - 1];
  if (i < s->most) s->feet[i] = *foot, s->foot_distance[i] = distance;
}

/* Embree calls this for each triangle within the radius. Where faces share the nearest point, the one that faces X most
   tells whether X is outside. */
static bool visit(struct RTCPointQueryFunctionArguments *args) {
  mesh_query *s = args->userPtr;
  const struct aiMesh *part = s->world->file->mMeshes[args->geomID];
  const ethd_vec3 a = corner(part, args->primID, 0), b = corner(part, args->primID, 1),
                  c = corner(part, args->primID, 2);
  const ethd_vec3 p = nearest_point(a, b, c, s->x), way = ethd_vec3_sub(p, s->x);
  const ethd_vec3 inward = ethd_vec3_cross(ethd_vec3_sub(c, a), ethd_vec3_sub(b, a));
  const double area = ethd_vec3_norm(inward), distance = ethd_vec3_norm(way);
  if (!(area > 0)) return false;
  ethd_surface at = {p, ethd_vec3_scale(1 / area, inward), {0, 0, 0}, (int32_t)args->geomID, -1};
  const double height = ethd_vec3_dot(at.n, way);
  if (distance - fabs(height) <= 1e-9)
    add_foot(s, &at, distance);
  else
    at.n = ethd_vec3_scale((height < 0 ? -1 : 1) / distance, way);
  const double nearer = s->distance - distance;
  if (nearer > 1e-12 || (nearer > -1e-12 && fabs(height) > s->height))
    s->nearest = at, s->distance = distance, s->height = fabs(height);
  args->query->radius = fminf(args->query->radius, (float)(distance + BEYOND));
  return true;
}

/* Gives the surfaces near x, within `range`, m; returns how many. */
static uint32_t surfaces_near(const mesh *world, ethd_vec3 x, double range, ethd_surface *out, uint32_t most) {
  mesh_query s = {.world = world, .x = x, .distance = (double)INFINITY, .feet = out + 1, .most = most - 1};
  struct RTCPointQuery query = {(float)x.x, (float)x.y, (float)x.z, 0, (float)range};
  struct RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(world->scene, &query, &context, visit, &s);
  if (!(s.distance <= range)) return 0;
  out[0] = s.nearest;
  return s.count + 1;
}

static bool load(const char *path, mesh *out) {
  out->file = aiImportFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (!out->file) return fprintf(stderr, "%s: %s\n", path, aiGetErrorString()), false;
  out->scene = rtcNewScene(out->device = rtcNewDevice("threads=1"));
  for (unsigned part = 0; part < out->file->mNumMeshes; part++) {
    const struct aiMesh *m = out->file->mMeshes[part];
    if (m->mPrimitiveTypes != aiPrimitiveType_TRIANGLE) continue;
    RTCGeometry g = rtcNewGeometry(out->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, m->mNumVertices);
    unsigned *f = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m->mNumFaces);
    for (unsigned i = 0; i < 3 * m->mNumVertices; i++) v[i] = (&m->mVertices[i / 3].x)[i % 3];
    for (unsigned i = 0; i < 3 * m->mNumFaces; i++) f[i] = m->mFaces[i / 3].mIndices[i % 3];
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(out->scene, g, part);
    rtcReleaseGeometry(g);
  }
  rtcCommitScene(out->scene);
  return true;
}

int main(int argc, char **argv) {
  mesh world;
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_space *space;
  ethd_vec3 at = {-0.3, 0, 0}, v = {0, 0, 0};
  setup.radius = 0.068, setup.acceleration = 10; /* a finger of 8 mm, 60 mm before the plate's face */
  if (argc != 2 || !load(argv[1], &world) || ethd_space_create(&setup, &space, NULL)) return 1;
  for (int tick = 0; tick < 1500; tick++) {
    ethd_space_sense sense = {.time_ns = 1000000LL * tick, .have = ETHD_SPACE_HAVE_FINGER};
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_surface near[16];
    const uint32_t count = surfaces_near(&world, at, 0.15, near, 16);
    ethd_vec3_put(at, sense.x), ethd_vec3_put(v, sense.v);
    ethd_vec3_put((ethd_vec3){-0.3 + 0.3e-3 * tick, 0, 0}, sense.finger);
    ethd_vec3_put((ethd_vec3){0.3, 0, 0}, sense.finger_v);
    if (ethd_space_step(space, &sense, near, count, &command, &trace) < 0) return 1;
    v = ethd_vec3_of(command.value);
    at = ethd_vec3_add(at, ethd_vec3_scale(setup.period, v));
    if (tick % 25 == 24)
      printf("%9.6f %9.6f %9.6f m: %8.5f m to the surface, %6.3f m/s\n", at.x, at.y, at.z, trace.d_re, trace.v_n);
  }
  ethd_space_destroy(space);
  rtcReleaseScene(world.scene), rtcReleaseDevice(world.device);
  aiReleaseImport(world.file);
}
