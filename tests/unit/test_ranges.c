/* What every number may be, and is by default: configurations, materials and plugins rely on it, so a change is a change
   of the interface. One hash stands for all rows; when it differs the rows are printed, to be compared with those of the
   commit before (build/run/test_ranges.log). */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ethd/law.h"
#include "unit/rig.h"

#define EXPECTED UINT64_C(0x441564190c88e8c7)

static char text[1 << 14]; /* a line for each number: owner, name, least, largest, default */

static void add(const char *owner, const ethd_param *p) {
  const size_t n = strlen(text);
  const double def = isnan(p->def) ? (double)NAN : p->def; /* one of all */
  ck_assert_int_lt(
      snprintf(text + n, sizeof text - n, "%s.%s %.17g %.17g %.17g\n", owner, p->name, p->min, p->max, def),
      (int)(sizeof text - n));
}

static void add_methods(const ethd_method *methods, int count) {
  for (int i = 0; i < count; i++)
    for (uint32_t k = 0; k < methods[i].param_count; k++) add(methods[i].id, &methods[i].params[k]);
}

TEST(test_ranges) {
  const ethd_setup setup = ethd_setup_default();
  ethd_setup_key key;
  for (const ethd_law *const *law = ethd_laws; *law; law++)
    for (uint32_t k = 0; k < (*law)->param_count; k++) add((*law)->id, &(*law)->params[k]);
  add_methods(ethd_velocity_methods, ETHD_VELOCITY_COUNT);
  add_methods(ethd_fit_methods, ETHD_FIT_COUNT);
  add_methods(ethd_filter_methods, ETHD_FILTER_COUNT);
  for (uint32_t i = 0; ethd_setup_key_at(&setup, i, &key) == ETHD_OK; i++) add(key.section, &key.param);
  uint64_t hash = UINT64_C(0xcbf29ce484222325); /* FNV-1a */
  for (const char *c = text; *c; c++) hash = (hash ^ (unsigned char)*c) * UINT64_C(0x100000001b3);
  ck_assert_msg(hash == EXPECTED, "0x%016" PRIx64 ":\n%s", hash, text);
}
