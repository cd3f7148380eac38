#!/bin/sh
# make demo: the tap study on the simulated device, its table beside the paper's, and pictures.
# TAPS and PLANT may be set: TAPS=1000 PLANT=b make demo
set -eu
here=$(dirname "$0")
BUILD=${BUILD:-build} TAPS=${TAPS:-400} PLANT=${PLANT:-n}
out=$BUILD/demo
mkdir -p "$out/traces"

"$BUILD/bin/ethd-tap" --plant "$PLANT" --taps "$TAPS" --csv "$out/taps.csv" --trace "$out/traces" >"$out/table.txt"
cat "$out/table.txt"
echo

plant=$(basename "$PLANT" .plant)
for law in abrupt smooth offset; do
  for speed in low high; do
    gnuplot -e "in='$out/traces/$law-$speed.csv'; out='$out/$law-$speed.png'; title='$law, $speed speed'; plant='$plant'" \
      "$here/plot/tap.gp"
  done
done
gnuplot -e "in='$out/taps.csv'; out='$out/boxes.png'; plant='$plant'" "$here/plot/boxes.gp"

echo "pictures, in the manner of the paper's figures:"
for law in smooth offset abrupt; do
  for speed in low high; do echo "  $out/$law-$speed.png"; done
done
echo "  $out/boxes.png"
echo "and the figures behind them: $out/taps.csv, $out/traces/"
