#!/bin/sh
# The passivity observer doesn't change the built-in laws: with a bound on the energy their taps have the same bytes. What
# the law that looks ahead feeds forward before a touch reaches the finger only through the ring's motion: at the touch its
# speed is 0.05 m/s rms, which is m v^2/2 = 0.15 mJ at 0.12 kg.
. tests/begin.sh
tap() { # OUT ARGUMENTS
  out=$1
  shift
  "$BUILD/bin/ethd-tap" --plant "$plant" --transition abrupt,smooth,offset,predictive --seed 7 --csv "$out" "$@" \
    >"$folder/out" 2>&1 || { echo "FAILED plant $plant: $(cat "$folder/out")"; failed=1; }
}
while read -r plant bound; do
  cp apps/config/*.scene "$folder"
  { cat "apps/config/$plant.ini"; printf '\n[limits]\nenergy = %s\n' "$bound"; } >"$folder/$plant.ini"
  tap "$folder/without.csv" --taps 3
  tap "$folder/with.csv" --taps 3 --config "$folder/$plant.ini"
  cmp "$folder/without.csv" "$folder/with.csv" || { echo "FAILED plant $plant: $bound J touches its taps"; failed=1; }
  tap "$folder/touch.csv" --taps 40 --validity finger --transition predictive
  awk -F, '$5 == 1 { n++; s += $8 * $8 } END { exit !(n > 10 && sqrt(s / n) <= 0.05) }' "$folder/touch.csv" ||
    { echo "FAILED plant $plant: the ring moves too fast at the touch"; failed=1; }
done <<'END'
n 0.0005
b 0.0005
p 0.02
END
exit $failed
