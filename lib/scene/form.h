/* The text form of shapes: their names and numbers, and checks of numbers. Worlds of the plane and of space share this
   and the reader of text.h. [main] */
#ifndef ETHD__SCENE_FORM_H
#define ETHD__SCENE_FORM_H

#include <stdbool.h>

#include "error.h"
#include "ethd/surface.h"

#define ETHD__COORDINATE_MAX 1e6 /* m */
#define ETHD__GIVEN_MAX 9        /* the most numbers of a shape without a list of points */

typedef enum ethd__number_kind {
  ETHD__COORDINATE, /* m, of either sign; part of the scene's extent */
  ETHD__LENGTH,     /* m, above 0; part of the scene's extent */
  ETHD__DIRECTION   /* a component of a unit vector or an angle: no part of the scene's extent */
} ethd__number_kind;

typedef struct ethd__form {
  const char *name;
  const char *text; /* the numbers in the form of a scene's file, for messages and help */
  struct {
    const char *name;
    ethd__number_kind kind;
  } numbers[ETHD__GIVEN_MAX]; /* for a list of points: those of one point */
  size_t count;               /* number of numbers; the least, if there may be more */
  size_t step, most;          /* `step` more may follow, and again up to `most`; step 0: no more */
  size_t cycle;               /* numbers of one point, after which the names repeat; 0: they don't repeat */
} ethd__form;

/* The shapes of one world, numbered from 0. */
typedef struct ethd__world {
  const char *name; /* "the plane" */
  size_t count;
  const ethd__form *(*form)(size_t shape);
} ethd__world;

extern const ethd__world ethd__plane, ethd__space;

/* Returns the index in the form of an object's number k. */
static inline size_t ethd__number_of(const ethd__form *f, size_t k) { return f->cycle ? k % f->cycle : k; }

/* Appends to the name of an error as much of `word` as fits, and returns the name's new length. */
size_t ethd__append(char name[64], size_t at, const char *word);

/* Returns ETHD_OK if a form may have this many numbers, else `status`; the error has no line. */
ethd_status ethd__check_count(const ethd__form *form, size_t count, ethd_status status, ethd_error *error);

/* Checks that each number is finite and in its range; the error has no line. */
ethd_status ethd__check_numbers(const ethd__form *form, const double *numbers, size_t count, ethd_error *error);

/* Checks a world's materials: their count, names and values. */
ethd_status ethd__check_materials(const ethd_material *materials, size_t count, ethd_error *error);

#endif
