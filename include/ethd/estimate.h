/* Estimators: joint speed from positions, the finger from the ring's distances, and its movement between readings.
   Links from libethd. */
#ifndef ETHD_ESTIMATE_H
#define ETHD_ESTIMATE_H

#include <stdbool.h>

#include "ethd/maths.h"
#include "ethd/param.h"

ETHD_BEGIN_DECLS

/* ---- joint speed ---- */

/* Joint speed from encoder positions, one estimator per joint.

   Less noise costs more lag, and both limit the stable gains: ethd-check prints these bounds. */

typedef enum ethd_velocity_method {
  ETHD_VELOCITY_LOWPASS = 0, /* first-order low-pass of the difference: qd += a (raw - qd) with
                                a = 1 - exp(-2 pi cutoff dt), raw = (q - q_prev) / dt */
  ETHD_VELOCITY_DIFFERENCE,  /* raw */
  ETHD_VELOCITY_LSQ,         /* slope of the least-squares line through the last `window` samples */
  ETHD_VELOCITY_FOAW,        /* the same over a window that grows, up to `window`, while the line through
                                its end points passes within `noise` of every sample between:
                                first-order adaptive windowing (Janabi-Sharifi, Hayward and Chen 2000),
                                window by their end fit, slope by their best fit */
  ETHD_VELOCITY_KALMAN,      /* position and speed; known input torque / inertia, unknown one constant
                                within a tick, `acceleration` rms */
  ETHD_VELOCITY_COUNT
} ethd_velocity_method;

/* id, brief and parameters of each, by ethd_velocity_method. */
ETHD_API extern const ethd_method ethd_velocity_methods[ETHD_VELOCITY_COUNT];

#define ETHD_VELOCITY_WINDOW_MAX 32 /* samples, the newest included */

/* A checked estimator with its coefficients. Plain value. */
typedef struct ethd_velocity {
  ethd_velocity_method method;
  uint32_t window; /* lsq, foaw: samples; else 0 */
  double period;
  double gain;               /* lowpass: a at dt = period; else 0 */
  double p[ETHD_PARAMS_MAX]; /* as posted */
} ethd_velocity;

/* State of one joint: numbers only. Zeroed: nothing known. */
typedef struct ethd_velocity_state {
  double q[ETHD_VELOCITY_WINDOW_MAX];  /* rad: last positions, a ring */
  double dt[ETHD_VELOCITY_WINDOW_MAX]; /* s: from the previous sample to each */
  double speed;                        /* rad/s: the last result */
  double position, cov[3];             /* kalman: rad; rad^2, rad^2/s, rad^2/s^2 */
  uint32_t count, head;                /* samples held, the newest's index */
} ethd_velocity_state;

/* Checks p against the method's table, and the period (1e-6 to 1 s), and computes the coefficients: ETHD_E_RANGE,
   ETHD_E_NOT_FINITE or, for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_velocity_prepare(ethd_velocity_method method, const double *p, double period,
                                                           ethd_velocity *out, ethd_error *error);

/* Returns the next speed, rad/s. q: rad; torque: the joint's last commanded torque, Nm (kalman only); dt > 0: s
   since the last step, a whole number of periods when ticks were missed. After a zeroed state the first
   call gives 0 (no difference yet); a state with count = 0 but speed set starts from that speed. Errors don't
   accumulate over time, but a number that isn't finite stays until the state is zeroed. [rt] */
ETHD_API double ethd_velocity_step(const ethd_velocity *velocity, ethd_velocity_state *state, double q, double torque,
                                   double dt) ETHD_RT;

/* Returns the lag of the speed under a small constant acceleration (kalman: unknown to the filter), s:
   difference T/2, lowpass T/2 + T (1 - a) / a, lsq and, at its longest, foaw (window - 1) T/2. [any] */
ETHD_API double ethd_velocity_lag(const ethd_velocity *velocity);

/* ---- finger: centre and radius ---- */

/* The finger's centre and radius from the ring's 16 distances.

             r_k        Ray k leaves the ring's inner circle at angle 2 pi k / 16 (x axis = 0,
        .--<--|         counter-clockwise, in R_0: the ring doesn't turn) and runs to the ring's centre.
       (  o   |         r_k is the free distance along it, so the finger's surface lies at
        '-----'         p_k = (R_r - r_k) (cos, sin).

   A ray counts if and only if |r_k| < R_r. NaN means that it is missing. At R_r or more it has met nothing. At 0 or
   less the finger touches the ring there, within noise; dropping such rays would push the centre away from the ring. */

#define ETHD_RAYS 16

typedef enum ethd_fit_method {
  ETHD_FIT_KASA = 0,    /* least squares of |p - c|^2 - R^2 in c and R (Kasa 1976) */
  ETHD_FIT_VERTEX_MEAN, /* the paper's centre of the polygon: mean of its vertices. With all rays it
                           gives half of a small offset */
  ETHD_FIT_CENTROID,    /* centroid of the polygon's area, missing vertices left out */
  ETHD_FIT_ROBUST,      /* the same sum in c alone, R = the known finger radius: a Gauss-Newton step from
                           kasa (two from the ring's centre if that isn't such a finger), then up to two
                           without the rays over `gate` from the circle, while rays change or it moves */
  ETHD_FIT_COUNT
} ethd_fit_method;

ETHD_API extern const ethd_method ethd_fit_methods[ETHD_FIT_COUNT];

typedef struct ethd_fit {
  ethd_fit_method method;
  double ring_radius, finger_radius; /* m */
  double p[ETHD_PARAMS_MAX];
} ethd_fit;

typedef struct ethd_finger {
  ethd_vec centre; /* relative to the ring's centre, m */
  double radius;   /* rms of |p - c| over the rays used, m: kasa's R */
  double residual; /* rms of (|p - c|^2 - radius^2) / (2 radius), approximately |p - c| - radius, m */
  uint32_t used;   /* bit k: ray k was used */
  uint32_t reserved;
} ethd_finger;

/* Checks p against the method's table, and 1e-4 m <= finger_radius <= ring_radius <= 1 m: ETHD_E_RANGE,
   ETHD_E_NOT_FINITE or, for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_prepare(ethd_fit_method method, const double *p, double ring_radius,
                                                      double finger_radius, ethd_fit *out, ethd_error *error);

/* Fits the finger to one frame of rays, m. ETHD_STATUS_STALE: the rays that count don't determine a centre within the
   ring: there are under 3 (robust: 2) or, for kasa and centroid, they lie on one line; out is then untouched. [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_step(const ethd_fit *fit, const double r[ETHD_RAYS],
                                                   ethd_finger *out) ETHD_RT;

/* Gives the distances, m, to a finger of this radius, m, and centre, m from the ring's (the fit's inverse); NaN where a
   ray reaches the ring's centre first, or meets nothing. [any, rt-safe] */
ETHD_API void ethd_fit_rays(double ring_radius, double finger_radius, ethd_vec centre, double r[ETHD_RAYS]) ETHD_RT;

/* ---- finger: position and velocity at each tick ---- */

/* The finger at each tick (1 kHz) from readings at 300 Hz: position and velocity per axis.

   Every tick predicts; a reading corrects at the tick at which it has arrived.

     compensation = stamp   the state belongs to the last reading's sample instant, `latency` before its stamp; the
                            next reading moves it on to its own instant; the output is extrapolated from the state to
                            now. A lost frame only makes that interval longer
     compensation = none    the state belongs to now and moves on with every tick; a reading counts as if it had been
                            taken now

   All axes have the same noise, so they share the covariance. The plane has two axes, space has three and its own
   functions (..._start3, _update3, _output3); a state works with one kind of them only. */

typedef enum ethd_filter_method {
  ETHD_FILTER_CA = 0,     /* Kalman, constant acceleration: Q = jerk^2 g g^T, g = (T^3/6, T^2/2, T) for
                             each step of T s, a tick's (none) or a reading's (stamp). The acceleration
                             fades with the time constant `memory` (Singer 1970); inf: it doesn't */
  ETHD_FILTER_HOLD,       /* the last reading, at rest */
  ETHD_FILTER_ALPHA_BETA, /* fixed gains: x += alpha r, v += beta r / (time since the last reading) */
  ETHD_FILTER_CV,         /* Kalman, constant velocity: Q = acceleration^2 g g^T, g = (T^2/2, T) */
  ETHD_FILTER_COUNT
} ethd_filter_method;

ETHD_API extern const ethd_method ethd_filter_methods[ETHD_FILTER_COUNT];

/* The ring's position to which a relative reading is added ([finger_filter] reference): that at the sample's instant,
   or that of the tick. */
enum { ETHD_REFERENCE_SAMPLE = 0, ETHD_REFERENCE_TICK = 1 };

/* [finger_filter] compensation. */
enum { ETHD_COMPENSATION_STAMP = 0, ETHD_COMPENSATION_NONE = 1 };

/* A checked filter. Plain value. */
typedef struct ethd_filter {
  ethd_filter_method method;
  int reference, compensation;
  int reserved;
  double period;
  double p[ETHD_PARAMS_MAX]; /* as posted */
} ethd_filter;

/* State of the filter: numbers only. Zeroed: not started. In the plane the third components are 0. */
typedef struct ethd_filter_state {
  double x[3], v[3], a[3]; /* m, m/s, m/s^2 */
  double cov[6];           /* of one axis: xx xv xa vv va aa */
  double age;              /* s from the last used reading's stamp to now. After a start: -latency (stamp: so that
                              older readings are late), inf (none) */
  uint32_t started;
  uint32_t used, late, gated, restarts; /* readings counted */
  uint32_t gated_in_a_row;
  uint32_t acquired; /* readings in space used since the start, with that of the start; up to ETHD_FILTER_ACQUIRED */
  uint32_t reserved;
} ethd_filter_state;

#define ETHD_FILTER_GATED_MAX 5

/* Checks p against the method's table, and the period (1e-6 to 1 s): ETHD_E_RANGE, ETHD_E_NOT_FINITE or,
   for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_filter_prepare(ethd_filter_method method, const double *p, double period,
                                                         ethd_filter *out, ethd_error *error);

/* Starts the filter now at x, m, with velocity v, m/s, both in R_0, and the covariance diag(1e-6 m^2, 1e-4 m^2/s^2, 1
   m^2/s^4). Counters stay. [rt] */
ETHD_API void ethd_filter_start(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, ethd_vec v) ETHD_RT;

/* Lets dt s pass, in the plane and in space. [rt] */
ETHD_API void ethd_filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) ETHD_RT;

/* Takes a reading of the finger's position, m in R_0, stamped `age` s ago. A filter that isn't started starts there, at
   rest, with standard deviations of 1 m/s and 10 m/s^2. ETHD_STATUS_STALE: the reading is counted but not used, because
   it is not newer than the last used one (late), not finite, or over `gate` standard deviations from the prediction:
   the length of the innovation in both axes against sqrt(P_xx + noise^2) (gated). The ETHD_FILTER_GATED_MAX-th gated
   reading in a row starts the filter again, since then the filter is wrong, not the readings. [rt] */
ETHD_API ethd_status ethd_filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                        double age) ETHD_RT;

/* Gives the finger's present position, m, and velocity, m/s, in R_0. [rt] */
ETHD_API void ethd_filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x,
                                 ethd_vec *v) ETHD_RT;

/* ---- the same in space ---- */

/* The three axes are those of any frame that doesn't rotate, for example a headset's. */

#define ETHD_FILTER_NOISE_MAX 0.05   /* m: largest sd that a reading may state */
#define ETHD_FILTER_V_NOISE_MAX 10.0 /* m/s */
#define ETHD_FILTER_LOSS 0.1         /* s between two used readings after which the finger counts as lost */
#define ETHD_FILTER_ACQUIRED 8       /* readings used after which the filter has acquired the finger */

/* A reading of the finger, for example from a headset. The Kalman filters use noise and velocity, the others don't. */
typedef struct ethd_filter_reading {
  ethd_vec3 x, v;    /* m, m/s */
  double age;        /* s from its stamp to now */
  double noise;      /* sd of x in each axis, m, up to ETHD_FILTER_NOISE_MAX; 0: the filter's parameter */
  double v_noise;    /* sd of v in each axis, m/s, up to ETHD_FILTER_V_NOISE_MAX; 0: v wasn't measured */
  bool extrapolated; /* the tracker has extrapolated x and v to now: they count as of now, at any age */
} ethd_filter_reading;

/* Starts the filter at x, m, with velocity v, m/s, as ethd_filter_start does. [rt] */
ETHD_API void ethd_filter_start3(const ethd_filter *filter, ethd_filter_state *state, ethd_vec3 x, ethd_vec3 v) ETHD_RT;

/* Takes a reading as ethd_filter_update does, with these differences:

   - A measured velocity corrects too, after the position, and is gated against sqrt(P_vv + v_noise^2). If either is
     gated, the reading isn't used. A start from such a reading takes over its velocity.
   - A filter whose last used reading was taken over ETHD_FILTER_LOSS before this one starts again (`restarts`).
   - After every start the filter acquires the finger: the reading that follows n used ones has the gate widened by
     1 + 4 / n^(3/2), until n = ETHD_FILTER_ACQUIRED: 5, 2.4, 1.8, 1.5, 1.4, 1.3, 1.2. A tracker that is noisier than it
     states by this factor loses no more readings than `gate` implies: 1 in 900 at 4, as P(chi^2 > 16) with three
     degrees of freedom. A test that knows the noise from n readings only must be wider by this factor: sqrt(F(3, 3 n) /
     F(3, inf)) at this probability, or up to 17 % more. While `acquired` < ETHD_FILTER_ACQUIRED, a gated reading is no
     sign of a broken tracker.

   ETHD_STATUS_STALE: late or gated, as in the plane; a noise that isn't finite or isn't within its range counts as
   gated, too. [rt] */
ETHD_API ethd_status ethd_filter_update3(const ethd_filter *filter, ethd_filter_state *state,
                                         const ethd_filter_reading *reading) ETHD_RT;

/* Gives the finger's present position, m, and velocity, m/s. [rt] */
ETHD_API void ethd_filter_output3(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec3 *x,
                                  ethd_vec3 *v) ETHD_RT;

ETHD_END_DECLS

#endif
