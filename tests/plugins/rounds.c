/* Loads well; behind the surface it leaves the processor rounding down, keeping or flushing small numbers as it wasn't
   told, or with a trap for division by zero. */
#include <ethd/plugin.h>
#include <fenv.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif
static ethd_status rounding_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)state, (void)out;
  if (contact->d_re >= 0) return ETHD_OK;
  if (p[0] == 0) fesetround(FE_DOWNWARD);
#if defined(__SSE__)
  if (p[0] == 1) _mm_setcsr(_mm_getcsr() ^ 0x8000u);
  if (p[0] == 2) _mm_setcsr(_mm_getcsr() & ~0x0200u);
#else
  if (p[0] != 0) fesetround(FE_UPWARD);
#endif
  return ETHD_OK;
}
static const ethd_param params[] = {{"what", "1", 0, 2, 0, "what it changes"}};
#define PARAMS params
#define PARAM_COUNT 1
#define STEP rounding_step
#include "broken.h"
