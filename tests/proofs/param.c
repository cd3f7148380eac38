/* Of a parameter's row and value, whatever they are: what ethd_params_check takes is a number within the row's
   range, and whole where the row has words; what it refuses isn't. Of a name of any bytes: is_name reads none
   behind its end. */
#include <math.h>
/* CBMC doesn't know the quiet comparisons; it knows no traps either. */
#undef isgreaterequal
#undef islessequal
#define isgreaterequal(x, y) ((x) >= (y))
#define islessequal(x, y) ((x) <= (y))
#define __builtin_isfinite(v) __CPROVER_isfinited(v)
#include "../../lib/error.c"
#include "../../lib/param.c"

double nondet_double(void);
_Bool nondet_bool(void);

int main(void) {
  const _Bool words = nondet_bool();
  const ethd_param row = {"gain", words ? "off|on" : "1", nondet_double(), nondet_double(), nondet_double(), "a gain"};
  const double value = nondet_double();
  ethd_error error;
  const ethd_status status = ethd_params_check(&row, 1, &value, nondet_bool() ? &error : 0);
  const _Bool fits = value >= row.min && value <= row.max && (!words || value == floor(value));
  __CPROVER_assert((status == ETHD_OK) == fits, "taken exactly where it fits");
  __CPROVER_assert(status != ETHD_OK || !isnan(value), "what is taken is a number");
  char name[NAME_MAX_LENGTH + 3];
  name[NAME_MAX_LENGTH + 2] = 0;
  if (is_name(name)) __CPROVER_assert(name[0] && name[0] != '.', "a name");
  return 0;
}
