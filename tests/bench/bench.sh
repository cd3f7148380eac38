#!/bin/sh
# make bench, make bench-quick: tables on the terminal, CSV files and pictures in $BUILD/bench.
# The first argument goes into every CSV: commit, compiler, flags. WHAT names one question, QUICK=1 is quick.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
BUILD=${BUILD:-build} QUICK=${QUICK:-} out=$BUILD/bench
mkdir -p "$out"

"$BUILD/tests/bench" "${WHAT:-all}" ${QUICK:+--quick} --out "$out" --about "${1:-}"

command -v gnuplot >/dev/null || { echo "no gnuplot: no pictures"; exit 0; }
echo
echo "pictures, each beside its CSV:"
for csv in "$out"/*.csv; do
  what=$(basename "$csv" .csv) gp=$here/race.gp
  [ -f "$here/$what.gp" ] && gp=$here/$what.gp
  (cd "$out" && gnuplot -e "in='$what.csv'; out='$what.png'" "$here/../picture.gp" "$gp")
  echo "  $out/$what.png"
done
