#!/bin/sh
# A whole study at two stations: 12 simulated people, and 2 whom the mouse leads on a screen, with consent, hand-over,
# practice, questions and a tap that is rejected; ended at ten random moments by SIGKILL, gone on with, exported, merged,
# reported. Nothing is lost, doubled or mislabelled.
# ETHD_STUDY_WHOLE=1 (make stress): the paper's speeds and three valid taps a cell. No time is asserted.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: the window's libraries aren't made for sanitizers"; exit 77; }
study=$BUILD/bin/ethd-study
speeds=low taps=1 attempts=2 training=1
[ -z "${ETHD_STUDY_WHOLE:-}" ] || { speeds=low,high; taps=3; attempts=4; training=1; }

cat >"$folder/whole.study" <<END
[study]
name = whole
seed = 15
participants = 14
strategies = smooth,offset
speeds = $speeds
order = latin
training = $training
taps = $taps
attempts = $attempts
survey = on
[survey]
q1 = Did the wall stand still?
q1_answers = yes | no
q2 = How sure are you?
[pages]
consent1 = You may end this at any time.
instruction1 = Tap once on the green wall.
END
. tests/peers/display.sh
"${PYTHON:-python3}" tests/study_whole.py "$study" "$folder" || fail "the stations"
[ $failed = 0 ] || exit 1

# ---- exported, merged, checked, replayed, reported ----
mv "$folder/mouse/taps.csv" "$folder/mouse/events.csv" "$folder"
"$study" --export "$folder/mouse" >"$folder/out" 2>&1 || fail "the export: $(cat "$folder/out")"
for table in taps events; do cmp "$folder/$table.csv" "$folder/mouse/$table.csv" || fail "the export's $table"; done
"$study" --merge "$folder/simulated" "$folder/mouse" --out "$folder/both" >"$folder/out" 2>&1 || fail "merging: $(cat "$folder/out")"
"$study" --verify "$folder/both" >"$folder/out" 2>&1 || fail "sums: $(cat "$folder/out")"
(cd "$folder/both" && sha256sum --quiet -c SHA256SUMS) >"$folder/out" 2>&1 || fail "sha256sum: $(cat "$folder/out")"
"${PYTHON:-python3}" tests/study_whole.py --judge "$folder" "$taps" "$attempts" || fail "the merged study"
for tap in "$folder"/both/taps/P01-* "$folder"/both/taps/P1[34]-*; do
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/out" 2>&1 && grep -q 'equal to the bit' "$folder/out" || fail "$tap: $(cat "$folder/out")"
done
refuse 2 "several stations' taps" "$study" --resume "$folder/both"
if command -v gnuplot >/dev/null; then
  "$BUILD/bin/ethd-report" "$folder/both" >"$folder/out" 2>&1 && grep -q "files are as SHA256SUMS says" "$folder/both/report/report.html" || fail "the report: $(cat "$folder/out")"
  "$study" --verify "$folder/both" >"$folder/out" 2>&1 || fail "sums beside a report: $(cat "$folder/out")"
  echo >>"$folder/both/taps/$(ls "$folder/both/taps" | head -n 1)/truth.npy"
  "$BUILD/bin/ethd-report" "$folder/both" --force >"$folder/out" 2>&1 && grep -q "truth.npy isn&#x27;t what it was" "$folder/both/report/report.html" ||
    fail "the report of a tap that was changed: $(cat "$folder/out")"
fi
exit $failed
