// flags: $([ -d /usr/include/embree4 ] && echo -lembree4 || echo -lembree3)
// Embree: point queries on a tree of user geometry, one segment a primitive; bounds in float rounded outward,
// the segment's closed form in double.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <cmath>

#include "bench/peers.h"

#define STRING(x) #x
#define TEXT(x) STRING(x)

namespace {

struct Scene {
  RTCDevice device;
  RTCScene scene;
  const double (*segments)[4];
  std::atomic<size_t> bytes{0};
  double x[2], squared;
  unsigned nearest = 0;
};

float down(double v) { return std::nextafterf(static_cast<float>(v), -INFINITY); }
float up(double v) { return std::nextafterf(static_cast<float>(v), INFINITY); }

void bounds(const RTCBoundsFunctionArguments *a) {
  const double *s = static_cast<const double(*)[4]>(a->geometryUserPtr)[a->primID];
  RTCBounds *b = a->bounds_o;
  b->lower_x = down(std::fmin(s[0], s[2])), b->upper_x = up(std::fmax(s[0], s[2]));
  b->lower_y = down(std::fmin(s[1], s[3])), b->upper_y = up(std::fmax(s[1], s[3]));
  b->lower_z = b->upper_z = 0;
}

bool visit(RTCPointQueryFunctionArguments *a) {
  Scene &s = *static_cast<Scene *>(a->userPtr);
  double squared = ethd__peer_squared(s.segments[a->primID], s.x);
  if (!(squared < s.squared)) return false;
  s.squared = squared;
  s.nearest = a->primID;
  a->query->radius = up(std::sqrt(squared));
  return true;
}

bool count(void *self, ssize_t bytes, bool) {
  static_cast<Scene *>(self)->bytes += static_cast<size_t>(bytes);
  return true;
}

void *create(const double (*segments)[4], size_t n) {
  Scene *s = new Scene;
  s->segments = segments;
  s->device = rtcNewDevice("threads=1");
  rtcSetDeviceMemoryMonitorFunction(s->device, count, s);
  s->scene = rtcNewScene(s->device);
  RTCGeometry g = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(n));
  rtcSetGeometryUserData(g, const_cast<double(*)[4]>(segments));
  rtcSetGeometryBoundsFunction(g, bounds, nullptr);
  rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(g);
  rtcAttachGeometry(s->scene, g);
  rtcReleaseGeometry(g);
  rtcSetSceneBuildQuality(s->scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(s->scene);
  return s;
}

void nearest(void *self, const double x[2], double limit, int warm, double out[3]) {
  Scene &s = *static_cast<Scene *>(self);
  s.x[0] = x[0], s.x[1] = x[1];
  s.squared = limit * limit;
  if (warm) s.squared = std::fmin(s.squared, ethd__peer_squared(s.segments[s.nearest], x) * (1 + 1e-15));
  unsigned last = s.nearest;
  s.nearest = ~0u;
  RTCPointQuery query{static_cast<float>(x[0]), static_cast<float>(x[1]), 0, 0, up(std::sqrt(s.squared))};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(s.scene, &query, &context, visit, &s);
  bool found = s.nearest != ~0u;
  if (!found) s.nearest = last;
  ethd__peer_point(s.segments[s.nearest], x, out);
  if (!found && !(out[0] <= limit)) out[0] = INFINITY;
}

size_t bytes(void *self) { return static_cast<Scene *>(self)->bytes; }

void destroy(void *self) {
  Scene *s = static_cast<Scene *>(self);
  rtcReleaseScene(s->scene);
  rtcReleaseDevice(s->device);
  delete s;
}

} // namespace

extern "C" const ethd__peer_scene peer_scene;
extern "C" const ethd__peer_scene peer_scene = {"Embree " TEXT(RTC_VERSION_MAJOR) "." TEXT(RTC_VERSION_MINOR), create,
                                                nearest, bytes, destroy};
