#!/bin/sh
# Do the drivers of real hardware keep their contract? ethd-conform asks the servo, through an independent server
# (pymodbus) with the plant behind it, in lock-step; then the servo and the proximity ring in real time, the ring being
# its real firmware in four simulated boards (simavr). The ring is empty: no finger pushes back.
set -u
. tests/peers/desk.sh
. tests/peers/plant.sh
. tests/peers/board.sh
conform=$BUILD/bin/ethd-conform

cp apps/config/wall.scene "$folder"
configure() { # NAME MAP [DRIVERS]
  sed '/^\[device\]/,$d' apps/config/n.ini >"$folder/$1.ini"
  printf '[device]\ndriver = %s\nservo.map = %s\nservo.port = 127.0.0.1:%s\n' "${3:-servo}" "$2" "$at" >>"$folder/$1.ini"
}
kept() { grep -c '^[a-z]*  *kept ' "$1"; }
verdict() { # FILE QUESTION WORDS
  grep -q "^$2  *$3" "$1" || fail "$2 isn't \"$3\": $(cat "$1")"
}

# ---- in lock-step: nothing is late ----
sed 's/^response = .*/response = 5/' apps/config/plant.map >"$folder/plant.map"
sed '/^\[register torque2\]/,/^$/s/^ratio = .*/&\nsign = -1/' "$folder/plant.map" >"$folder/reversed.map"
plant lock --lock-step 1 --period 3000 --finger 0
peer --tcp 0
ask() { # NAME MAP TORQUE
  configure "$1" "$2"
  "$conform" --config "$folder/$1.ini" --virtual --move --push "$3" >"$folder/$1" 2>&1
  code=$?
}
ask servo plant.map 0.3
[ $code = 0 ] && [ "$(kept "$folder/servo")" = 10 ] || fail "the servo: exit $code: $(cat "$folder/servo")"
grep -q '^sense .*; 150 readings of the finger$' "$folder/servo" || fail "readings: $(cat "$folder/servo")"
ask reversed reversed.map 0.3
[ $code = 1 ] || fail "reversed: exit $code"
verdict "$folder/reversed" sign BROKEN
ask weak plant.map 0.1
[ $code = 0 ] || fail "a weak push: exit $code"
for question in watchdog safe restart; do verdict "$folder/weak" $question 'not asked'; done
kill $peer
plant_ends

# ---- in real time ----
# Where this machine is too busy, feedback is late: that isn't the driver's doing, and shows in `sense` alone.
first_rank
plant live --period 3000 --finger 0
peer --tcp 0
sed '/^\[register reading_/,/^$/d' apps/config/plant.map >"$folder/live.map"
if [ -z "$absent" ]; then
  board
  configure live live.map 'servo, ring'
  echo 'ring.port = ring' >>"$folder/live.ini"
else
  configure live live.map
fi
for _ in 1 2 3; do
  $alone "$conform" --config "$folder/live.ini" --move --push 0.3 >"$folder/live" 2>&1 6>&- 8>&-
  others=$(grep -v '^sense' "$folder/live" | grep -c '^[a-z]*  *kept ')
  [ "$others" = 10 ] && grep -q -e '^sense  *kept ' -e '^sense .* it reports: ' "$folder/live" && break
  others=0
done
[ "$others" = 10 ] || fail "in real time: $(cat "$folder/live")"
if [ -z "$absent" ] && grep -q '^sense  *kept' "$folder/live"; then
  grep -q '^sense .*; 1[0-9][0-9] readings of the finger$' "$folder/live" || fail "readings: $(cat "$folder/live")"
fi
# its own watchdog lets go at 50 ms, and the next question finds it well again
verdict "$folder/live" silence kept
exec 6>&-
kill $peer
plant_ends
cat "$folder/live"
[ $failed = 0 ] || exit 1
needs_board
