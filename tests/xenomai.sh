#!/bin/sh
# RT=cobalt and RT=mercury with a stand-in for Xenomai: refusals, flags, and the Cobalt branch compiled and run. The names
# that both know, and the real library has, stand in xenomai/cobalt.symbols; look a new one up in that library.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: the stand-in is tried without sanitizers"; exit 77; }
at=$BUILD/xenomai
mkdir -p "$at"
here=$PWD/tests/xenomai
export XENO_STANDIN_LIB="$at/lib"
mkdir -p "$at/lib"
$CC -std=gnu11 -O1 -Wall -Wextra -D_GNU_SOURCE -shared -fPIC tests/xenomai/lib/standin.c -o "$at/lib/libxenomai-standin.so" -lpthread || exit 1

# lacks VERSION NAMES...: those that the real library of that version lacks
lacks() {
  version=$1
  shift
  for name; do
    grep -qE "^$name( $version)?\$" tests/xenomai/cobalt.symbols || echo "$name"
  done
}
for version in 3.2 3.3; do
  extra=$(lacks $version $(nm -D --defined-only "$at/lib/libxenomai-standin.so" | awk '$2 == "T" { print $3 }'))
  [ -z "$extra" ] || fail "the stand-in has what cobalt.symbols doesn't give for Xenomai $version: $extra"
done
[ "$(lacks 3.3 __real_nanosleep __cobalt_clock_nanosleep)" = __real_nanosleep ] || fail "the list of symbols isn't the real library's"

build() { $MAKE --no-print-directory SAN= WERROR=1 BUILD="$at/build" CFLAGS=-O0 "$@" >"$at/log" 2>&1; }

# refuse PATTERN ARGUMENTS...
refuse() {
  pattern=$1
  shift
  build "$@" all -n && fail "$*: not refused"
  grep -q -e "$pattern" "$at/log" || fail "$*: no $pattern in: $(tail -n 2 "$at/log")"
}
refuse 'RT=windows: posix, mercury and cobalt are known' RT=windows
refuse 'RT=cobalt: no xeno-config in PATH' RT=cobalt XENO_CONFIG=/nowhere/xeno-config
XENO_STANDIN_CORE=mercury refuse 'RT=cobalt, but .* belongs to the core mercury' RT=cobalt XENO_CONFIG="$here/xeno-config"

# Mercury: the loop's objects compile, and call libc by its own names.
export XENO_STANDIN_CORE=mercury
loop=$at/build-mercury/obj/drivers/runtime/loop
build RT=mercury XENO_CONFIG="$here/xeno-config" "$loop/cycle.o" "$loop/threads.o" "$loop/xenomai.o" || { cat "$at/log"; fail "RT=mercury"; }
nm -u "$loop/cycle.o" | grep -q ' clock_nanosleep' || fail "mercury: cycle.o doesn't sleep"
cat >"$at/init.c" <<'END'
#include <stddef.h>
int ethd__xenomai_begin(void *error);
int main(void) { return ethd__xenomai_begin(NULL) || ethd__xenomai_begin(NULL); }
END
$CC "$at/init.c" "$loop/xenomai.o" -L"$at/lib" -lxenomai-standin -Wl,-rpath,"$at/lib" -o "$at/init" || fail "mercury: init.c"
[ "$(XENO_STANDIN_SAYS=1 "$at/init" 2>&1)" = "stand-in: initialised" ] || fail "mercury: it ends the process, or isn't initialised once"

# Cobalt: built whole, and run.
export XENO_STANDIN_CORE=cobalt
cobalt=$at/build-cobalt
build RT=cobalt XENO_CONFIG="$here/xeno-config" "$cobalt/bin/ethd-run" "$cobalt/tests/test_loop" "$cobalt/tests/test_loop_thread" \
  "$cobalt/share/ethd/q.plant" || { tail -n 30 "$at/log"; fail "RT=cobalt"; exit 1; }
for name in clock_nanosleep clock_gettime; do
  nm -u "$cobalt/obj/drivers/runtime/loop/cycle.o" | grep -q " __cobalt_$name" || fail "cobalt: cycle.o doesn't call __cobalt_$name"
  nm -u "$cobalt/obj/drivers/runtime/loop/cycle.o" | grep -q " $name" && fail "cobalt: cycle.o calls $name past the core"
done
for version in 3.2 3.3; do
  extra=$(lacks $version $(nm -u "$cobalt"/obj/drivers/runtime/loop/*.o "$cobalt/obj/drivers/servo/"*.o | awk '$2 ~ /^(__cobalt_|__real_|__wrap_|xenomai_|pthread_.*_np$)/ { print $2 }' |
    sort -u | grep -vE '^pthread_(attr_)?[gs]etaffinity_np$'))
  [ -z "$extra" ] || fail "what cobalt.symbols doesn't give for Xenomai $version is called: $extra"
done
ETHD_XENOMAI_VERSION_FILE=/nowhere "$cobalt/bin/ethd-run" --duration 1 </dev/null >"$at/out" 2>&1
[ $? = 1 ] && grep -q "this kernel has no Cobalt core" "$at/out" && [ "$(wc -l <"$at/out")" = 1 ] || fail "without Cobalt in the kernel: $(cat "$at/out")"
export ETHD_XENOMAI_VERSION_FILE=/proc/version
XENO_STANDIN_AHEAD=5 "$cobalt/bin/ethd-run" --duration 1 </dev/null >"$at/out" 2>&1
[ $? = 1 ] && grep -q "Cobalt's clock is 5.000 s away from Linux's" "$at/out" || fail "clocks that differ aren't refused: $(cat "$at/out")"
"$cobalt/bin/ethd-run" --help >"$at/out" 2>&1 && grep -q -e '--require-rt' "$at/out" || fail "--help isn't ours"
XENO_STANDIN_SAYS=1 "$cobalt/bin/ethd-run" --duration 0.3 </dev/null >"$at/out" 2>"$at/err" || fail "a run: $(cat "$at/err")"
grep -q '^stand-in: initialised$' "$at/err" || fail "not initialised: $(cat "$at/err")"
grep -q "kernel isn't" "$at/err" && fail "Cobalt is called no realtime kernel"
grep -q '^relaxes  *1 switch' "$at/out" || fail "the switch to secondary mode wasn't counted: $(cat "$at/out")"
for test in test_loop test_loop_thread; do
  "$cobalt/tests/$test" >"$at/out" 2>&1 || { cat "$at/out"; fail "$test"; }
done
[ $failed = 0 ] && echo "the Cobalt branch runs; $(tail -n 1 "$at/out")"
exit $failed
