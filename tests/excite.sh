#!/bin/sh
# What ends an excitation in true time: a signal, a fault, a device that is lost, the guard, its duration, with the simulated device and with a driver
# in a file of its own. Each leaves a closed recording that repeats to the bit and ends without a torque.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit 77; }
top=$(cd "$(dirname "$0")/.." && pwd)
bin=$BUILD/bin
case $bin in /*) ;; *) bin=$top/$bin ;; esac
cd "$folder" || exit 1

$CC -shared -fPIC -DHELLO=ethd_driver_plugin -I"$top/include" "$top/drivers/hello/hello.c" -o hello.so || fail "hello.so"
printf '[device]\ndriver = file:hello.so\n' >hello.ini
printf '1 fault9 set\n' >broken.inject
printf '[device]\ndriver = sim\ninject = broken.inject\n' >broken.ini
printf '1 read fail\n' >lost.inject
printf '[device]\ndriver = sim\ninject = lost.inject\n' >lost.ini
printf '[device]\ndriver = sim\n' >sim.ini

# excite NAME CODE ARGUMENTS...: the exit code, and a recording as it should be. A tick that is 5 ms late ends a session, too,
# and so does a program that doesn't run for 0.1 s: such a
# session is tried again, three times in all.
late=
excite() {
  for _ in 1 2 3; do
    tried=
    session "$@"
    [ -n "$tried" ] || return
  done
  late=$tried
}
session() {
  name=$1 expected=$2
  shift 2
  rm -rf "./$name"
  # a shell's background jobs ignore SIGINT
  env --default-signal=INT "$bin/ethd-identify" --excite --record "$name" "$@" >"$name.out" 2>"$name.err" &
  session=$!
  if [ "${name%-*}" = told ]; then # told-SIGNAL
    for _ in $(seq 100); do [ -s "$name/tick.npy" ] && break; sleep 0.1; done
    sleep 1
    kill -s "${name#*-}" $session
  fi
  wait $session
  code=$?
  if grep -q -e 'ticks are late' -e "the loop's thread doesn't run" -e 'the application has ended' "$name.err"; then tried="$name: $(tail -n 1 "$name.err")"; return; fi
  [ $code = "$expected" ] || fail "$name: exit $code: $(cat "$name.err")"
  sed -n 3p "$name.out" | grep -q '^dry run  *on the simulated device: up to' || fail "$name: what will be done comes first: $(cat "$name.out")"
  grep -q ',end,closed$' "$name/events.csv" || fail "$name: not closed: $(tail -n 1 "$name/events.csv")"
  "$bin/ethd-replay" --verify --plugins "$name" 2>&1 | grep -q 'equal to the bit' || fail "$name: isn't repeated"
  "$PYTHON" - "$name" <<'END' || fail "$name: not without torque at the end"
import sys
import numpy as np
r = np.load(sys.argv[1] + "/tick.npy")
moved = np.abs(r["tau"]).max(axis=1) > 0
assert (moved.sum() > 200) == (sys.argv[1] != "outside"), moved.sum()
assert not r["tau"][-1].any(), r["tau"][-3:]
here = {"broken": r["faults"] & (1 << 9), "lost": r["fault"] == 37}.get(sys.argv[1])
if here is not None:  # from the same tick on, and for good; nothing is recorded for long after it
    first = int(np.flatnonzero(here)[0])
    assert not r["tau"][first:].any() and np.abs(r["tau"][first - 1]).max() > 0
    assert len(r) - first < 500, (len(r), first)
END
}

for signal in TERM INT HUP; do excite told-$signal 0 --config hello.ini --duration 60; done
excite done 0 --config sim.ini --duration 1.5
excite broken 1 --config broken.ini --duration 60
tail -n 1 broken.err | grep -q ': the drive reports a fault: correct it and record again$' || fail "broken: $(cat broken.err)"
excite lost 1 --config lost.ini --duration 60
excite outside 1 --config hello.ini --duration 60 --at 0.28,0.25 --half 0.02
[ -n "$late" ] || tail -n 1 outside.err | grep -q ': the guard stopped the ring 0.03 m from the middle of the box: put it there' || fail "outside: $(cat outside.err)"

# A full pipe that nobody reads holds nothing up: neither what is said before the device is enabled nor the summary.
"$PYTHON" - "$bin/ethd-identify" <<'END' || fail "an output that nobody reads"
import os, subprocess, sys
read, write = os.pipe()
os.set_blocking(write, False)
try:
    while os.write(write, b"x" * 4096): pass
except BlockingIOError:
    pass
os.set_blocking(write, True)
p = subprocess.run([sys.argv[1], "--excite", "--record", "unread", "--config", "hello.ini", "--duration", "1"], stdout=write,
                   stderr=subprocess.PIPE, text=True, timeout=100)
assert p.returncode == 1 and "standard output: its reader is too slow" in p.stderr, (p.returncode, p.stderr)
assert open("unread/events.csv").read().endswith(",end,closed\n")
END

# A recording that is there stays as it is.
sums() { cksum done/*; }
before=$(sums)
"$bin/ethd-identify" --excite --record done --config sim.ini --duration 1 >out 2>err
code=$?
[ $code != 0 ] && grep -q -e '--force' err && [ "$before" = "$(sums)" ] || fail "over a recording: exit $code: $(cat err)"

skip=
if [ -n "$late" ]; then
  skip=$("$PYTHON" "$top/tests/peers/late.py" 'a loop')
  [ $? = 77 ] || fail "$late; $skip"
fi
[ $failed = 0 ] || exit 1
[ -z "$skip" ] || { echo "$skip"; exit 77; }
