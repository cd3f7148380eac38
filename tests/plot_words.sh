#!/bin/sh
# No word of a report's pictures lies on another one or is cut off, with nine cells as with four; none of a tap's on a curve,
# under any strategy.
. tests/begin.sh
command -v gnuplot >/dev/null || { echo "SKIP: gnuplot (Debian: gnuplot-nox)"; exit 77; }
plots=$PWD/apps/plot
study() { # NAME, LINES
  printf "[study]\nname = $1\nparticipants = 2\ntaps = 1\ntraining = 0\nattempts = 20\nsurvey = on\n$2" >"$folder/$1.study"
  "$BUILD/bin/ethd-study" --quiet "$folder/$1.study" --out "$folder/$1" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
  rm -f "$folder/$1/SHA256SUMS"
  awk -F, -v OFS=, 'NR > 1 { $5 = 3; $6 = 1 + NR % 5; $7 = 2 } 1' "$folder/$1/survey.csv" >"$folder/survey.csv" && cp "$folder/survey.csv" "$folder/$1/survey.csv"
  "$BUILD/bin/ethd-report" "$folder/$1" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
}
draw() { # STUDY SCRIPT VARIABLES
  (cd "$folder/$1/report" && gnuplot -e "svg = 1; out = '$folder/$1-$2-$count.svg'; $3" "$plots/$2.gp") >"$folder/out" 2>&1 || { cat "$folder/out"; failed=1; }
  count=$((count + 1))
}
count=1
study four ''
study nine 'strategies = abrupt,smooth,offset\nspeeds = low,0.3,high\n'
note='Simulated, not measured. Valid taps. Box: median (red), quartiles, extremes. Dots: taps; colours and dashed lines (medians): participants'
for name in four nine; do
  for metrics in 'v_rvo v_of d_max v_rmin' 'delta_s eps' delay; do
    draw $name report-boxes "in = 'boxes.csv'; points = 'points.csv'; between = 'lines.csv'; people = '2'; note = '$note'; metrics = '$metrics'"
  done
  draw $name report-reasons "in = 'reasons.csv'; note = 'test taps of this study'"
  draw $name report-survey "in = 'survey-answers.csv'; question = '2'; answers = '5'; scale = '1 wwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww… to 5 moved clearly toward the right…'"
  draw $name report-states "in = 'encounter-smooth.csv encounter-offset.csv'; titles = 'smooth offset'; from = '-60'; note = 'simulated for this picture; dashed: how far the ring is in the wall'"
  for trace in "$folder/$name"/report/trace-*.csv; do draw $name tap "in = '$(basename "$trace")'; title = 'a tap'"; done
done
mkdir -p "$folder/taps/report"
for seed in 1 2; do
  "$BUILD/bin/ethd-tap" --taps 40 --seed $seed --trace "$folder/taps/report" --force >/dev/null || failed=1
  for trace in "$folder"/taps/report/*.csv; do draw taps tap "in = '$(basename "$trace")'; title = '$(basename "$trace" .csv), seed $seed'"; done
done
"${PYTHON:-python3}" tests/plot_words.py "$folder"/*.svg || failed=1
exit $failed
