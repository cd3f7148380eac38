#!/bin/sh
# The servo before a drive of another's making: an SVD48V as its manual has it, by pymodbus, on a serial line at 500 kBd,
# with its checksum, its refusals, its faults, and two joints that its currents move. No time is asserted here.
set -u
. tests/peers/desk.sh
. tests/peers/drive.sh

# ---- the probe: which checksum answers, what is read ----
drive svd48v
slow_map apps/config/svd48v.map "$folder/svd48v.map"
conform=$BUILD/bin/ethd-conform
"$conform" --probe "$folder/svd48v.map" --port "$line" --duration 0.5 >"$folder/probe" 2>&1 || fail "probe: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^checksum .*low-first: no answer, high-first: it answers' ' bus_voltage  *raw 480 *48 V'
says "$folder/probe" '^divisor .* at 1 ms ticks: ' '^wire .* 93 bytes in 5 questions: 2.245 ms of wire and silence'
"$conform" --probe "$folder/svd48v.map" --port "$line" --duration 0.2 --try-watchdog >"$folder/tried" 2>&1 || fail "watchdog: exit $?: $(cat "$folder/tried")"
says "$folder/tried" '^watchdog .*it is enabled still after 1 s of silence: it has none; the map says none'
says "$folder/probe" '^answers .* 0 damaged or refused'
# the joints at 0.2 and -0.4 rad are 1528 and -3056 counts of 48000 a turn; read the other way round, far more than a turn
says "$folder/tried" '^order .*position1 high-first: 0 rad, low-first: 0 rad: both are possible: turn the joint'
tell turn 0.2 -0.4 >/dev/null
"$conform" --probe "$folder/svd48v.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "words: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^order .*position1 high-first: 131.* rad, low-first: 0.200.* rad: low-first is plausible; the map says low-first'
says "$folder/probe" '^order .*position2 high-first: .* rad, low-first: -0.400.* rad: low-first is plausible; the map says low-first'
grep -q '^mend' "$folder/probe" && fail "an order that is right is mended"
sed 's/^counts = 4000/counts = 40/' "$folder/svd48v.map" >"$folder/other.map"
"$conform" --probe "$folder/other.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "absurd: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^order .*position1 .*low-first: 20.0.* rad: both are absurd: check address, type, counts and ratio'
sed 's/^crc = .*/crc = low-first/' "$folder/svd48v.map" >"$folder/other.map"
"$conform" --probe "$folder/other.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "other order: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^mend .*crc = high-first is needed, the map says low-first' ' bus_voltage  *raw 480 *48 V'
# registers that its table lacks are refused, not guessed, and so is a read across the gap
sed -e 's/^gap = .*/gap = 4/' -e '/^every/d' "$folder/svd48v.map" >"$folder/gap.map"
"$conform" --probe "$folder/gap.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 && fail "a read over the gap passes"
drive_ends
drive svd48v --crc low-first
"$conform" --probe "$folder/svd48v.map" --port "$line" --duration 0.3 >"$folder/probe" 2>&1 || fail "standard order: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^mend .*crc = low-first is needed, the map says high-first'
drive_ends
# a drive that has the high word first, as a public firmware reads it: what the hand does is told in the right order
drive svd48v --order high-first
"$conform" --probe "$folder/svd48v.map" --port "$line" --duration 0.3 --by-hand 3 >"$folder/probe" 2>&1 &
probing=$!
await "$folder/probe" '^by hand'
for angle in 0.1 0.2 0.3; do tell turn $angle -0.1 >/dev/null; done
wait $probing || fail "high word first: exit $?: $(cat "$folder/probe")"
says "$folder/probe" ' position1 went +0.3000 rad: its sign is right' '^order .*position1 high-first: 0.300.* rad, low-first: .*: high-first is plausible; the map says low-first'
says "$folder/probe" '^mend .*order = high-first is needed for position1, the map says low-first' '^mend .*order = high-first is needed for position2'
drive_ends

# ---- noise in place of an answer: our framing recognises it by its first bytes; libmodbus, as the README says, waits for
# the rest of an answer until `response`, 0.5 s, is over. A busy machine makes the first time longer, and the second one
# shorter by what it took to pass the question on; so the least and the most of several are looked at ----
noise() { # ORDER: "least most", s until the next question, in $noticed; $folder/probe
  sed "s/^crc = .*/crc = $1/" "$folder/svd48v.map" >"$folder/noise.map"
  for seconds in 3 15 60; do # a machine that is busy has few exchanges a second
    drive svd48v --crc "$1"
    "$conform" --probe "$folder/noise.map" --port "$line" --duration $seconds >"$folder/probe" 2>&1 &
    probing=$!
    for _ in $(seq 200); do
      [ "$(tell requests)" -gt 100 ] && break
      kill -0 $probing 2>/dev/null || break
      sleep 0.05
    done
    tell noise 3 3 >/dev/null
    wait $probing || fail "noise, $1: exit $?: $(cat "$folder/probe")"
    noticed=$(tell noticed)
    drive_ends
    echo "noise, $1: the next question came $noticed s after it (least, most)"
    case $noticed in -*) ;; *) break ;; esac
  done
}
noise high-first
echo "$noticed" | awk '{ exit !($1 > 0 && $1 < 0.5) }' || fail "our framing waits for an answer that has begun wrong: $noticed"
says "$folder/probe" '^answers .* [1-9][0-9]* damaged or refused'
noise low-first
echo "$noticed" | awk '{ exit !($2 >= 0.45) }' || fail "libmodbus names noise sooner than the README says: $noticed"
says "$folder/probe" '^answers  *[1-9][0-9]* missing'

# ---- homing: refused without, found at its stops, lost with its power ----
cp apps/config/wall.scene "$folder"
# from here on the clock is virtual: an answer that comes late is waited for
sed -i 's/^response = .*/response = 5/' "$folder/svd48v.map"
drive svd48v --lock-step 0.005
tell turn 0.2 -0.4 >/dev/null
servo_ini lost svd48v.map
"$run" --config "$folder/lost.ini" --duration 1 >"$folder/lost" 2>&1 </dev/null && fail "started without a reference"
says "$folder/lost" 'the angle of joint 1 is unknown: home it; or stand the arm in its jig'
servo_ini home svd48v.map 'home = stop' 'q1 = 1.25' 'q2 = -0.75' 'home_way2 = -1' 'home_speed = 0.5'
printf 'status\nstop\n' | "$run" --config "$folder/home.ini" --home --virtual --duration 1 --record "$folder/homed" >"$folder/home" 2>&1 ||
  fail "homing: exit $?: $(cat "$folder/home")"
says "$folder/home" '^device: a guardian process writes zero torque within' '^ok: t '
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

# ---- what goes wrong at the drive, in its own time: 5 ms an exchange, in lock-step with a virtual clock. A hand holds the
# joints, a wall pushes with 0.3 Nm, 0.64 A; s until no torque is asked for any more, and what ethd-run says of it ----
# a row of one exchange, where its register is read every second time: 10 ms, and two exchanges until zero is there
broken alarm alarm 0.02 'the drive reports a fault'
# an error word, read every fourth time, of a motor that goes on: 20 ms and two exchanges
broken warned 'warn 2' 0.03 'the drive reports a fault'
broken supply 'volts 70' 0.26 "the drive's supply is out of its range"
broken dead dead 0.04 "the drive doesn't follow the torque"
broken garbled 'garble 1' never
broken stale 'stale 1' never
# its power goes and comes back: the drive has stopped, and where the joints are is no longer known
broken cycled cycle 0.02 'the drive reports a fault' 'wait 1\nack\nenable'

[ $failed = 0 ] && echo "probed in both orders, homed at its stops, broken in seven ways"
exit $failed
