#!/bin/sh
# The metrics of ethd-tap's CSV, recomputed from its recordings in another language; and the recordings replay.
set -eu
. tests/begin.sh
tap=$BUILD/bin/ethd-tap
python=${PYTHON:-python3}

taps=40
[ -z "${SAN:-}" ] || taps=4
for plant in n p; do
  "$tap" --plant $plant --taps $taps --speed low,high,0.3 --record "$folder/$plant" --csv "$folder/$plant.csv" >"$folder/out"
  cmp "$folder/$plant.csv" "$folder/$plant/taps.csv"
  "$python" tests/record_metrics.py "$folder/$plant" $plant
  "$BUILD/bin/ethd-replay" --verify "$folder/$plant"
done

# Recorded movements, one that starts with the ring in the wall among them.
motion=${ETHD_MOTION_DIR:-tests/motion}
for file in optotrak_tap_mit/tathum_par1_trial035_tap.csv avraham_free_mit/avraham_ND_s02_be38_free.csv; do
  rm -rf "$folder/f"
  "$tap" --plant n --finger "$motion/$file" --taps 3 --record "$folder/f" >"$folder/out"
  "$python" tests/record_metrics.py "$folder/f" n
  "$BUILD/bin/ethd-replay" --verify "$folder/f"
done

# The recorded values are what is compared: a figure that differs is found.
sed '3s/,ok,0\./,ok,1./' "$folder/n.csv" >"$folder/n/taps.csv"
cmp -s "$folder/n.csv" "$folder/n/taps.csv" && fail "nothing was changed"
"$python" tests/record_metrics.py "$folder/n" n >/dev/null 2>&1 && fail "a changed figure wasn't found"
exit $failed
