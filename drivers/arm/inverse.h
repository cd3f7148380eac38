/* The inverse of a Jacobian, damped near singularities only in the singular directions, and its null-space motion.

   With J = sum of s_k u_k v_k^T, its singular values s_k in falling or any order:

     J^+ task    = sum over k of v_k s_k (u_k . task) / max(s_k, singular)^2
     free part p = p - sum over k of v_k (v_k . p)

   Damped least squares divide by s^2 + lambda^2 (Nakamura and Hanafusa 1986), here with the damping of each direction
   by its own singular value, lambda^2 = singular^2 - s^2 below `singular` (numerical filtering, Maciejewski and Klein
   1988; Chiaverini 1997). So directions in which the arm can move well are exact, independent of the others; a
   direction in which an arm of few joints can't move gets no motion; the gain is continuous, and at most 1 / singular.

   The directions are found by one-sided Jacobi rotations of the rows (Hestenes 1958), which find small singular values
   to their last digits. At most ETHD__INVERSE_SWEEPS sweeps; four or five are usual. All [any, rt-safe]. */
#ifndef ETHD__ARM_INVERSE_H
#define ETHD__ARM_INVERSE_H

#include <stdint.h>

#include "ethd/guard.h"

enum { ETHD__TASK_MAX = 5, ETHD__INVERSE_SWEEPS = 12 };

typedef struct ethd__inverse {
  uint32_t rows, count;
  double u[ETHD__TASK_MAX][ETHD__TASK_MAX];   /* u[k]: unit vector u_k */
  double sv[ETHD__TASK_MAX][ETHD_JOINTS_MAX]; /* s_k v_k */
  double square[ETHD__TASK_MAX];              /* s_k^2; 0: zero within rounding */
  double singular;                            /* > 0 */
} ethd__inverse;

/* Computes the directions of `rows` rows of `count` numbers. */
void ethd__inverse_make(double (*j)[ETHD_JOINTS_MAX], uint32_t rows, uint32_t count, double singular,
                        ethd__inverse *out) ETHD_RT;

/* Fills dq with J^+ task. */
void ethd__inverse_solve(const ethd__inverse *inverse, const double *task, double *dq) ETHD_RT;

/* Projects p onto the null space of the rows. */
void ethd__inverse_free(const ethd__inverse *inverse, double *p) ETHD_RT;

#endif
