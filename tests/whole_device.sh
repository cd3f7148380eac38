#!/bin/sh
# The whole device on one desk: ethd-run, the servo over an independent Modbus server (pymodbus) with the plant behind
# it, the proximity ring through its real firmware in four simulated boards (simavr) that see the same plant. It taps under
# all three strategies, swapped on stdin; the recording replays; its figures are printed beside the simulated device's.
# ETHD_WHOLE_SECONDS: how long each strategy rules, enabled (3 by default). A busy machine trips the device's faults, as
# it must: they are acknowledged, the device is enabled again, and that is counted; too busy for a tap is a skip.
set -u
. tests/peers/desk.sh
. tests/peers/board.sh
needs_board
. tests/peers/plant.sh
seconds=${ETHD_WHOLE_SECONDS:-3}

first_rank
plant whole --speed 0.4 --period 1.6
peer --tcp 0
board
mkfifo "$folder/feed.in"
$alone "$BUILD/tests/ring_feed" "$plant" $udp 0.00732 <"$folder/feed.in" 6>&- 8>&- &
children="$children $!"
exec 5>"$folder/feed.in"
sleep 0.5

# the finger comes through the ring's rays alone
sed -e '/^\[register reading_/,/^$/d' apps/config/plant.map >"$folder/plant.map"
cp apps/config/wall.scene "$folder"
{
  sed '/^\[device\]/,$d' apps/config/n.ini
  printf '[limits]\nstop_time = 0.2\n[device]\ndriver = servo, ring\nservo.map = plant.map\nservo.port = 127.0.0.1:%s\nring.port = ring\n' "$at"
} >"$folder/device.ini"
$alone "$python3" tests/whole_device.py run "$BUILD/bin/ethd-run" "$folder" "$seconds" 5>&- 6>&- 8>&- || fail "ethd-run: $(cat "$folder/err")"
$alone "$python3" tests/whole_device.py study "$BUILD/bin/ethd-study" "$folder" 5>&- 6>&- 8>&-
study=$?
[ $study = 0 ] || [ $study = 77 ] || fail "ethd-study: $(cat "$folder/study.err")"
tail -n 45 "$folder/out" | grep -v '^ok'
"$BUILD/bin/ethd-replay" --verify "$folder/rec" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || fail "$(cat "$folder/verify")"
[ $study = 77 ] || [ "$(ls "$folder/study/taps" | wc -l)" -ge 2 ] || fail "the study's taps: $(cat "$folder/study/taps.csv")"
for tap in "$folder"/study/taps/*/; do
  [ -d "$tap" ] || continue
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/verify" 2>&1 || fail "$(cat "$folder/verify")"
done
"$python3" tests/whole_device.py judge "$folder/rec" "$BUILD/bin/ethd-tap"
taps=$?
[ $taps = 0 ] || [ $taps = 77 ] || fail "the taps aren't what they should be"
skip=
if [ $taps = 77 ] || [ $study = 77 ]; then
  skip=$($alone "$python3" tests/peers/late.py 'a device' 5>&- 6>&- 8>&-)
  [ $? = 77 ] || fail "run or study didn't come to its end; $skip"
fi
exec 5>&- 6>&- 8>&-
[ $failed = 0 ] || exit 1
[ -z "$skip" ] || { echo "$skip"; exit 77; }
