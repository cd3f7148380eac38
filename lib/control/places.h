/* Places of objects: the scene that stands still, and bodies, whose motion the sense gives.

   A place is a scene with a frame. The ring's position is transformed into that frame, so scenes never move, and a
   known distance to a scene serves bodies as it serves the scene that stands still. */
#ifndef ETHD__CONTROL_PLACES_H
#define ETHD__CONTROL_PLACES_H

#include <stddef.h>

#include "control/state.h"

/* The bits of all bodies. */
#define ETHD__HAVE_BODIES (((int64_t)ETHD_HAVE_BODY << ETHD_BODIES_MAX) - ETHD_HAVE_BODY)

typedef struct ethd__frame {
  ethd_vec x, v; /* origin in R_0 and its velocity */
  double cosine, sine, rate;
} ethd__frame;

ethd__frame ethd__frame_of(const ethd__place *place) ETHD_RT;

/* Transform points into the frame (in) and out of it (out), and directions out of it (turn). */
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

/* Returns the velocity of a point of the body, both in R_0. */
static inline ethd_vec ethd__frame_velocity(const ethd__frame *f, ethd_vec point) ETHD_RT {
  ethd_vec r = ethd_vec_sub(point, f->x);
  return (ethd_vec){f->v.x - f->rate * r.y, f->v.y + f->rate * r.x};
}

/* Returns the pose of bodies[i] in the sense. */
static inline ethd__body_pose ethd__body_pose_of(const ethd_sense *sense, int i) ETHD_RT {
  const double *b = sense->bodies + i * (ptrdiff_t)(sizeof(ethd__body_pose) / sizeof *sense->bodies);
  return (ethd__body_pose){ethd_vec_of(b), b[2], ethd_vec_of(b + 3), b[5]};
}

/* Takes the new poses from the sense. */
void ethd__places_take(ethd__state *state, const ethd_sense *sense) ETHD_RT;

/* Forgets the distance to the place's scene. */
void ethd__place_forget(ethd__place *place) ETHD_RT;

/* Returns true while the ring, now at x in the place's frame, can't be within `range` of any object because it hasn't
   travelled far enough since the clearance was found. Doesn't read the scene. */
bool ethd__place_is_far(const ethd__place *place, ethd_vec x, double range) ETHD_RT;

/* Finds the clearance at x, which has no object within range. */
void ethd__place_clear(ethd__place *place, const ethd_scene *scene, ethd_vec x) ETHD_RT;

#endif
