/* The plant in motion (arm, motors, finger): its equations and one integration step. */
#ifndef ETHD__SIM_BODY_H
#define ETHD__SIM_BODY_H

#include <stdbool.h>

#include "ethd/sim.h"
#include "sim/path.h"

#define ETHD__STICK 3e-3 /* m/s of friction's tanh */

/* Coordinates: absolute angles of the links, finger x and y, motors' sides of the joints (as joint
   angles; only with a compliant transmission). */
enum { ETHD__LINK = 0, ETHD__FINGER = 2, ETHD__MOTOR = 4, ETHD__DOF_MAX = 6 };

/* Orders of steps. */
enum { ETHD__ORDER_MIN = 4, ETHD__ORDER_MAX = 14 };

/* Pad and ring are apart; or press with the force K p (1 + c p_dot); or separate so fast that this force would pull,
   and the force is 0. */
typedef enum ethd__touch { ETHD__APART, ETHD__PRESSING, ETHD__LEAVING } ethd__touch;

typedef struct ethd__sim_state {
  double q[ETHD__DOF_MAX], v[ETHD__DOF_MAX];
  double clearance; /* m: a lower bound of the distance between pad and ring; 0: none is known */
  ethd__touch touch;
} ethd__sim_state;

/* Coefficients of the equations, computed once. Joint quantities are those at the ring times L or L^2. */
typedef struct ethd__body {
  int dof;
  bool serial, compliant;
  double link[2];
  double inertia[2], coupling, motor_inertia[2]; /* kg m^2 */
  double stiffness[2], damping[2];               /* Nm/rad, Nms/rad of the transmission */
  double friction[2], viscous[2], sharpness[2];  /* Nm, Nms/rad, s/rad: f tanh(sharpness w) + viscous w */
  double torque_max[2], torque[2];               /* Nm; torque: the present one */
  double gap, pad_stiffness, pad_damping;
  double finger_mass, hand_stiffness, hand_damping;
  double tolerance;                 /* m/s, of a step's last terms */
  int order_max;                    /* the order of steps that reaches the tolerance at the least cost */
  double at[2], sine[2], cosine[2]; /* angles near the present ones, and their sines and cosines */
} ethd__body;

/* Computes the coefficients; `finger_radius` is the tap's. */
void ethd__body_prepare(const ethd_sim_def *def, double finger_radius, ethd__body *out);

/* Sets tolerance and order_max: 1 - ln(tolerance)/2 (Jorba and Zou 2005). */
void ethd__body_tolerate(ethd__body *body, double tolerance) ETHD_RT;

/* Converts joint angles (those of the measured side, if there are two) to coordinates, and back. */
void ethd__body_place(const ethd__body *body, const double q[2], ethd__sim_state *out) ETHD_RT;
void ethd__body_joints(const ethd__body *body, const double x[ETHD__DOF_MAX], double out[2]) ETHD_RT;

/* Sets the angles from which the next sines are computed as small rotations. Does nothing while these angles are near
   the last ones. */
void ethd__body_refer(ethd__body *body, const ethd__sim_state *state) ETHD_RT;

/* Fills sines and cosines of the links' angles. */
void ethd__body_waves(const ethd__body *body, ethd__two angle, ethd__two *sine, ethd__two *cosine) ETHD_RT;

/* Fills the ring's centre and its velocity; the second computes them from the motors' side. */
void ethd__body_ring(const ethd__body *body, const ethd__sim_state *state, ethd_vec *x, ethd_vec *v) ETHD_RT;
void ethd__body_motor(const ethd__body *body, const ethd__sim_state *state, ethd_vec *x, ethd_vec *v) ETHD_RT;

/* Fills the pad's penetration p and its force under the state's touch. */
void ethd__body_pad(const ethd__body *body, const ethd__sim_state *state, double *p, double *force) ETHD_RT;

/* Returns whether pad and ring touch in this state; ignores state->touch. */
ethd__touch ethd__body_touch(const ethd__body *body, const ethd__sim_state *state) ETHD_RT;

/* Advances from t to t + h by steps of power series. Within that time only touch may change; its changes are located to
   1e-12 s. */
void ethd__body_advance(const ethd__body *body, const ethd__piece *piece, double t, double h,
                        ethd__sim_state *state) ETHD_RT;

#endif
