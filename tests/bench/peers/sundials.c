// flags: -lsundials_cvode -lsundials_nvecserial -lm
// SUNDIALS CVODE: Adams' methods, roots by its own search, started anew at each change.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "bench/ode.h"

typedef struct solver {
  ethd__ode ode;
  SUNContext context;
  N_Vector y;
  SUNNonlinearSolver fixed_point;
  void *cvode;
} solver;

static int rate(realtype t, N_Vector y, N_Vector out, void *self) {
  const solver *s = self;
  s->ode.rate(s->ode.self, t, NV_DATA_S(y), NV_DATA_S(out));
  return 0;
}

static int watch(realtype t, N_Vector y, realtype *out, void *self) {
  const solver *s = self;
  s->ode.watch(s->ode.self, t, NV_DATA_S(y), out);
  return 0;
}

static void quiet(int code, const char *module, const char *function, char *message, void *self) {
  (void)code, (void)module, (void)function, (void)message, (void)self;
}

static void *create(const ethd__ode *ode, double tolerance) {
  solver *s = calloc(1, sizeof *s);
  if (!s) return NULL;
  s->ode = *ode;
  SUNContext_Create(NULL, &s->context);
  s->y = N_VNew_Serial(ETHD__ODE_SIZE, s->context);
  N_VConst(0, s->y);
  s->cvode = CVodeCreate(CV_ADAMS, s->context);
  CVodeInit(s->cvode, rate, 0, s->y);
  CVodeSetErrHandlerFn(s->cvode, quiet, NULL);
  CVodeSetUserData(s->cvode, s);
  CVodeSStolerances(s->cvode, 0, tolerance);
  CVodeSetMaxNumSteps(s->cvode, 1000000);
  s->fixed_point = SUNNonlinSol_FixedPoint(s->y, 0, s->context);
  CVodeSetNonlinearSolver(s->cvode, s->fixed_point);
  CVodeRootInit(s->cvode, 2, watch);
  return s;
}

static void work(void *self, double t, double end, double *y) {
  solver *s = self;
  while (t < end) {
    int roots[2] = {0, 0};
    memcpy(NV_DATA_S(s->y), y, ETHD__ODE_SIZE * sizeof *y);
    CVodeReInit(s->cvode, t, s->y);
    CVodeSetStopTime(s->cvode, end);
    realtype reached = t;
    int status = CVode(s->cvode, end, s->y, &reached, CV_NORMAL);
    memcpy(y, NV_DATA_S(s->y), ETHD__ODE_SIZE * sizeof *y);
    if (status < 0) {
      memset(y, 0xff, ETHD__ODE_SIZE * sizeof *y); /* NaN: seen as an error */
      return;
    }
    t = status == CV_ROOT_RETURN && reached < end ? reached : end;
    if (status != CV_ROOT_RETURN) continue;
    CVodeGetRootInfo(s->cvode, roots);
    for (int i = 0; i < 2; i++)
      if (roots[i] < 0) {
        s->ode.change(s->ode.self, i);
        break;
      }
  }
}

static void destroy(void *self) {
  solver *s = self;
  CVodeFree(&s->cvode);
  SUNNonlinSolFree(s->fixed_point);
  N_VDestroy(s->y);
  SUNContext_Free(&s->context);
  free(s);
}

extern const ethd__peer_ode peer_ode[];
const ethd__peer_ode peer_ode[] = {
    {"CVODE " SUNDIALS_VERSION " Adams with roots", 1e-5, 1e-11, 10, 0, create, work, destroy},
    {0},
};
