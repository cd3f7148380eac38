#!/bin/sh
# Every figure of a report's tables: against what the report was before it was written in Python, and worked out again in R.
# `report_figures.sh freeze` renews tests/reference/report after the simulated device has changed.
set -u
command -v gnuplot >/dev/null || { echo "SKIP: gnuplot (Debian: gnuplot-nox)"; exit 77; }
reference=tests/reference/report/studies.tar.xz
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
study=$BUILD/bin/ethd-study
report=$BUILD/bin/ethd-report
failed=0
run() { "$@" >"$folder/out" 2>&1 || { echo "FAILED $*: $(cat "$folder/out")"; exit 1; }; }
mkdir "$folder/old" "$folder/new"
run tar -xJf "$reference" -C "$folder/old"

# Made-up taps and answers, which came from NumPy's generator: eight people; ten, with ties; twenty, with three strategies,
# missing cells and a questionnaire of their own.
for kind in plain ties missing; do
  here=$folder/new/$kind
  run "$study" --quiet "$folder/old/$kind/made.study" --out "$here"
  rm -f "$here/SHA256SUMS" # the taps are other ones now
  cp "$folder/old/$kind/taps.csv" "$folder/old/$kind/survey.csv" "$here"
  run "$report" "$here"
done
# The paper's study, simulated, beside a crowd of one tap a cell, of whom few have valid ones in all four cells; a grid of
# gains; and two stations.
run "$study" --quiet --out "$folder/new/study"
run "$study" "$BUILD/share/ethd/crowd.study" --simulate 60 --out "$folder/new/crowd"
run "$study" "$folder/old/grid/made.study" --simulate 7 --out "$folder/new/grid"
for kind in crowd grid; do run "$study" --merge "$folder/new/$kind"; done
run "$report" "$folder/new/study" --beside "$folder/new/crowd"
run "$report" "$folder/new/crowd"
run "$report" "$folder/new/grid" --point 3
for k in 1 2; do run "$study" --quiet "$folder/old/stations/made.study" --participant $k --out "$folder/station$k"; done
mkdir "$folder/new/stations"
run "$report" "$folder/station1" "$folder/station2" --out "$folder/new/stations/report"

# Of long tables each twentieth row is kept; a simulated encounter is the same in all of them.
mkdir "$folder/kept"
for kind in plain ties missing study crowd grid stations; do
  mkdir -p "$folder/kept/$kind/report"
  for table in "$folder/new/$kind"/report/*.csv; do
    case $kind/$(basename "$table") in study/*) ;; */encounter-*) continue ;; esac
    awk -v n="$(wc -l <"$table")" 'NR == 1 || n <= 300 || NR % 20 == 0' "$table" >"$folder/kept/$kind/report/$(basename "$table")"
  done
  for input in made.study taps.csv survey.csv; do
    [ ! -e "$folder/old/$kind/$input" ] || cp "$folder/old/$kind/$input" "$folder/kept/$kind"
  done
done
if [ "${1-}" = freeze ]; then
  run tar --sort=name --mtime=@0 --owner=0 --group=0 -cJf "$reference" -C "$folder/kept" .
  exit
fi
"${PYTHON:-python3}" tests/report_reference.py "$folder/old" "$folder/kept" || failed=1
if command -v Rscript >/dev/null; then
  for kind in plain ties missing crowd; do Rscript tests/report_figures.R "$folder/new/$kind" || failed=1; done
else
  [ $failed = 0 ] || exit 1
  echo "SKIP: Rscript (Debian: r-base-core); all else passed"
  exit 77
fi
exit $failed
