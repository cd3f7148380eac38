#!/bin/sh
# make stress: every stress test at full length, its results as CSV, and pictures, in $BUILD/stress; then how long
# the study's screen takes for a frame. EFFORT=--quick or EFFORT= (1e7 ticks instead of 1e9) makes it shorter.
set -eu
here=$(dirname "$0")
BUILD=${BUILD:-build} EFFORT=${EFFORT---long} out=$BUILD/stress
mkdir -p "$out"

code=0
"$BUILD/bin/ethd-stress" all $EFFORT --out "$out" --csv "$out/results.csv" || code=$?

draw() {
  gnuplot -e "in='$out/boundary.csv'; out='$out/boundary.png'" "$here/plot/stability-boundary.gp"
  for velocity in difference lowpass; do
    gnuplot -e "map='$out/map.csv'; curve='$out/map_curve.csv'; velocity='$velocity'; out='$out/map-$velocity.png'" \
      "$here/plot/stability-map.gp"
  done
  echo
  echo "results: $out/results.csv; pictures, drawn from the CSV beside them:"
  for picture in boundary map-difference map-lowpass; do echo "  $out/$picture.png"; done
}
if command -v gnuplot >/dev/null; then draw; else echo "no gnuplot: no pictures"; fi

echo
sh "$here/frames.sh" || code=1
exit $code
