#!/bin/sh
# A thousandth of make stress's volume: 1e6 inputs over all readers, in two goes, and 86 s of a simulated day.
. tests/begin.sh
fail() { echo "FAILED $*"; exit 1; }

export VOLUME_STATE="$folder/volume"
sh tests/volume.sh 5e5 5 >"$folder/first" || fail "$(cat "$folder/first")"
sh tests/volume.sh 1e6 5 >"$folder/out" || fail "$(cat "$folder/out")"
cat "$folder/out"
grep -q '^volume: \([0-9]*\) of \1 inputs, none wrongly refused' "$folder/out" || fail "inputs are missing"
awk '/ taken, / && $(NF - 3) == 0 { exit 1 }' "$folder/out" || fail "a reader takes nothing"

"$BUILD/tests/day" "$folder/day" 0.024 >"$folder/out" 2>"$folder/err" || fail "$(cat "$folder/out" "$folder/err")"
cat "$folder/out"
"$BUILD/bin/ethd-replay" --verify "$folder/day/0" || fail "the day's recording"
"$BUILD/tests/volume" nothing 0 1 2>/dev/null && fail "an unknown reader"
exit 0
