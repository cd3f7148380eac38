#!/bin/sh
# The passivity observer leaves the paper's laws alone: with a bound on the energy their taps are the same bytes. (The law
# that looks ahead pushes the ring forward against friction, which the observer counts as energy given.)
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
while read -r plant bound; do
  cp apps/config/*.scene "$folder"
  { cat "apps/config/$plant.ini"; printf '\n[limits]\nenergy = %s\n' "$bound"; } >"$folder/$plant.ini"
  "$BUILD/bin/ethd-tap" --plant "$plant" --transition abrupt,smooth,offset --taps 3 --seed 7 --csv "$folder/without.csv" >"$folder/out" 2>&1 &&
    "$BUILD/bin/ethd-tap" --config "$folder/$plant.ini" --plant "$plant" --transition abrupt,smooth,offset --taps 3 --seed 7 --csv "$folder/with.csv" >"$folder/out" 2>&1 ||
    { echo "FAILED plant $plant: $(cat "$folder/out")"; failed=1; }
  cmp "$folder/without.csv" "$folder/with.csv" || { echo "FAILED plant $plant: $bound J touches its taps"; failed=1; }
done <<'END'
n 0.0005
b 0.0005
p 0.02
END
exit $failed
