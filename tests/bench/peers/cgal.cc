// flags: -frounding-math
// CGAL: AABB tree of segments in double; without a known answer, its own table of starting points.
#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include <cmath>
#include <vector>

#include "bench/peers.h"

#define STRING(x) #x
#define TEXT(x) STRING(x)

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Segments = std::vector<Kernel::Segment_3>;
using Primitive = CGAL::AABB_segment_primitive<Kernel, Segments::iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

struct Scene {
  Segments segments;
  Tree tree;
  const double (*numbers)[4];
  size_t nearest = 0;
};

void *create(const double (*segments)[4], size_t n) {
  Scene *s = new Scene;
  s->numbers = segments;
  for (size_t i = 0; i < n; i++)
    s->segments.emplace_back(Kernel::Point_3(segments[i][0], segments[i][1], 0),
                             Kernel::Point_3(segments[i][2], segments[i][3], 0));
  s->tree.insert(s->segments.begin(), s->segments.end());
  s->tree.build();
  s->tree.accelerate_distance_queries();
  return s;
}

void nearest(void *self, const double x[2], double limit, int warm, double out[3]) {
  Scene &s = *static_cast<Scene *>(self);
  Kernel::Point_3 p(x[0], x[1], 0);
  double known[3];
  if (warm) ethd__peer_point(s.numbers[s.nearest], x, known);
  bool limited = limit < INFINITY && !(warm && known[0] < limit);
  if (warm || limited) {
    /* Where nothing is nearer the start itself comes back. */
    Kernel::Point_3 start = limited ? Kernel::Point_3(x[0] + limit, x[1], 0) : Kernel::Point_3(known[1], known[2], 0);
    auto found = s.tree.closest_point_and_primitive(p, {start, s.segments.begin() + static_cast<long>(s.nearest)});
    if (limited && found.first == start) {
      out[0] = INFINITY;
      return;
    }
    s.nearest = static_cast<size_t>(found.second - s.segments.begin());
  } else {
    s.nearest = static_cast<size_t>(s.tree.closest_point_and_primitive(p).second - s.segments.begin());
  }
  ethd__peer_point(s.numbers[s.nearest], x, out);
}

void destroy(void *self) { delete static_cast<Scene *>(self); }

} // namespace

extern "C" const ethd__peer_scene peer_scene;
extern "C" const ethd__peer_scene peer_scene = {"CGAL " CGAL_VERSION_STR, create, nearest, nullptr, destroy};
