#!/bin/sh
# make stress: every stress test at full length, its results as CSV, and pictures, in $BUILD/stress; then how long
# the study's screen takes for a frame. EFFORT=--quick or EFFORT= (1e7 ticks instead of 1e9) makes it shorter.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
BUILD=${BUILD:-build} EFFORT=${EFFORT---long} out=$BUILD/stress
mkdir -p "$out"

code=0
"$BUILD/tests/stress" all $EFFORT --out "$out" --csv "$out/results.csv" || code=$?

plot() { (cd "$out" && gnuplot -e "$1" "$here/../picture.gp" "$here/$2"); }
draw() {
  plot "in='boundary.csv'; out='boundary.png'" boundary.gp
  plot "in='hold.csv'; out='hold.png'" hold.gp
  for velocity in difference lowpass; do
    plot "in='map.csv'; curve='map_curve.csv'; velocity='$velocity'; out='map-$velocity.png'" map.gp
  done
  echo
  echo "results: $out/results.csv; pictures, drawn from the CSV beside them:"
  for picture in boundary hold map-difference map-lowpass; do echo "  $out/$picture.png"; done
}
if command -v gnuplot >/dev/null; then draw; else echo "no gnuplot: no pictures"; fi

echo
sh "$here/frames.sh" || code=1
exit $code
