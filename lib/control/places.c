#include "control/places.h"

#include "ethd/maths.h"

#define MARGIN 1e-9 /* m: bound on the rounding error of a distance; the details of scenes are far coarser */

ethd__frame ethd__frame_of(const ethd__place *p) {
  ethd__frame f = {p->pose.x, p->pose.v, 1, 0, p->pose.rate};
  if (p->pose.angle != 0) ethd_sincos(p->pose.angle, &f.sine, &f.cosine);
  return f;
}

void ethd__places_take(ethd__state *state, const ethd_sense *sense) {
  for (int i = 0; i < ETHD_BODIES_MAX && (sense->have & ETHD__HAVE_BODIES); i++) {
    if (!(sense->have & ((int64_t)ETHD_HAVE_BODY << i))) continue;
    state->places[1 + i].pose = ethd__body_pose_of(sense, i);
    state->places[1 + i].there = true;
  }
}

void ethd__place_forget(ethd__place *place) { place->clearance = -1; }

bool ethd__place_is_far(const ethd__place *p, ethd_vec x, double range) {
  double left = p->clearance - range - MARGIN;
  ethd_vec travelled = ethd_vec_sub(x, p->at);
  return left > 0 && ethd_vec_dot(travelled, travelled) < left * left;
}

void ethd__place_clear(ethd__place *place, const ethd_scene *scene, ethd_vec x) {
  ethd_nearest nearest;
  ethd_scene_query_near(scene, x, &place->hint, &nearest);
  place->at = x;
  place->clearance = nearest.distance;
}
