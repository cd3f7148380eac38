#!/bin/sh
# Every figure of a report, worked out again by SciPy and statsmodels: of made-up taps, of some with ties, of some with
# missing cells.
set -u
python=/usr/bin/python3
command -v gnuplot >/dev/null || { echo "SKIP: gnuplot (Debian: gnuplot-nox)"; exit 77; }
$python -c 'import scipy, statsmodels' 2>/dev/null || { echo "SKIP: SciPy and statsmodels (Debian: python3-scipy python3-statsmodels)"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
printf '[study]\nparticipants = 1\ntaps = 1\ntraining = 0\nattempts = 1\nrecord = none\nsurvey = on\n[validity]\nband_low = 0.06\nband_high = 0.08\n' >"$folder/made.study"
{ cat "$folder/made.study"
  printf '[survey]\nq1 = How natural?\nq1_answers = not at all | hardly | a little | so-so | rather | much | wholly\nq2 = How sure?\nq3 = Again?\n'
  printf 'q3_answers = no | yes\nq4 = How hard?\nq4_answers = 1|2|3|4|5|6|7|8|9\nq5 = Which way?\nq5_answers = left | none | right\nq6 = Anything else?\nq6_answers = text\n'
} >"$folder/missing.study"
cp "$folder/made.study" "$folder/plain.study" && cp "$folder/made.study" "$folder/ties.study"
for kind in plain ties missing; do
  "$BUILD/bin/ethd-study" --quiet "$folder/$kind.study" --out "$folder/$kind" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
  rm -f "$folder/$kind/SHA256SUMS" # the taps are other ones now
  $python tests/report_figures.py make $kind "$folder/$kind" &&
    "$BUILD/bin/ethd-report" "$folder/$kind" >"$folder/out" 2>&1 || { cat "$folder/out"; failed=1; continue; }
  $python -W ignore tests/report_figures.py check "$folder/$kind" || failed=1
done
# One tap a cell: few people have valid ones in all four cells, and the differences between speeds overlap in part.
"$BUILD/bin/ethd-study" "$BUILD/share/ethd/crowd.study" --simulate 60 --out "$folder/crowd" >"$folder/out" 2>&1 &&
  "$BUILD/bin/ethd-study" --merge "$folder/crowd" >"$folder/out" 2>&1 &&
  "$BUILD/bin/ethd-report" "$folder/crowd" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
$python -W ignore tests/report_figures.py check "$folder/crowd" || failed=1
exit $failed
