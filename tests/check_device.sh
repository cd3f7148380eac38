#!/bin/sh
# ethd-check on every kind of device, without touching it: no port that is named here exists. The time on the wire is held
# against the frames' lengths as the Modbus specification has them (V1.1b3: function 3 has 8 bytes and 5 + 2n, 16 has 9 + 2n
# and 8, with RTU's address and checksum), ten bits a byte, and 3.5 characters of silence before each.
. tests/begin.sh
cp apps/config/*.map apps/config/*.plant apps/config/wall.scene "$folder"
configure() { { sed '/^\[device\]/,$d' apps/config/n.ini; printf '[device]\n'; printf '%s\n' "$@"; } >"$folder/c.ini"; }
check() { "$BUILD/bin/ethd-check" "$@" "$folder/c.ini" >"$folder/out" 2>"$folder/err"; }
says() {
  check || fail "exit $?: $(cat "$folder/err")"
  for pattern; do grep -q -e "$pattern" "$folder/out" || fail "no $pattern in: $(sed -n '/^drivers/,$p' "$folder/out" | head -n 12)"; done
}
refuses() { refuse 2 "$1" check; } # PATTERN

# ---- a servo: written are 2 words and 1, read 1, 2 and 4, in five questions ----
wire=$(awk 'BEGIN { bytes = (9 + 4 + 8) + (9 + 2 + 8) + (8 + 5 + 2) + (8 + 5 + 4) + (8 + 5 + 8)
  printf "%d bytes, %.3g ms", bytes, 1e3 * (bytes * 10 + 5 * 3.5 * 11) / 500000 }')
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty' 'q1 = 0.5' 'q2 = 1'
says "^drivers  *servo: read, not touched" "an exchange: 5 messages, $wire of wire" 'divisor 5 gives it 5 ms: it holds, 4 would' \
  'guardian process writes zero torque within 20 ms' 'limits  *torque 1.167 Nm, speed 1.2 m/s' \
  'delay 5 ms; encoder count 32.72 um'
printf '[limits]\ntorque = 0.04\n' >>"$folder/c.ini"
says 'one count of torque1 is 0.0467 Nm at the joint, over the limit of 0.04 Nm: its torque is always 0'
# the joints' inertia is given twice: 0.1173 kg at 0.25 m are 0.00733 kg m^2; 0.05 is 6.8 times as much, 0.001 a seventh
for inertia in 0.05:'a pushing hand may be mistaken' 0.001:"a reversed encoder isn't noticed"; do
  sed "s/^counts = 4000/counts = 4000\ninertia = ${inertia%%:*}/" apps/config/svd48v.map >"$folder/weighed.map"
  configure 'driver = servo' 'map = weighed.map' 'port = /nowhere/tty'
  says "inertia of joint 1 is ${inertia%%:*} kg m^2, but arm.mass_x = 0.117 kg on a link of 0.25 m makes 0.00733: ${inertia#*:}"
done
configure 'driver = servo, counter' 'servo.map = plant.map' 'counter.counts_per_turn = 4000' 'counter.ratio = 10' 'counter.inertia = 0.001' 'counter.reverse_torque = 0.2'
says "inertia of joint 2 is 0.001 kg m^2, but arm.mass_y = 0.25 kg .* makes 0.0156: a reversed encoder isn't noticed"
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty'
check && grep -q 'inertia of joint' "$folder/out" && fail "an inertia that agrees is doubted"
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
says '^drivers  *servo, ring: read' 'over tcp only ethd-conform --probe can say' "finger's readings 4.1 ms old" 'fades after 10 ms, it stops after 30 ms'
configure 'driver = servo, ring' 'servo.map = plant.map' 'ring.port = /nowhere/ring' 'ring.calibration = missing.ini'
refuses 'missing.ini: No such file'
configure 'driver = servo, counter' 'servo.map = plant.map' 'counter.counts_per_turn = 4000' 'counter.ratio = 10'
says "counter.reverse_torque is inf: a reversed encoder isn't noticed" 'encoder count 40.07 um'
configure 'driver = counter' 'counts_per_turn = 0'
refuses 'c.ini:.*counts_per_turn'
configure 'driver = hello'
says '^drivers  *hello: read' 'limits  *torque 1 Nm, speed no limit, gap between samples 5 ms' \
  'tracking fades after no limit, it stops after no limit' \
  'delay 5 ms;' 'delay: unknown, taken as the longest spacing that limits.gap allows (--open measures it, --delay gives it)'
# of a delay that nobody knows the worst is taken: the same bounds as with that delay
sed -n '/^stability/,/^passivity/p' "$folder/out" >"$folder/unknown"
check --delay 5 && sed -n '/^stability/,/^passivity/p' "$folder/out" | cmp - "$folder/unknown" || fail "an unknown delay isn't the worst one"
check --delay 0 && sed -n '/^stability/,/^passivity/p' "$folder/out" | cmp -s - "$folder/unknown" && fail "an unknown delay counts as none"
printf '[limits]\ngap = 0.002\n' >>"$folder/c.ini"
says 'delay 2 ms;'
# open, it is measured: a device that gives its samples every 8 ms
cat >"$folder/slow.c" <<'END'
#include <ethd/control.h>
#include <ethd/driver.h>
static int64_t last;
static char one;
static ethd_status open_it(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  return (void)def, (void)message, *device = &one, ETHD_OK;
}
static ethd_status start(void *device) { return (void)device, ETHD_OK; }
static ethd_status read_it(void *device, int64_t now_ns, ethd_sense *out) {
  if (now_ns - last < 8000000) return ETHD_STATUS_STALE;
  out->q[0] = 1.57;
  out->time_ns = last = last && now_ns - last < 16000000 ? last + 8000000 : now_ns;
  return (void)device, ETHD_OK;
}
static ethd_status write_it(void *device, int64_t now_ns, const ethd_command *command) {
  return (void)device, (void)now_ns, (void)command, ETHD_OK;
}
static void safe(void *device) { (void)device; }
static void close_it(void *device) { (void)device; }
static ethd_limits limits(const void *device) { return (void)device, ethd_limits_torque(1); }
const ethd_driver ethd_driver_plugin = {.size = sizeof(ethd_driver), .abi = ETHD_DRIVER_ABI, .id = "slow", .brief = "slow",
  .open = open_it, .start = start, .read = read_it, .write = write_it, .safe = safe, .close = close_it, .limits = limits,
  .prepare = open_it};
END
if [ -z "${SAN:-}" ]; then
  $CC -shared -fPIC -Iinclude "$folder/slow.c" -o "$folder/slow.so" || fail "slow.c doesn't compile"
  configure 'driver = file:slow.so'
  says 'delay: unknown, taken as the longest spacing that a device without limits.gap allows'
  check --open || fail "--open: $(cat "$folder/err")"
  awk '/^ *delay [0-9]/ { found = $2 >= 8 } END { exit !found }' "$folder/out" && grep -q 'delay: unknown, taken as the longest spacing of samples in 0.5 s' "$folder/out" ||
    fail "the spacing of 8 ms isn't found: $(grep delay "$folder/out")"
fi
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty' 'speeed = 1'
refuses 'device.speeed: servo knows'

# ---- asked to, it opens the device ----
configure 'driver = servo' 'map = svd48v.map' 'port = /nowhere/tty'
refuse 1 'svd48v.map: /nowhere/tty: No such file' check --open
[ $failed = 0 ] && echo "checked without touching: servo, ring, encoders, stacks, hello"
exit $failed
