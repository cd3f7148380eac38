#!/bin/sh
# Programs and libraries in a process that has called setlocale, where numbers have a decimal comma: what reads and writes text
# does as it does without, and golden outputs have their bytes. ETHD_WHOLE=1: whole programs as well, as make ci does.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer must be loaded first, before the host's setlocale"; exit 77; }
LOCPATH=$(sh .ci/locales) || exit 1
export LOCPATH

# The host: programs and unit tests find its locale set. What scripts run beside them isn't ours.
cat >"$folder/host.c" <<'END2'
#include <errno.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
__attribute__((constructor)) static void host(void) {
  const char *name = program_invocation_short_name;
  if (strncmp(name, "ethd-", 5) && strncmp(name, "test_", 5)) return;
  if (!setlocale(LC_ALL, getenv("HOST_LOCALE"))) abort();
}
END2
printf '#include <stdio.h>\nint main(void) { return printf("%%g", 0.5) < 0; }\n' >"$folder/comma.c"
$CC -D_GNU_SOURCE -shared -fPIC "$folder/host.c" -o "$folder/host.so" && $CC "$folder/comma.c" -o "$folder/test_comma" || exit 1

hosted() { LD_PRELOAD=$folder/host.so "$@" >"$folder/out" 2>&1 </dev/null || { fail "$HOST_LOCALE: $*"; tail -n 5 "$folder/out"; }; }
units='locale config config_refused setup_set plant_file servo_map ring_calibration scene_parse csv recording details study
  npy tables inject camera device'
for HOST_LOCALE in de_DE.UTF-8 tr_TR.ISO-8859-9; do
  export HOST_LOCALE
  hosted "$folder/test_comma"
  [ "$(cat "$folder/out")" = 0,5 ] || fail "$HOST_LOCALE: no decimal comma: $(cat "$folder/out")"
  for unit in $units; do hosted "$BUILD/tests/test_$unit"; done
done
HOST_LOCALE=de_DE.UTF-8
hosted sh tests/golden.sh once
# calibrations, recordings, MCAP, commands and telemetry, a study's files
for script in ${ETHD_WHOLE:+calibrate convert run study}; do hosted sh "tests/$script.sh"; done

# The examples' own reader: 0.5 is a number, and only what comes after it, the plants, is missing.
$CC -Iinclude apps/examples/teleop.c -o "$folder/test_teleop" "$BUILD/libethd-drivers.a" "$BUILD/libethd.a" -linih -ljansson -lmodbus \
  -lm -ldl -lpthread || fail "teleop: it isn't compiled"
env -u ETHD_DATA_DIR LD_PRELOAD="$folder/host.so" "$folder/test_teleop" $((20000 + $$ % 12000)) 0.5 >"$folder/out" 2>&1 </dev/null
[ $? = 1 ] && grep -q 'q.plant: No such file' "$folder/out" || fail "teleop: $(cat "$folder/out")"
exit $failed
