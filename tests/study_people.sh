#!/bin/sh
# ethd-study with people, on ethd-run's device: the simulated one with its own finger stands for both. No time is asserted.
. tests/begin.sh
study=$BUILD/bin/ethd-study

cp apps/config/wall.scene "$folder"
device() { # FILE SETTINGS: plant n's configuration with another device
  { sed '/^\[device\]/,$d' apps/config/n.ini && printf '[device]\ndriver = sim\n%b' "$2"; } >"$folder/$1"
}
protocol() { # FILE DEVICE ATTEMPTS SURVEY
  printf '[study]\nparticipants = 1\nstrategies = smooth,offset\nspeeds = 0.2\ntraining = 1\ntaps = 1\nattempts = %s\nsurvey = %s\n[device]\nconfig = %s\n[hand]\nsource = people\n' "$3" "$4" "$2" >"$folder/$1"
}
device device.ini 'speed = 0.2\nplant = far.plant\n'
sed 's/^start = .*/start = 0.08/' apps/config/n.plant >"$folder/far.plant" # the torque has risen before the wall
protocol people.study device.ini 2 on

talk() { # PATTERN ANSWERS COMMAND..: a line, empty ones too, whenever the pattern has come once more
  pattern=$1 answers=$2 asked=0
  shift 2
  rm -f "$folder/in"
  mkfifo "$folder/in"
  "$@" <"$folder/in" >"$folder/out" 2>"$folder/err" &
  run=$!
  exec 9>"$folder/in"
  echo "$answers" | while IFS= read -r answer; do
    asked=$((asked + 1))
    for _ in $(seq 600); do
      [ "$(grep -c "$pattern" "$folder/out")" -ge $asked ] && break
      kill -0 $run 2>/dev/null || break
      sleep 0.05
    done
    printf '%b\n' "$answer"
  done >&9
  exec 9>&-
  wait $run
}

# ---- in lock-step: the same bytes again; every tap replays on its own; as the same tap on the desk ----
for k in 1 2; do
  "$study" "$folder/people.study" --out "$folder/s$k" --virtual --quiet >"$folder/out" 2>"$folder/err" || fail "in lock-step: $(cat "$folder/err")"
done
for k in 1 2; do cut -d, -f1-27,29- "$folder/s$k/taps.csv" >"$folder/taps$k"; done # but for the clock
cmp "$folder/taps1" "$folder/taps2" && diff -r "$folder/s1/taps" "$folder/s2/taps" >"$folder/out" || fail "not the same bytes again: $(head -n 3 "$folder/out")"
[ "$(ls "$folder/s1/taps" | wc -l)" -ge 3 ] || fail "too few taps: $(cat "$folder/s1/taps.csv")"
for tap in "$folder"/s1/taps/*; do
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || fail "$tap: $(cat "$folder/verify")"
done
"$BUILD/bin/ethd-tap" --config "$folder/device.ini" --speed 0.2 --transition smooth,offset --taps 1 --seed 1 --csv "$folder/desk.csv" >/dev/null || fail "ethd-tap"
# The start is softer than on the desk; ring and finger are as the controller sees them, which is near to the truth.
awk -F, '
  function off(a, b) { return a > b ? a - b : b - a }
  FNR == NR { v[$2] = $7; delta[$2] = $11; eps[$2] = $12; rvo[$2] = $13; of[$2] = $14; next }
  FNR > 1 { n++; bad += off($15, delta[$5]) > 2 || off($16, eps[$5]) > 2e-4 || off($17, rvo[$5]) > 3e-3 || off($11, v[$5]) > 0.03 || off($18, of[$5]) > 0.01 }
  END { exit n < 3 || bad }' "$folder/desk.csv" "$folder/s1/taps.csv" || fail "not the desk's tap: $(cat "$folder/s1/taps.csv" "$folder/desk.csv")"

# ---- the report says what was measured ----
if command -v gnuplot >/dev/null; then
  "$BUILD/bin/ethd-report" "$folder/s1" >"$folder/out" 2>&1 && grep -q 'no person</b>: a rehearsal, with the finger that the simulated device has' "$folder/s1/report/report.html" &&
    grep -q 'say nothing about people' "$folder/s1/report/report.html" && ! grep -q 'several sources' "$folder/s1/report/report.html" || fail "the report: $(cat "$folder/out")"
  sed -i 's/^driver = sim/driver = servo/' "$folder/s2/config.ini"
  "$BUILD/bin/ethd-report" "$folder/s2" >"$folder/out" 2>&1 || fail "the report of a servo's taps: $(cat "$folder/out")"
  grep -q 'measured on the device <code>servo</code>' "$folder/s2/report/report.html" && grep -q 'people, with their fingers in the device' "$folder/s2/report/report.html" &&
    ! grep -q -i 'simulated, not measured\|were <b>fitted' "$folder/s2/report/report.html" || fail "the page of a servo's taps says it was simulated"
fi

# ---- in real time, survey and notes on stdin ----
# Back goes to the question before; what was answered before a stop stays answered, and the rest is asked the next time.
talk '?\|ok keeps\|found' "4
back
2
3
9
5
ok
1
stop" "$study" "$folder/people.study" --out "$folder/live" --ask
[ $? = 1 ] && grep -q "live --ask goes on" "$folder/err" || fail "in real time: $(cat "$folder/out" "$folder/err")"
[ "$(grep -c '1 to 5, back, stop, or an empty line' "$folder/out")" = 1 ] || fail "an answer 9: $(cat "$folder/out")"
grep -q ',2,3,5$' "$folder/live/survey.csv" && [ "$(wc -l <"$folder/live/survey.csv")" = 2 ] || fail "the answers: $(cat "$folder/live/survey.csv")"
"${PYTHON:-python3}" -c 'import sqlite3, sys; print(sqlite3.connect(sys.argv[1]).execute("select * from answer where block = 3").fetchall())' "$folder/live/study.sqlite" >"$folder/answers"
[ "$(cat "$folder/answers")" = '[(1, 3, 1, 1, None)]' ] || fail "the answer before a stop: $(cat "$folder/answers")"
"$study" --resume "$folder/live" --virtual --quiet >"$folder/out" 2>"$folder/err" && grep -q '1 questionnaire wasn.t asked' "$folder/out" ||
  fail "nobody to ask: $(cat "$folder/out" "$folder/err")"
talk '?\|ok keeps' "
5
ok" "$study" --resume "$folder/live" --ask || fail "asked again: $(cat "$folder/out" "$folder/err")"
grep -q ',1,,5$' "$folder/live/survey.csv" && [ "$(wc -l <"$folder/live/survey.csv")" = 3 ] || fail "the answers: $(cat "$folder/live/survey.csv")"
awk -F, 'NR > 1 && ($26 != "device" || $28 !~ /^20..-..-..T..:..:..Z$/)' "$folder/live/taps.csv" | grep . && fail "taps without their hand and time"
for tap in "$folder"/live/taps/*; do
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/verify" 2>&1 || fail "$tap: $(cat "$folder/verify")"
done

# ---- an answer in words is data, whatever stands in it, and can be changed until all are confirmed ----
printf '[study]\nparticipants = 1\nstrategies = smooth\nspeeds = 0.2\ntraining = 0\ntaps = 1\nattempts = 1\nsurvey = on\n[device]\nconfig = device.ini\n[hand]\nsource = people\n[survey]\nq1 = Was it soft?\nq1_answers = text\nq2 = How much?\nq2_answers = 1|2|3|4|5|6|7\n' >"$folder/words.study"
talk '?\|ok keeps\|found' 'P01,9,1,"a
7
back
back
=1+1, "soft"; ,abort,
8
6
ok' "$study" "$folder/words.study" --out "$folder/words" --virtual --ask || fail "answers in words: $(cat "$folder/out" "$folder/err")"
grep -q 'Was it soft? in your own words$' "$folder/out" && grep -q '^the answers: "=1+1, "soft"; ,abort," 6; ok keeps them' "$folder/out" || fail "asked for words: $(cat "$folder/out")"
"${PYTHON:-python3}" - "$folder/words" <<'END' || fail "the answer in words: $(cat "$folder/words/survey.csv")"
import csv, json, sys
rows = list(csv.DictReader(open(sys.argv[1] + "/survey.csv", newline="")))
assert len(rows) == 1 and rows[0]["q1"] == '=1+1, "soft"; ,abort,' and rows[0]["q2"] == "6", rows
sidecar = json.load(open(sys.argv[1] + "/survey.json"))
assert "Levels" not in sidecar["q1"] and len(sidecar["q2"]["Levels"]) == 7, sidecar
people = list(csv.DictReader(open(sys.argv[1] + "/participants.csv")))
assert [p["status"] for p in people] == ["complete"], people
END
cp "$folder/words/survey.csv" "$folder/a"
"$study" --resume "$folder/words" --virtual --quiet >"$folder/out" 2>&1 && cmp "$folder/a" "$folder/words/survey.csv" || fail "words after a resume: $(cat "$folder/out")"
if command -v gnuplot >/dev/null; then
  "$BUILD/bin/ethd-report" "$folder/words" >"$folder/out" 2>&1 && grep -q '=1+1, &quot;soft&quot;; ,abort,' "$folder/words/report/report.html" || fail "words in the report: $(cat "$folder/out")"
fi

# ---- what is asked once: before the first tap, after the last; who comes back isn't asked again ----
printf '[study]\nparticipants = 1\nstrategies = smooth\nspeeds = 0.2\ntraining = 0\ntaps = 1\nattempts = 1\n[device]\nconfig = device.ini\n[hand]\nsource = people\n[before]\nq1 = How old are you?\nq1_answers = text\nq2 = Which hand?\nq2_answers = left | right\n[after]\nq1 = Was it long?\nq1_answers = no | yes\n' >"$folder/once.study"
talk '?\|ok keeps' 'about 30, "or so"
2
stop' "$study" "$folder/once.study" --out "$folder/once" --virtual --ask
[ $? = 1 ] && ! grep -q 'tap ' "$folder/out" || fail "stopped before the first tap: $(cat "$folder/out")"
talk '?\|ok keeps' 'ok
2
ok' "$study" --resume "$folder/once" --virtual --ask || fail "asked once: $(cat "$folder/out" "$folder/err")"
[ "$(grep -c '?' "$folder/out")" = 1 ] && grep -n 'ok keeps\|tap ' "$folder/out" | cut -d: -f2 | cut -c1-11 | tr '\n' ',' | grep -q '^the answers,P01 tap  1,the answers,$' || fail "asked once, in this order: $(cat "$folder/out")"
"$study" --resume "$folder/once" --virtual --ask >"$folder/out" 2>&1 </dev/null && ! grep -q '?' "$folder/out" || fail "asked again: $(cat "$folder/out")"
"${PYTHON:-python3}" - "$folder/once" <<'END' || fail "what was asked once: $(cat "$folder/once/participants.csv")"
import csv, json, sys
person, = csv.DictReader(open(sys.argv[1] + "/participants.csv", newline=""))
assert [person[k] for k in ("before_q1", "before_q2", "after_q1", "status")] == ['about 30, "or so"', "2", "2", "complete"], person
assert not list(csv.DictReader(open(sys.argv[1] + "/survey.csv")))
sidecar = json.load(open(sys.argv[1] + "/participants.json"))
assert list(sidecar) == list(person) and sidecar["before_q2"]["Levels"] == {"1": "left", "2": "right"}, sidecar
assert "| after_q1 | | Was it long? 1 no; 2 yes |" in open(sys.argv[1] + "/README.md").read()
END

# ---- one session is ended by mistake, which is undone when the next person sits down; another person doesn't agree; each
# is begun with its number ----
printf '[study]\nparticipants = 3\nstrategies = smooth\nspeeds = 0.2\ntraining = 0\ntaps = 1\nattempts = 1\n[device]\nconfig = device.ini\n[hand]\nsource = people\n[pages]\nconsent1 = You may end this.\ninstruction1 = Tap once.\n' >"$folder/undo.study"
printf 'yes\nabort\nundo\nP2\nP02\nno\nP03\nyes\n' | "$study" "$folder/undo.study" --out "$folder/undo" --virtual --ask >"$folder/out" 2>"$folder/err"
[ $? = 1 ] && grep -q "stopped; what was done is kept: ethd-study --resume $folder/undo --ask --virtual goes on" "$folder/err" || fail "undo: $(cat "$folder/out" "$folder/err")"
grep -q 'found "P2"; P02 or stop is allowed' "$folder/out" || fail "another number: $(cat "$folder/out")"
grep -q 'next is P01: the experimenter types P01' "$folder/out" || fail "the undone isn't next: $(cat "$folder/out")"
"$study" --resume "$folder/undo" --virtual --ask >"$folder/out" 2>"$folder/err" </dev/null || fail "the undone: $(cat "$folder/out" "$folder/err")"
[ "$(awk -F, 'NR > 1 && $2 != "" { printf "%s %s,", $2, $5 }' "$folder/undo/events.csv")" = 'P01 consent,P01 abort,P01 undo,P02 refuse,P03 consent,' ] || fail "undo: $(cat "$folder/undo/events.csv")"
[ "$(cut -d, -f1-3 "$folder/undo/participants.csv" | tail -n +2 | tr '\n' ' ')" = 'P01,complete,1 P02,refused,0 P03,complete,1 ' ] || fail "undone: $(cat "$folder/undo/participants.csv")"
[ "$(cut -d, -f1 "$folder/undo/taps.csv" | tail -n +2 | tr '\n' ' ')" = 'P03 P01 ' ] || fail "taps of the undone: $(cat "$folder/undo/taps.csv")"

# ---- the experimenter rejects a tap, undoes it, and accepts one; what is rejected is made again; later decisions too ----
printf '[study]\nparticipants = 1\nstrategies = smooth\nspeeds = 0.2\ntraining = 0\ntaps = 2\nattempts = 30\n[device]\nconfig = device.ini\n[hand]\nsource = people\n' >"$folder/check.study"
talk 'tap ' 'pause\nreject a\nundo\naccept b, "c"\nreject d\ngo' "$study" "$folder/check.study" --out "$folder/check" --ask
grep -q 'tap  .: rejected .* accepted: 0, rejected: 1$' "$folder/out" && grep -q 'tap  .: accepted .* accepted: 1, rejected: 0$' "$folder/out" || fail "checked: $(cat "$folder/out" "$folder/err")"
[ "$(awk -F, '$5 ~ /ject|check|accept/ { printf "%s %s,", $5, $6 }' "$folder/check/events.csv")" = 'reject a,uncheck ,accept "b,reject d,' ] || fail "the checks: $(cat "$folder/check/events.csv")"
counted() { # VALID ACCEPTED REJECTED of P01, which are also the numbers of rows in taps.csv
  [ "$(awk -F, 'NR > 1 { print $7, $8, $9 }' "$folder/check/participants.csv")" = "$1 $2 $3" ] &&
    [ "$(awk -F, '$31 == "rejected"' "$folder/check/taps.csv" | wc -l)" = "$3" ] && [ "$(awk -F, '$31 == "accepted"' "$folder/check/taps.csv" | wc -l)" = "$2" ] ||
    fail "not $*: $(cat "$folder/check/participants.csv" "$folder/check/taps.csv")"
}
counted 2 0 1
[ "$(awk -F, '$31 == "rejected" && $9 && $10 == "ok"' "$folder/check/taps.csv" | wc -l)" = 1 ] || fail "a rejected tap's own verdict: $(cat "$folder/check/taps.csv")"
last=$(awk -F, 'END { print $4 }' "$folder/check/taps.csv")
decide() { "$study" --resume "$folder/check" "$@" >"$folder/out" 2>"$folder/err" || fail "$*: $(cat "$folder/err")"; }
decide --reject "P01-01-00$last" --reason 'seen in the plot'
counted 1 0 2
decide --virtual --quiet
counted 2 0 2
[ "$(awk -F, 'END { print $4 }' "$folder/check/taps.csv")" = $((last + 1)) ] || fail "no tap more: $(cat "$folder/check/taps.csv")"
decide --accept "P01-01-00$last" --reason 'it was good'
counted 3 1 1
"$study" --verify "$folder/check" >"$folder/out" 2>&1 || fail "sums after a decision: $(cat "$folder/out")"
for bad in 'P01-01-029:the tap isn.t in this session' 'P01-01:found "P01-01", participant, block and attempt as in P01-02-004'; do
  refuse 2 "${bad#*:}" "$study" --resume "$folder/check" --reject "${bad%%:*}" --reason x
done
if command -v gnuplot >/dev/null; then
  "$BUILD/bin/ethd-report" "$folder/check" >"$folder/out" 2>&1 && grep -q '3 test taps, 3 of them valid, 1 accepted by the experimenter, 1 rejected and left out, in' "$folder/check/report/report.html" ||
    fail "the report of checked taps: $(cat "$folder/out") $(grep -o '[0-9]* test taps[^;]*' "$folder/check/report/report.html")"
fi

# ---- a finger that never leaves the start line makes no tap, and uses up no attempt ----
device still.ini 'speed = 0.001\nplant = still.plant\n'
sed 's/^start = .*/start = 0.0316/; s/^start_sd = .*/start_sd = 0/; s/^ramp_up = .*/ramp_up = 5/' apps/config/n.plant >"$folder/still.plant" # under 4 mm in a tap's 6 s
printf '[study]\nparticipants = 1\nstrategies = smooth\nspeeds = 0.2\ntraining = 0\ntaps = 1\nattempts = 3\n[device]\nconfig = still.ini\n[hand]\nsource = people\n' >"$folder/still.study"
mkfifo "$folder/quit"
timeout 60 "$study" "$folder/still.study" --out "$folder/still" --virtual --ask <"$folder/quit" >"$folder/out" 2>"$folder/err" &
run=$!
(sleep 2; echo stop) >"$folder/quit" # a shell of its own: nobody reads it any more where attempts were used up
wait $run
[ $? = 1 ] && grep -q 'stopped; what was done is kept' "$folder/err" || fail "at the start line: $(cat "$folder/out" "$folder/err")"
[ "$(wc -l <"$folder/still/taps.csv")" = 1 ] && [ -z "$(ls "$folder/still/taps" 2>/dev/null)" ] || fail "taps that nobody made: $(cat "$folder/still/taps.csv")"

# ---- the drive reports a fault in every tap: nothing goes on by itself, everything once somebody has seen to it ----
printf '150t fault9 set\n' >"$folder/wrong.inject"
device faulty.ini 'speed = 0.2\ninject = wrong.inject\n'
protocol faulty.study faulty.ini 2 off
"$study" "$folder/faulty.study" --out "$folder/faulty" --virtual >"$folder/out" 2>"$folder/err"
[ $? = 1 ] && grep -q 'the device stopped itself: the drive reports a fault; what was done is kept' "$folder/err" || fail "a fault: $(cat "$folder/err")"
talk 'ack goes on' 'what
ack
stop' "$study" --resume "$folder/faulty" --virtual --ask
[ $? = 1 ] && [ "$(grep -c 'ack goes on' "$folder/out")" = 3 ] || fail "acknowledged once: $(cat "$folder/out" "$folder/err")"
talk 'ack goes on' 'ack
ack
ack' "$study" --resume "$folder/faulty" --virtual --ask || fail "acknowledged: $(cat "$folder/out" "$folder/err")"
awk -F, 'NR > 1 { n++; bad += $10 != "fault" } END { exit n != 5 || bad }' "$folder/faulty/taps.csv" || fail "faults: $(cat "$folder/faulty/taps.csv")"
[ "$(grep -c ',acknowledged,' "$folder/faulty/events.csv")" = 2 ] || fail "acknowledgements: $(cat "$folder/faulty/events.csv")"

# ---- the device's own files stay where they are ----
mkdir "$folder/elsewhere"
(cd "$folder/elsewhere" && "$study" --resume "$folder/faulty" --virtual --quiet >"$folder/out" 2>"$folder/err") || fail "from elsewhere: $(cat "$folder/err")"

# ---- what doesn't go together ----
refuse 2 'hand.source: people have hands of their own' "$study" "$folder/people.study" --simulate 3 --out "$folder/x"
refuse 2 'people is needed' "$study" --virtual --out "$folder/x"
device odd.ini 'driver2 = 1\n'
protocol odd.study odd.ini 1 off
refuse 2 'driver2' "$study" "$folder/odd.study" --out "$folder/x" --virtual

# An open device is brought to rest, whatever fails next.
env -u DISPLAY -u WAYLAND_DISPLAY SDL_VIDEODRIVER=x11 "$study" "$folder/people.study" --out "$folder/dark" --screen >"$folder/out" 2>"$folder/err"
[ $? = 1 ] && grep -q 'no display' "$folder/err" || fail "no display: $(cat "$folder/err")"

# ---- on the screen: the device's finger, not the mouse ----
[ $failed = 0 ] || exit 1
[ -z "${SAN:-}" ] || { echo "SKIP: the window's libraries aren't made for sanitizers"; exit 77; }
. tests/peers/display.sh
"$study" "$folder/people.study" --out "$folder/screen" --screen >"$folder/out" 2>"$folder/err" &
run=$!
for _ in $(seq 150); do
  kill -0 $run 2>/dev/null || break
  xdotool key space key 4 key Return
  sleep 0.2
done
wait $run || fail "the screen: $(cat "$folder/out" "$folder/err")"
[ "$(grep -c ',4,4,4$' "$folder/screen/survey.csv")" = 2 ] || fail "the screen's answers: $(cat "$folder/screen/survey.csv")"
[ "$(awk -F, 'NR > 1' "$folder/screen/taps.csv" | wc -l)" -ge 3 ] || fail "the screen's taps: $(cat "$folder/screen/taps.csv")"
kill $server && server=
exit $failed
