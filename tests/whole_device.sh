#!/bin/sh
# The whole device on one desk: ethd-run, the servo over an independent Modbus server (pymodbus) with the plant behind
# it, the proximity ring through its real firmware in four simulated boards (simavr) that see the same plant. Taps under
# all three strategies, swapped on stdin; the recording replays; their figures beside the simulated device's.
# ETHD_WHOLE_SECONDS: how long each strategy rules, enabled (3 by default). A busy machine trips the device's faults, as
# it must: they are acknowledged, the device is enabled again, and that is counted; too busy for a tap is a skip.
set -u
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
seconds=${ETHD_WHOLE_SECONDS:-3}
[ -x "$BUILD/tests/ring_board" ] || { echo "SKIP: libsimavr, which runs the firmware (simavr), is absent"; exit 77; }
[ -f "$BUILD/firmware/proximity_ring.elf" ] || { echo "SKIP: avr-gcc, which makes the firmware for simavr, is absent"; exit 77; }
folder=$(mktemp -d)
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 1' HUP INT PIPE TERM
failed=0
fail() { echo "FAILED $*"; failed=1; }
await() { # FILE PATTERN
  for _ in $(seq 600); do
    grep -q -e "$2" "$1" 2>/dev/null && return
    sleep 0.05
  done
  fail "no $2 in $1: $(cat "$1")"
}
. tests/peers/pymodbus.sh
# the other side of the buses would have a machine of its own
alone=
chrt -r 40 true 2>/dev/null && alone="chrt -r 40"

mkfifo "$folder/plant.in" "$folder/board.in" "$folder/feed.in"
$alone "$BUILD/tests/plant_bridge" --speed 0.4 --period 1.6 <"$folder/plant.in" >"$folder/plant" 2>&1 &
children="$children $!"
exec 8>"$folder/plant.in"
await "$folder/plant" '^port '
plant=$(sed -n 's/^port //p' "$folder/plant")
$alone "$venv/bin/python" tests/peers/modbus_peer.py --tcp 0 --plant "$plant" >"$folder/peer" 2>&1 8>&- &
children="$children $!"
await "$folder/peer" '^ready '
udp=$((20000 + $$ % 20000))
$alone "$BUILD/tests/ring_board" --link "$folder/ring" --udp $udp "$BUILD/firmware/proximity_ring.elf" <"$folder/board.in" >"$folder/board" 2>&1 8>&- &
children="$children $!"
exec 7>"$folder/board.in"
await "$folder/board" '/dev/'
$alone "$BUILD/tests/ring_feed" "$plant" $udp 0.00732 <"$folder/feed.in" 7>&- 8>&- &
children="$children $!"
exec 6>"$folder/feed.in"
sleep 0.5

# the finger comes through the ring's rays alone
sed -e '/^\[register reading_/,/^$/d' apps/config/plant.map >"$folder/plant.map"
cp apps/config/wall.scene "$folder"
{
  sed '/^\[device\]/,$d' apps/config/n.ini
  printf '[device]\ndriver = servo, ring\nservo.map = plant.map\nservo.port = 127.0.0.1:%s\nring.port = ring\n' "$(sed -n 's/^ready //p' "$folder/peer")"
} >"$folder/device.ini"
$alone "$python3" tests/whole_device.py run "$BUILD/bin/ethd-run" "$folder" "$seconds" 6>&- 7>&- 8>&- || fail "ethd-run: $(cat "$folder/err")"
$alone "$python3" tests/whole_device.py study "$BUILD/bin/ethd-study" "$folder" 6>&- 7>&- 8>&-
busy=$?
[ $busy = 0 ] || [ $busy = 77 ] || fail "ethd-study: $(cat "$folder/study.err")"
exec 6>&- 7>&- 8>&-
tail -n 45 "$folder/out" | grep -v '^ok'
"$BUILD/bin/ethd-replay" --verify "$folder/rec" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || fail "$(cat "$folder/verify")"
[ $busy = 77 ] || [ "$(ls "$folder/study/taps" | wc -l)" -ge 2 ] || fail "the study's taps: $(cat "$folder/study/taps.csv")"
for tap in "$folder"/study/taps/*/; do
  [ -d "$tap" ] || continue
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/verify" 2>&1 || fail "$(cat "$folder/verify")"
done
"$python3" tests/whole_device.py judge "$folder/rec" "$BUILD/bin/ethd-tap"
code=$?
[ $code = 0 ] || [ $code = 77 ] || fail "the taps aren't what they should be"
[ $failed = 0 ] || exit 1
[ $code = 77 ] || [ $busy = 0 ] || echo "SKIP: this machine is too busy for a device in real time: the study didn't come to its end"
[ $busy = 0 ] || code=77
exit $code
