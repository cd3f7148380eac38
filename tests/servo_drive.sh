#!/bin/sh
# The servo before a drive of another's making: an SVD48V as its manual has it, by pymodbus, on a serial line at 500 kBd,
# with its checksum, its refusals, its faults, and two joints that its currents move. No time is asserted here.
set -u
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
folder=$(mktemp -d)
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
says() { # FILE PATTERN...
  file=$1
  shift
  for pattern; do grep -q -e "$pattern" "$file" || { fail "no $pattern in:"; cat "$file"; }; done
}
. tests/peers/pymodbus.sh
. tests/peers/drive.sh

# ---- the probe: which checksum answers, what is read ----
drive svd48v
slow_map apps/config/svd48v.map "$folder/svd48v.map"
probe=$BUILD/bin/ethd-servo-probe
"$probe" --map "$folder/svd48v.map" --port "$line" --duration 0.5 >"$folder/probe" 2>&1 || fail "probe: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^checksum .*low-first: no answer, high-first: it answers' ' bus_voltage  *raw 480 *48 V' ' position2 .*address unconfirmed'
says "$folder/probe" '^answers .* 0 damaged or refused' '^unconfirmed .*of .* registers'
sed 's/^crc = .*/crc = low-first/' "$folder/svd48v.map" >"$folder/other.map"
"$probe" --map "$folder/other.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "other order: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^mend .*crc = high-first is needed, the map says low-first' ' bus_voltage  *raw 480 *48 V'
# registers that its table hasn't are refused, not guessed: a read over the gap as well
sed -e 's/^gap = .*/gap = 4/' -e '/^every/d' "$folder/svd48v.map" >"$folder/gap.map"
"$probe" --map "$folder/gap.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 && fail "a read over the gap passes"
drive_ends
drive svd48v --crc low-first
"$probe" --map "$folder/svd48v.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "standard order: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^mend .*crc = low-first is needed, the map says high-first'
drive_ends

# ---- homing: refused without, found at its stops, lost with its power ----
run=$BUILD/bin/ethd-run
cp apps/config/wall.scene "$folder"
drive svd48v
tell turn 0.2 -0.4 >/dev/null
servo_ini lost svd48v.map
"$run" --config "$folder/lost.ini" --duration 1 >"$folder/lost" 2>&1 </dev/null && fail "started without a reference"
says "$folder/lost" 'nobody knows where joint 1 stands: home it; or stand the arm in its jig'
servo_ini home svd48v.map 'home = stop' 'q1 = 1.25' 'q2 = -0.75' 'home_way2 = -1' 'home_speed = 0.5'
printf 'status\nstop\n' | "$run" --config "$folder/home.ini" --home --record "$folder/homed" >"$folder/home" 2>&1 ||
  fail "homing: exit $?: $(cat "$folder/home")"
says "$folder/home" '^device: a guardian process writes zero torque within' '^device: .* registers are unconfirmed' '^ok: t '
# the joints stand at the drive's stops, 1 and -1, or where they rolled to, and are read 0.25 more
"$python3" - "$folder/homed/tick.npy" $(tell state) <<'END' || fail "the joints aren't where they were found: $(cat "$folder/home")"
import sys
import numpy as np
q = np.load(sys.argv[1])["q"][-1]
true = [float(v) for v in sys.argv[7:9]]
print("joints", q, "the drive's", true)
assert abs(q[0] - true[0] - 0.25) < 2e-3 and abs(q[1] - true[1] - 0.25) < 2e-3
assert true[0] > 0.9 and true[1] < -0.9
END
drive_ends

[ $failed = 0 ] && echo "probed in both orders, homed at its stops"
exit $failed
