/* Where objects are: the scene that stands still, and bodies that move as the sense says.

   A place is a scene with a frame; the ring is seen from within that frame, so a scene is never moved,
   and "nothing can be near yet" holds for what moves as for what doesn't. */
#ifndef ETHD__PLACES_H
#define ETHD__PLACES_H

#include "control/state.h"

/* Any of them. */
#define ETHD__HAVE_BODIES (((int64_t)ETHD_HAVE_BODY << ETHD_BODIES_MAX) - ETHD_HAVE_BODY)

typedef struct ethd__frame {
  ethd_vec x, v; /* origin in R_0 and its velocity */
  double cosine, sine, rate;
} ethd__frame;

ethd__frame ethd__frame_of(const ethd__place *place) ETHD_RT;

/* Points and directions, into the frame and out of it. */
static inline ethd_vec ethd__frame_in(const ethd__frame *f, ethd_vec x) ETHD_RT {
  ethd_vec r = ethd_vec_sub(x, f->x);
  return (ethd_vec){f->cosine * r.x + f->sine * r.y, f->cosine * r.y - f->sine * r.x};
}

static inline ethd_vec ethd__frame_turn(const ethd__frame *f, ethd_vec n) ETHD_RT {
  return (ethd_vec){f->cosine * n.x - f->sine * n.y, f->sine * n.x + f->cosine * n.y};
}

static inline ethd_vec ethd__frame_out(const ethd__frame *f, ethd_vec x) ETHD_RT {
  return ethd_vec_add(f->x, ethd__frame_turn(f, x));
}

/* Velocity of a point of the body, given in R_0. */
static inline ethd_vec ethd__frame_velocity(const ethd__frame *f, ethd_vec point) ETHD_RT {
  ethd_vec r = ethd_vec_sub(point, f->x);
  return (ethd_vec){f->v.x - f->rate * r.y, f->v.y + f->rate * r.x};
}

/* New poses from the sense. */
void ethd__places_take(ethd__state *state, const ethd_sense *sense) ETHD_RT;

/* Forgets what was known of a place's scene. */
void ethd__place_forget(ethd__place *place) ETHD_RT;

/* True while the ring, now at x in the place's frame, can't be within `range` of anything: it hasn't
   travelled far enough since it was last asked. Touches no memory of the scene. */
bool ethd__place_is_far(const ethd__place *place, ethd_vec x, double range) ETHD_RT;

/* Nothing is within reach at x: asks how far it is. */
void ethd__place_clear(ethd__place *place, const ethd_scene *scene, ethd_vec x) ETHD_RT;

#endif
