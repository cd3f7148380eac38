#!/bin/sh
# Every figure of a report's tables, worked out again in R.
. tests/begin.sh
command -v gnuplot >/dev/null || { echo "SKIP: gnuplot (Debian: gnuplot-nox)"; exit 77; }
command -v Rscript >/dev/null || { echo "SKIP: Rscript (Debian: r-base-core)"; exit 77; }
study=$BUILD/bin/ethd-study
report=$BUILD/bin/ethd-report
run() { "$@" >"$folder/out" 2>&1 || { echo "FAILED $*: $(cat "$folder/out")"; exit 1; }; }
mkdir "$folder/made"
run tar -xJf tests/reference/report/studies.tar.xz -C "$folder/made"

# Made-up taps and answers, which came from NumPy's generator: eight people; ten, with ties; twenty, with three strategies,
# missing cells and a questionnaire of their own.
for kind in plain ties missing; do
  here=$folder/$kind
  printf '\n[outcomes]\nprimary = d_max:smooth-offset:high, v_of:offset-smooth:low\n' >>"$folder/made/$kind/made.study"
  run "$study" --quiet "$folder/made/$kind/made.study" --out "$here"
  rm -f "$here/SHA256SUMS" # the taps are other ones now
  cp "$folder/made/$kind/taps.csv" "$folder/made/$kind/survey.csv" "$here"
  run "$report" "$here"
  "$report" --power "$here" >"$here/power.txt" || failed=1
done
# A simulated crowd of one tap a cell, of whom few have valid ones in all four cells.
run "$study" "$BUILD/share/ethd/crowd.study" --simulate 60 --out "$folder/crowd"
run "$study" --merge "$folder/crowd"
run "$report" "$folder/crowd"

for kind in plain ties missing crowd; do Rscript tests/report_figures.R "$folder/$kind" || failed=1; done
exit $failed
