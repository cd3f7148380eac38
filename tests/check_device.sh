#!/bin/sh
# ethd-check on every kind of device, without touching it: no port that is named here exists. The time on the wire is held
# against the frames' lengths as the Modbus specification has them (V1.1b3: function 3 has 8 bytes and 5 + 2n, 16 has 9 + 2n
# and 8, with RTU's address and checksum), ten bits a byte, and 3.5 characters of silence before each.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
cp apps/config/*.map apps/config/*.plant apps/config/wall.scene "$folder"
configure() { { sed '/^\[device\]/,$d' apps/config/n.ini; printf '[device]\n'; printf '%s\n' "$@"; } >"$folder/c.ini"; }
check() { "$BUILD/bin/ethd-check" "$@" "$folder/c.ini" >"$folder/out" 2>"$folder/err"; }
says() {
  check || fail "exit $?: $(cat "$folder/err")"
  for pattern; do grep -q -e "$pattern" "$folder/out" || fail "no $pattern in: $(sed -n '/^drivers/,$p' "$folder/out" | head -n 12)"; done
}
refuses() { # PATTERN: one line, exit 2
  check && fail "not refused: $1"
  [ "$(wc -l <"$folder/err")" = 1 ] && grep -q -e "$1" "$folder/err" || fail "no $1 in: $(cat "$folder/err")"
}

# ---- a servo: written are 2 words and 1, read 1, 2 and 4, in five questions ----
wire=$(awk 'BEGIN { bytes = (9 + 4 + 8) + (9 + 2 + 8) + (8 + 5 + 2) + (8 + 5 + 4) + (8 + 5 + 8)
  printf "%d bytes, %.3g ms", bytes, 1e3 * (bytes * 10 + 5 * 3.5 * 11) / 500000 }')
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty' 'q1 = 0.5' 'q2 = 1'
says "^drivers  *servo: read, not touched" "an exchange: 5 messages, $wire of wire" 'divisor 5 gives it 5 ms: it holds, 4 would' \
  'guardian process writes zero torque within 20 ms' 'limits  *torque 1.167 Nm, speed 1.2 m/s' \
  'delay 5 ms; encoder count 32.72 um'
printf '[limits]\ntorque = 0.04\n' >>"$folder/c.ini"
says 'one count of torque1 is 0.0467 Nm at the joint, over the limit of 0.04 Nm: the joint never gets a torque'
# slower than it says
sed 's/^baud = .*/baud = 115200/' apps/config/svd48v.map >"$folder/slow.map"
configure 'driver = servo' 'map = slow.map' 'port = /nowhere/tty'
least=$(awk 'BEGIN { t = 1e3 * (93 * 10 + 5 * 3.5 * 11) / 115200 * 1.1; print int(t) + (t > int(t)) }')
refuses "slow.map: bus.divisor: found 5, an exchange in 5 ms; its 5 messages take 9.74 ms of wire.*: choose from $least,"
# only its slow registers are too much for the divisor
sed 's/^divisor = .*/divisor = 3/' apps/config/svd48v.map >"$folder/tight.map"
configure 'driver = servo' 'map = tight.map' 'port = /nowhere/tty'
says "3.04 with slow registers; divisor 3 gives it 3 ms: it doesn't hold, 4 would hold"
for map in roboteq akd; do
  configure 'driver = servo' "map = $map.map" 'port = /nowhere/tty'
  check || [ "$(wc -l <"$folder/err")" = 1 ] || fail "$map: $(cat "$folder/err")"
done

# ---- ring, encoders, several, replay, hello ----
configure 'driver = servo, ring' 'servo.map = plant.map' 'ring.port = /nowhere/ring'
says '^drivers  *servo, ring: read' 'over tcp only ethd-servo-probe can say' "finger's readings 4.1 ms old" 'fades after 10 ms, it stops after 30 ms'
configure 'driver = servo, ring' 'servo.map = plant.map' 'ring.port = /nowhere/ring' 'ring.calibration = missing.ini'
refuses 'missing.ini: No such file'
configure 'driver = servo, counter' 'servo.map = plant.map' 'counter.counts_per_turn = 4000' 'counter.ratio = 10'
says "counter.reverse_torque is inf: a reversed encoder isn't noticed" 'encoder count 40.07 um'
configure 'driver = counter' 'counts_per_turn = 0'
refuses 'c.ini:.*counts_per_turn'
configure 'driver = hello'
says '^drivers  *hello: read' 'limits  *torque 1 Nm, speed no limit'
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty' 'speeed = 1'
refuses 'device.speeed: servo knows'

# ---- asked to, it opens the device ----
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty'
check --open && fail "--open opened nothing"
[ "$(wc -l <"$folder/err")" = 1 ] && grep -q 'svd48v.map: /nowhere/tty: No such file' "$folder/err" || fail "--open: $(cat "$folder/err")"
[ $failed = 0 ] && echo "checked without touching: servo, ring, encoders, stacks, hello"
exit $failed
