#!/bin/sh
# ethd-identify on taps: it finds finger, hand and pad of two plants again, from recordings without what only a simulation
# knows; it says that touches are too few, and what they can't tell.
# PLANTS=12 tries that many random plants, elastic ones too, whose hand brakes soon behind the wall, and the intervals' coverage.
set -u
bin=$BUILD/bin
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tests=$(cd "$(dirname "$0")" && pwd)
cd "$folder" || exit 1
failed=0
fail() { echo "FAILED $*"; failed=1; }
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for fits"; exit 77; }

if [ -n "${PLANTS:-}" ]; then
  exec "$PYTHON" "$tests/identify_hands.py" "$bin" "$tests/../apps/config" "$PLANTS" 5 "${TAPS:-25}"
fi

# within FILE 'NAME VALUE SHARE'...: the number is the plant's within this share, and its interval widened by half holds it
within() {
  file=$1
  shift
  for row in "$@"; do
    echo "$row" | awk -v file="$file" '{
      while ((getline line < file) > 0) {
        split(line, w, /[ =;,]+/)
        if (w[1] == "[finger]") finger = 1
        if (w[1] != $1 || ($1 == "mass" && !finger)) continue
        found = 1; value = w[2]; low = w[4]; high = w[6]; spare = (high - low) / 4
        good = line ~ /95 %/ && value >= $2 * (1 - $3) && value <= $2 * (1 + $3) && $2 >= low - spare && $2 <= high + spare
        print file ": " line " (is " $2 ")" (good ? "" : "  FAILED")
        exit !good
      }
      print file ": no " $1; exit !found }' || failed=1
  done
}

# taps PLANT COUNT FOLDER: a recording without what only a simulation knows
taps() {
  "$bin/ethd-tap" --plant "$1" --transition offset --taps "$2" --record "$3" >/dev/null 2>&1 || fail "taps on $1: exit $?"
  rm -f "$3/truth.npy" "$3/taps.csv"
}

taps n 20 on-n
# the finger of another plant is where the fit begins and what would be kept
awk 'FNR == NR { if (/^\[/) part = $1; if (part == "[finger]" || part == "[proximity]") kept[part $1] = $0; next }
  { if (/^\[/) part = $1; print (part $1) in kept ? kept[part $1] : $0 }' \
  "$bin/../share/ethd/b.plant" "$bin/../share/ethd/n.plant" >base.plant
"$bin/ethd-identify" on-n --base base.plant --out n.plant >said || fail "taps on n: exit $?"
within n.plant 'mass 0.0675 0.06' 'hand_stiffness 284.7 0.08' 'hand_damping 4.27 0.05' 'pad_stiffness 27436 0.06' \
  'pad_damping 1.06 0.12' 'rate 300 0.001' 'noise 1e-4 0.08'
grep -q '^mass_x .*0.1173 .*not seen, kept as in base.plant$' n.plant || fail "the arm isn't kept: $(grep mass_x n.plant)"
# A touch ends before the longest one of which it is known that the hand didn't brake, 75 ms, by as long as braking needs to show.
grep -q '^touches  .*fitted to .* to 63 ms after' said && grep -q 'arm  .*kept as in base.plant' said || fail "what is said: $(cat said)"

# Every fourth reading is lost: the numbers stay.
"$PYTHON" - <<'END'
import numpy, shutil
shutil.copytree("on-n", "lossy")
rows = numpy.load("on-n/tick.npy")
came = numpy.flatnonzero(rows["centre"].any(axis=1))
lost = came[2::4]
rows["have"][lost] = 0
numpy.save("lossy/tick.npy", rows)
END
"$bin/ethd-identify" lossy --base base.plant --out lossy.plant >said || fail "lost readings: exit $?"
within lossy.plant 'mass 0.0675 0.08' 'hand_stiffness 284.7 0.1' 'hand_damping 4.27 0.06' 'pad_stiffness 27436 0.08' 'rate 300 0.001'

taps b 20 on-b
"$bin/ethd-identify" on-b --base b --out b.plant >said || fail "taps on b: exit $?"
within b.plant 'mass 0.0307 0.06' 'hand_stiffness 121.8 0.08' 'hand_damping 2.70 0.05' 'pad_stiffness 15610 0.06'

taps n 3 few
"$bin/ethd-identify" few --base n --out few.plant >out 2>err
[ $? = 2 ] && [ "$(wc -l <err)" = 1 ] && grep -q 'touches, at least 10 are needed; record more' err && [ ! -e few.plant ] ||
  fail "too few touches: $(cat err)"

exit $failed
