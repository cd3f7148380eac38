/* A closed mesh as the virtual world: assimp reads the file (.obj, .stl, .ply, ...; m; triangles counterclockwise from
   outside), Embree finds what is near a point. For mesh.c and, with -DMESH, arm.c. */
#ifndef ETHD__APPS_EXAMPLES_MESH_H
#define ETHD__APPS_EXAMPLES_MESH_H

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <ethd/ethd.h>
#include <math.h>
#include <stdio.h>

/* m: surfaces that are farther than the nearest by more than this are left out. An effector that slides towards a corner sees
   the other wall this far before it has to stand, so v^2 / (2 a) must be less. */
#define DEEPER 0.01

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
  bool inside;             /* X is, as that face says */
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
    s->nearest = at, s->distance = distance, s->height = fabs(height), s->inside = height < 0;
  args->query->radius = fminf(args->query->radius, (float)(distance + DEEPER));
  return true;
}

/* Gives the surfaces near x, within `range`, m; returns how many. From outside, faces that look away aren't seen. */
static inline uint32_t surfaces_near(const mesh *world, ethd_vec3 x, double range, ethd_surface *out, uint32_t most) {
  mesh_query s = {.world = world, .x = x, .distance = (double)INFINITY, .feet = out + 1, .most = most - 1};
  struct RTCPointQuery query = {(float)x.x, (float)x.y, (float)x.z, 0, (float)range};
  struct RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(world->scene, &query, &context, visit, &s);
  if (!(s.distance <= range)) return 0;
  out[0] = s.nearest;
  uint32_t count = 1;
  for (uint32_t i = 0; i < s.count && s.foot_distance[i] <= s.distance + DEEPER; i++)
    if ((ethd_vec3_dot(s.feet[i].n, ethd_vec3_sub(s.feet[i].point, x)) < 0) == s.inside) out[count++] = s.feet[i];
  return count;
}

/* Returns false with a line on stderr where a finger would meet nothing, or what is inside. */
static inline bool load(const char *path, mesh *out) {
  out->file = aiImportFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (!out->file) return fprintf(stderr, "%s: %s\n", path, aiGetErrorString()), false;
  double volume = 0, extent = 0; /* m^3, m from the origin */
  out->scene = rtcNewScene(out->device = rtcNewDevice("threads=1"));
  for (unsigned part = 0; part < out->file->mNumMeshes; part++) {
    const struct aiMesh *m = out->file->mMeshes[part];
    if (!(m->mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) continue; /* what was a quad has another bit as well */
    for (unsigned i = 0; i < m->mNumFaces; i++) {
      const ethd_vec3 a = corner(m, i, 0), b = corner(m, i, 1), c = corner(m, i, 2);
      volume += ethd_vec3_dot(a, ethd_vec3_cross(b, c)) / 6;
      extent = fmax(extent, ethd_vec3_norm(a));
    }
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
  fprintf(stderr, "%s: %.3g m3, up to %.3g m from the origin\n", path, volume, extent);
  return volume > 0 ||
         (fprintf(stderr, "%s: no closed mesh, or its triangles are clockwise from outside\n", path), false);
}

#endif
