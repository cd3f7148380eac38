#!/bin/sh
# Coverage: sh tests/coverage.sh [lib|drivers|mcdc]... (lib): builds a tree of its own with the compiler's counters, runs the
# tests in it and names what they don't reach.
#   lib      every branch of lib by unit tests; what can't be taken is excused beside its line (tests/coverage.py)
#   drivers  90 % of the branches of drivers, by unit tests and scripts
#   mcdc     which conditions of lib/control, lib/guard and lib/law were seen to decide on their own (gcc 14's
#            -fcondition-coverage; skipped by name with another compiler)
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top" || exit 1
MAKE=${MAKE:-make} BUILD=${BUILD:-build} CC=${CC:-cc}
# Functions that are always inlined would be counted once for each caller.
flags='-O0 -g --coverage -Dalways_inline='
export CK_TIMEOUT_MULTIPLIER="${CK_TIMEOUT_MULTIPLIER:-60}" TEST_TIMEOUT="${TEST_TIMEOUT:-3600}" # times don't matter here
export CCACHE_DISABLE=1 ETHD_SCENE_QUERIES="${ETHD_SCENE_QUERIES:-2000}"
failed=0

gcov_of() { # gcc-14 -> gcov-14
  for gcov in "$(echo "$CC" | sed 's/gcc/gcov/; s/^cc$/gcov/')" gcov; do
    command -v "$gcov" >/dev/null && { echo "$gcov"; return; }
  done
}

# All tests but those that mostly wait for peers in real time.
quick() { ls tests/*/test_*.c | sed 's|.*/||; s|[.]c$||' | grep -v -e '^test_injection$' -e '^test_ring_' -e '^test_servo_'; }

# A process that ends by _exit leaves its counts, too.
leave() {
  mkdir -p "$BUILD"
  leave=$(cd "$BUILD" && pwd)/coverage-exit.o
  printf 'void __gcov_dump(void); void __real__exit(int);\nvoid __wrap__exit(int code) { __gcov_dump(); __real__exit(code); }\n' |
    $CC -fPIC -x c -c -o "$leave" -
}

# run TREE FLAGS TESTS: what fails under the counters is said and doesn't count against coverage twice
run() {
  $MAKE --no-print-directory SETUP=no BUILD="$1" CC="$CC" CFLAGS="$2" LDFLAGS="-Wl,--wrap=_exit $leave" SAN= TESTS="$3" check >"$1.log" 2>&1 ||
    { grep -E '^  FAIL|rror' "$1.log" | head -n 20; failed=1; }
  grep -E '^[0-9]+ passed' "$1.log"
}

branches() { # the compiler must be gcc: it counts as gcov reads
  $CC --version | grep -qi 'gcc\|free software' || { echo 'SKIP: coverage needs gcc'; exit 77; }
}

branches
leave
for what in "${@:-lib}"; do
  tree=$BUILD/coverage
  case $what in
    lib)
      run "$tree" "$flags" "$(quick | tr '\n' ' ')"
      python3 tests/coverage.py --gcov "$(gcov_of)" "$tree" lib || failed=1
      ;;
    drivers)
      run "$tree" "$flags" 'test_% driver_files bad_devices check_device conform conform_bus bounds run replay npy outputs
        strangers record_metrics excite servo_rows hints scene calibrate convert bad_input passive replay_device tap study
        camera hostile_plugins servo_drive examples servo_bus whole_device first_touch'
      python3 tests/coverage.py --gcov "$(gcov_of)" --least 0.9 "$tree" drivers || failed=1
      ;;
    mcdc)
      if echo 'int main(void) { return 0; }' | $CC -fcondition-coverage -x c -c -o /dev/null - 2>/dev/null; then
        tree=$BUILD/coverage-mcdc
        run "$tree" "$flags -fcondition-coverage" "$(quick | tr '\n' ' ')"
        python3 tests/coverage.py --gcov "$(gcov_of)" --conditions --least 0.95 "$tree" lib/control lib/guard lib/law || failed=1
      else
        echo "SKIP: MC/DC: $CC doesn't know -fcondition-coverage (gcc 14 does)"
      fi
      ;;
    *)
      echo "coverage: $what: lib, drivers and mcdc are known"
      exit 2
      ;;
  esac
done
exit $failed
