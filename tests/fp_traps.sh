#!/bin/sh
# The library's functions under the floating-point traps of an application: unit tests that hand them NaN, infinities, poles
# and refused numbers run with traps set, and none is taken. Results in each rounding and flushing mode: unit/test_fp_modes.c.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer's own code is trapped"; exit 77; }
cat >"$folder/traps.c" <<'END'
#define _GNU_SOURCE
#include <fenv.h>
__attribute__((constructor)) static void set(void) { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }
END
${CC:-cc} -shared -fPIC "$folder/traps.c" -o "$folder/traps.so" -lm || fail "the traps don't compile"
tests="arm config faults finger_filter finger_filter_maths finger_fit finger_space guard guard_limits laws linkage param path
  plant_file post scene_parse scene_refused setup_refused setup_set shapes sim sim_sensors solids solids_parse space
  space_truths stop velocity"
for test in $tests; do
  LD_PRELOAD=$folder/traps.so "$BUILD/tests/test_$test" >"$folder/out" 2>&1 || fail "test_$test: $(grep -v '^Running' "$folder/out")"
done
echo "$(echo $tests | wc -w) unit tests, no trap taken"
exit $failed
