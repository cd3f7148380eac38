#!/bin/sh
# make bench, make bench-quick: tables on the terminal, CSV files and pictures in $BUILD/bench.
# The first argument goes into every CSV: commit, compiler, flags. WHAT names one question, QUICK=1 is quick.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
BUILD=${BUILD:-build} QUICK=${QUICK:-} out=$BUILD/bench
mkdir -p "$out"

"$BUILD/bin/ethd-bench" "${WHAT:-all}" ${QUICK:+--quick} --out "$out" --force --about "${1:-}"

command -v gnuplot >/dev/null || { echo "no gnuplot: no pictures"; exit 0; }
echo
echo "pictures, each beside its CSV:"
for csv in "$out"/*.csv; do
  what=$(basename "$csv" .csv)
  [ -f "$here/plot/bench-$what.gp" ] || continue
  (cd "$out" && gnuplot -e "in='$what.csv'; out='$what.png'" "$here/plot/bench-$what.gp")
  echo "  $out/$what.png"
done
