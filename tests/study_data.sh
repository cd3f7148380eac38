#!/bin/sh
# A study's data: whose hand, free text, damaged stores, sums, participants who leave, stations, orders, sidecars, refusals.
. tests/begin.sh
study=$BUILD/bin/ethd-study
python3=${PYTHON:-python3}
unchanged() { diff -r "$1" "$2" >"$folder/out" || fail "$3: $(head -n 3 "$folder/out")"; }

printf '[study]\nname = small\nparticipants = 2\ntaps = 1\nattempts = 2\ntraining = 1\nsurvey = on\n' >"$folder/small.study"
"$study" "$folder/small.study" --quiet --out "$folder/whole" >"$folder/out" 2>&1 || fail "a session: $(cat "$folder/out")"
cp -r "$folder/whole" "$folder/kept"

# ---- whose hand: each tap says it, another one is refused with the command that goes on ----
awk -F, 'NR > 1 && ($26 != "simulated" || $27 $28 != "")' "$folder/whole/taps.csv" | grep . && fail "a tap's hand"
refuse 2 "led by a simulated hand; ethd-study --resume $folder/whole goes on" "$study" --resume "$folder/whole" --screen
printf '[hand]\nsource = mouse\n' >"$folder/mouse.study"
refuse 2 'hand.source: mouse needs --screen' "$study" "$folder/mouse.study" --out "$folder/x"
printf '[study]\nspeeds = 0.2\nparticipants = 2\nattempts = 3\ntraining = 1\n[hand]\nsource = recorded\nmotion = optotrak_tap_mit\n' >"$folder/recorded.study"
refuse 2 'recorded hands need no --screen' env ETHD_MOTION_DIR=tests/motion "$study" "$folder/recorded.study" --out "$folder/x" --screen
[ ! -e "$folder/x" ] || fail "a refusal has written"

# ---- recorded movements: in the folder, in the hash, at each tap; nothing else is needed to go on ----
ETHD_MOTION_DIR=tests/motion "$study" "$folder/recorded.study" --quiet --participant 1 --out "$folder/recorded" >"$folder/out" 2>&1 || fail "recorded: $(cat "$folder/out")"
env ETHD_MOTION_DIR=/nowhere "$study" --quiet --resume "$folder/recorded" >"$folder/out" 2>&1 || fail "movements of the folder: $(cat "$folder/out")"
[ "$(awk -F, 'NR > 1 { print $26, $27 }' "$folder/recorded/taps.csv" | sort -u | grep -c '^recorded .*_tap.csv$')" = 2 ] || fail "the movements of the taps: $(cut -d, -f26-27 "$folder/recorded/taps.csv" | sort -u)"
hash=$(cd "$folder/recorded" && LC_ALL=C && cat study.ini config.ini scene.scene device.plant movements/*.csv | sha256sum | cut -d' ' -f1)
grep -q "^hash $hash$" "$folder/recorded/versions.txt" || fail "the hash isn't what versions.txt says"
cp -r "$folder/recorded" "$folder/moved"
for f in "$folder"/moved/movements/*; do echo >>"$f"; break; done
refuse 2 'begun with other files' "$study" --resume "$folder/moved"

# ---- free text is data ----
printf 'note x,P01,2,abort,y\nnote "quoted", =1+1\nnote ,abort,\n' |
  "$study" "$folder/small.study" --ask --quiet --participant 2 --out "$folder/notes" >"$folder/out" 2>&1 || fail "notes: $(cat "$folder/out")"
"$study" --quiet --resume "$folder/notes" >"$folder/out" 2>&1 || fail "after notes: $(cat "$folder/out")"
sort "$folder/notes/taps.csv" >"$folder/a"; sort "$folder/whole/taps.csv" | cmp - "$folder/a" || fail "a note has changed the taps"
"$python3" - "$folder/notes" <<'END' || fail "the notes"
import csv, sys
events = [r["detail"] for r in csv.DictReader(open(sys.argv[1] + "/events.csv", newline="")) if r["event"] == "note"]
assert events == ["x,P01,2,abort,y", '"quoted", =1+1', ",abort,"], events
people = {r["participant"]: r["status"] for r in csv.DictReader(open(sys.argv[1] + "/participants.csv", newline=""))}
assert people == {"P01": "complete", "P02": "complete"}, people
END

# ---- what a stranger, a disk or an old copy may put in study.sqlite's place: refused in one line, and nothing written ----
sql() { # FILE STATEMENTS
  "$python3" -c 'import sqlite3, sys; db = sqlite3.connect(sys.argv[1]); db.executescript(sys.argv[2]); db.commit()' "$1" "$2" || fail "$2"
}
copy() { rm -rf "$folder/bad" "$folder/before"; cp -r "$folder/whole" "$folder/bad"; }
stays() { # PATTERN: whatever is done with the folder
  rm -rf "$folder/before"
  cp -r "$folder/bad" "$folder/before"
  refuse 2 "$1" "$study" --resume "$folder/bad"
  refuse 2 "$1" "$study" --resume "$folder/bad" --exclude 1 --reason x
  refuse '[12]' "$1" "$study" --export "$folder/bad"
  unchanged "$folder/bad" "$folder/before" "$1"
}
# rows of nobody, of nothing, out of order, in tables that are ours
for rows in "UPDATE tap SET participant = 9 WHERE id = 1" "UPDATE tap SET attempt = 5 WHERE id = 1" "UPDATE tap SET block = 99 WHERE id = 2" \
  "UPDATE tap SET block = 'x' WHERE id = 2" "UPDATE tap SET point = 1 WHERE id = 1" "INSERT INTO answer VALUES (1, 2, 9, 1, NULL)" \
  "INSERT INTO answer VALUES (1, 2, 1, 6, NULL)" "INSERT INTO answer VALUES (9, 2, 1, 1, NULL)" "INSERT INTO answer VALUES (1, 0, 1, 1, NULL)" "INSERT INTO survey (participant, block) VALUES (1, 99)" \
  "INSERT INTO event (utc, participant, event, detail) VALUES ('', 77, 'abort', '')" \
  "INSERT INTO event (utc, participant, block, attempt, event, detail) VALUES ('', 1, 2, 99, 'reject', '')" \
  "INSERT INTO hand VALUES ('mouse'); UPDATE tap SET hand = 'mouse' WHERE id = 1"; do
  copy
  sql "$folder/bad/study.sqlite" "$rows"
  stays "bad/study.sqlite: has rows that aren't of this study"
done
copy
sql "$folder/bad/study.sqlite" "PRAGMA ignore_check_constraints = 1; UPDATE tap SET reason = '=1+1'"
stays "bad/study.sqlite: is damaged: "
copy
sql "$folder/bad/study.sqlite" "CREATE TRIGGER x AFTER INSERT ON event BEGIN DELETE FROM tap; END"
stays "bad/study.sqlite: its tables aren't those of a study"
copy
sql "$folder/bad/study.sqlite" "UPDATE study SET hash = 'x'"
stays 'begun with other files'
# a store of before the last taps: their folders say so, and stay
copy
sql "$folder/bad/study.sqlite" "DELETE FROM survey; DELETE FROM tap WHERE participant = 2"
rm -rf "$folder/before"
cp -r "$folder/bad" "$folder/before"
refuse 2 "bad/taps/P02-0.-00.: not in study.sqlite, nor are [0-9]* other taps. folders" "$study" --resume "$folder/bad"
unchanged "$folder/bad/taps" "$folder/before/taps" "an old store"
# one folder without its tap, and one half made, are what a kill leaves: the tap is taken again
copy
last=$(ls "$folder/bad/taps" | tail -n 1)
sql "$folder/bad/study.sqlite" "DELETE FROM survey WHERE participant = 2; DELETE FROM tap WHERE id = (SELECT max(id) FROM tap); DELETE FROM event WHERE event = 'over'"
mkdir "$folder/bad/taps/.new"
echo torn >"$folder/bad/taps/$last/tick.npy"
echo torn >"$folder/bad/taps/.new/tick.npy"
"$study" --quiet --resume "$folder/bad" >"$folder/out" 2>&1 || fail "a torn tap: $(cat "$folder/out")"
unchanged "$folder/bad/taps" "$folder/whole/taps" "a torn tap"
cmp "$folder/bad/taps.csv" "$folder/whole/taps.csv" || fail "a torn tap's row"

# ---- the tables are an export: made again, the same bytes ----
copy
for table in taps survey events participants; do echo lost >"$folder/bad/$table.csv"; done
rm "$folder/bad/survey.csv"
"$study" --export "$folder/bad" >"$folder/out" 2>&1 || fail "--export: $(cat "$folder/out")"
unchanged "$folder/bad" "$folder/whole" "--export"

# ---- sums: of every file, as sha256sum has them; what was changed later doesn't get a new one ----
"$study" --verify "$folder/whole" >"$folder/out" 2>&1 || fail "sums: $(cat "$folder/out")"
(cd "$folder/whole" && sha256sum --quiet -c SHA256SUMS) || fail "sha256sum"
[ "$(wc -l <"$folder/whole/SHA256SUMS")" = "$(find "$folder/whole" -type f ! -name SHA256SUMS ! -name '.*' | wc -l)" ] || fail "not every file has a sum"
tap=$(ls "$folder/whole/taps" | head -n 1)
for file in "taps/$tap/truth.npy" taps.csv config.ini "taps/$tap/tick.npy"; do
  rm -rf "$folder/bad"
  cp -r "$folder/whole" "$folder/bad"
  printf ' ' >>"$folder/bad/$file"
  refuse 1 "$file isn't what it was, and so 1 of its files" "$study" --verify "$folder/bad"
done
"$study" --quiet --resume "$folder/bad" >"$folder/out" 2>&1
refuse 1 "tick.npy isn't what it was" "$study" --verify "$folder/bad"
rm "$folder/bad/taps/$tap/truth.npy"
"$study" --quiet --resume "$folder/bad" >"$folder/out" 2>&1
refuse 1 "tick.npy isn't what it was, and so 2 of" "$study" --verify "$folder/bad"
echo mine >"$folder/bad/more.txt"
refuse 1 "so 3 of" "$study" --verify "$folder/bad"
rm "$folder/bad/SHA256SUMS"
refuse 1 'SHA256SUMS: No such file' "$study" --verify "$folder/bad"
printf '%064d  ../kept/study.sqlite\n' 0 >"$folder/bad/SHA256SUMS"
refuse 1 'SHA256SUMS:1: not a line of sha256sum about a file in this folder' "$study" --verify "$folder/bad"

# ---- who leaves stays on record, and may come back ----
status() { awk -F, -v id="$2" '$1 == id { print $2, $3 }' "$1/participants.csv"; }
rm -rf "$folder/bad"
cp -r "$folder/whole" "$folder/people"
"$study" --resume "$folder/people" --withdraw 1 --reason 'moved away, "for good"' >"$folder/out" 2>&1 || fail "withdraw: $(cat "$folder/out")"
[ "$(status "$folder/people" P01)" = 'withdrawn 0' ] && grep -q 'P01,withdrawn,0,"moved away, ""for good""",simulated,' "$folder/people/participants.csv" || fail "withdrawn: $(cat "$folder/people/participants.csv")"
"$study" --resume "$folder/people" --exclude 2 --reason 'told another task' >"$folder/out" 2>&1
[ "$(status "$folder/people" P02)" = 'excluded 0' ] || fail "excluded: $(cat "$folder/people/participants.csv")"
"$study" --resume "$folder/people" --include 2 --reason 'was told the right one' >"$folder/out" 2>&1
[ "$(status "$folder/people" P02)" = 'complete 1' ] || fail "included: $(cat "$folder/people/participants.csv")"
cmp "$folder/people/taps.csv" "$folder/whole/taps.csv" && "$study" --verify "$folder/people" >"$folder/out" 2>&1 || fail "a decision has changed the taps: $(cat "$folder/out")"
refuse 2 'participant 9: 1 to 2 are allowed' "$study" --resume "$folder/people" --exclude 9 --reason x
refuse 2 'need --resume DIR and --reason WORDS' sh -c "'$study' --resume '$folder/people' --exclude 1 2>&1 | head -n 1 >&2; exit 2"
echo abort | "$study" "$folder/small.study" --ask --quiet --out "$folder/aborted" >"$folder/out" 2>&1
[ "$(status "$folder/aborted" P01)" = 'aborted 0' ] && [ "$(status "$folder/aborted" P02)" = 'complete 1' ] || fail "aborted: $(cat "$folder/aborted/participants.csv")"
"$study" --resume "$folder/aborted" --include 1 --reason 'a wrong key' >"$folder/out" 2>&1 && [ "$(status "$folder/aborted" P01)" = 'incomplete 1' ] || fail "back: $(cat "$folder/aborted/participants.csv")"
"$study" --resume "$folder/aborted" --quiet >"$folder/out" 2>&1 && [ "$(status "$folder/aborted" P01)" = 'complete 1' ] || fail "back at work: $(cat "$folder/out")"
sort "$folder/aborted/taps.csv" >"$folder/a"; sort "$folder/whole/taps.csv" | cmp - "$folder/a" || fail "other taps after an abort"

# ---- stations ----
for k in 1 2; do "$study" "$folder/small.study" --quiet --participant $k --out "$folder/station$k" >"$folder/out" 2>&1 || fail "station $k"; done
"$study" --merge "$folder/station1" "$folder/station2" --out "$folder/both" >"$folder/out" 2>&1 || fail "stations: $(cat "$folder/out")"
for what in taps.csv survey.csv participants.csv orders.csv study.ini versions.txt; do cmp "$folder/whole/$what" "$folder/both/$what" || fail "stations: $what"; done
diff -r "$folder/whole/taps" "$folder/both/taps" >"$folder/out" || fail "stations' taps: $(head -n 3 "$folder/out")"
"$study" --verify "$folder/both" >"$folder/out" 2>&1 || fail "stations' sums: $(cat "$folder/out")"
"$study" --quiet --resume "$folder/both" >"$folder/out" 2>&1 && grep -q ': 0 taps' "$folder/out" || fail "going on with stations of one hand: $(cat "$folder/out")"
cp -r "$folder/both" "$folder/before2"
refuse 2 "isn't empty; another folder is needed" "$study" --merge "$folder/station1" "$folder/station2" --out "$folder/both"
unchanged "$folder/both" "$folder/before2" "a merge over another"
refuse 2 'P01 has tapped there and in' "$study" --merge "$folder/station1" "$folder/whole" --out "$folder/x"
refuse 2 'its study, configuration, walls or plant are other ones' "$study" --merge "$folder/station1" "$folder/recorded" --out "$folder/x"
printf ' ' >>"$folder/station2/taps/$(ls "$folder/station2/taps" | head -n 1)/truth.npy"
refuse 2 "truth.npy isn't what it was" "$study" --merge "$folder/station1" "$folder/station2" --out "$folder/x"
rm "$folder/station2/SHA256SUMS"
rm -rf "$folder/x"
refuse 2 'SHA256SUMS: No such file' "$study" --merge "$folder/station1" "$folder/station2" --out "$folder/x"
[ ! -e "$folder/x/study.sqlite" ] || fail "a merge that failed has a store"

# ---- own words: printed as they can be read again; unknown names, places and letters are refused ----
"$study" --words >"$folder/words.study" && "$study" "$folder/words.study" --plan >"$folder/out" 2>&1 || fail "--words: $(cat "$folder/out")"
[ "$(wc -l <"$folder/words.study")" = 48 ] && grep -q '^keys_thanks = Space ends$' "$folder/words.study" || fail "--words: $(cat "$folder/words.study")"
words() { # SECTION LINE PATTERN
  printf '[study]\nsurvey = on\n[%s]\n%b\n' "$1" "$2" >"$folder/own.study"
  refuse 2 "own.study:4: $1.$3" "$study" "$folder/own.study" --plan
}
words words 'tip = Tippen' 'tip: no key of this section; those that ethd-study --words prints are allowed'
words words 'count = {1} von {3}' 'count: found "{3}"; places of "({1} of {2})" are allowed'
words words 'tap = {x}' 'tap: found "{x}"; places of "Tap" are allowed'
words words 'tap = {1' 'tap: found "{1"'
words words 'tap = T\0374r' 'tap: a byte 252 that isn.t UTF-8'
words words 'tap = \0355\0240\0200' 'tap: a byte 237 that isn.t UTF-8'
words pages 'consent1 = \0327\0251' 'consent1: .* (U+05E9) is written from right to left'
words survey 'q1_answers = one' 'q1: one answer; "this | that", two to nine, or text are allowed'
grep -nE '(page_add\(.*|keys = )"[A-Za-z]' apps/screen/*.c && fail "words of the screen that no study file can replace"

# ---- primary outcomes: only figures that the report knows, of this study's strategies and speeds; the plan's hash is the folder's ----
figures=$(PYTHONPATH=apps/python "${PYTHON:-python3}" -c "from ethd_programs.report.taps import QUANTITIES; print(', '.join(QUANTITIES))")
printf '[study]\nparticipants = 1\ntaps = 1\ntraining = 0\n[outcomes]\nprimary = eps:smooth-offset:hi\n' >"$folder/plan.study"
refuse 2 "plan.study:6: outcomes.primary: found \"eps:smooth-offset:hi\", .*; figures are $figures\$" "$study" "$folder/plan.study" --plan
sed 's/:hi$/:high/' "$folder/plan.study" >"$folder/right.study"
"$study" "$folder/right.study" --plan >"$folder/plan" || fail "--plan with outcomes"
grep -q '^Primary outcomes: eps:smooth-offset:high$' "$folder/plan" || fail "the plan has no outcome"
"$study" --quiet "$folder/right.study" --out "$folder/planned" >/dev/null || fail "a study with outcomes"
grep -qx "Hash of study.*: $(sed -n 's/^hash //p' "$folder/planned/versions.txt")" "$folder/plan" || fail "the plan's hash isn't the folder's"
refuse 2 'declares no primary outcomes' "$BUILD/bin/ethd-report" --power "$folder/station1"

# ---- interleaved trials: every cell has its valid taps, in rounds, each with a finger of its own; killed and gone on with ----
printf '[study]\nparticipants = 4\norder = interleaved\ntraining = 1\ntaps = 3\nattempts = 90\n' >"$folder/trials.study"
"$study" "$folder/trials.study" --plan >"$folder/plan" && grep -q '^    4  first  low 6:6 .*  balanced$' "$folder/plan" && ! grep -q WARNING "$folder/plan" || fail "the plan of trials: $(cat "$folder/plan")"
"$study" "$folder/trials.study" --quiet --out "$folder/trials" >"$folder/out" 2>&1 || fail "trials: $(cat "$folder/out")"
"$study" "$folder/trials.study" --out "$folder/killed" >"$folder/out" 2>&1 &
pid=$!
for _ in $(seq 200); do [ "$(grep -c tap "$folder/out")" -ge 5 ] && break; sleep 0.02; done
kill -KILL $pid
wait $pid 2>/dev/null
"$study" --resume "$folder/killed" --quiet >"$folder/out" 2>&1 || fail "trials gone on with: $(cat "$folder/out")"
cmp "$folder/trials/taps.csv" "$folder/killed/taps.csv" || fail "trials after a kill"
"$python3" - "$folder/trials" <<'END' || fail "the trials"
import collections, csv, sys
taps = [t for t in csv.DictReader(open(sys.argv[1] + "/taps.csv")) if t["part"] == "test"]
valid = [t for t in taps if t["valid"] == "1"]
cells = collections.Counter((t["participant"], t["transition"], t["speed"]) for t in valid)
assert set(cells.values()) == {3} and len(cells) == 16, cells
fingers = collections.Counter((t["participant"], t["transition"], t["tap"]) for t in taps)
assert set(fingers.values()) == {1}, fingers
for who in {t["participant"] for t in valid}:
    mine = [(t["transition"], t["speed"]) for t in valid if t["participant"] == who]
    assert all(len(set(mine[i:i + 4])) == 4 for i in (0, 4, 8)), mine
END
last=$(tail -n 1 "$folder/trials/taps.csv" | awk -F, '{ printf "%s-%02d-%03d", $1, $2, $4 }')
"$study" --resume "$folder/trials" --reject "$last" --reason looked >"$folder/out" 2>&1 || fail "rejecting a trial: $(cat "$folder/out")"
"$study" --resume "$folder/trials" --quiet >"$folder/out" 2>&1 && grep -q ': 1 tap' "$folder/out" || grep -q ': [0-9]* taps;' "$folder/out" || fail "a rejected trial: $(cat "$folder/out")"

# ---- conditions in a table: kept and hashed, in any order, at two stations and in shards; what can't be names file and row ----
printf 'speed,transition\r\nlow,offset\r\nlow,"smooth"\r\n0.3,offset\r\n' >"$folder/mine.csv"
conditions() { printf '[study]\nparticipants = 6\nconditions = mine.csv\norder = %s\ntraining = 1\ntaps = 2\nattempts = 40\n' "$1" >"$folder/table.study"; }
for order in paper random latin interleaved; do
  conditions $order
  "$study" "$folder/table.study" --plan >"$folder/plan" || fail "the plan of $order conditions"
  [ $order != interleaved ] && [ $order != latin ] || grep -q '^    6 .*  balanced$' "$folder/plan" || fail "$order conditions: $(cat "$folder/plan")"
  "$study" "$folder/table.study" --quiet --out "$folder/by-$order" >"$folder/out" 2>&1 || fail "$order conditions: $(cat "$folder/out")"
  grep -qx "Hash of study.*: $(cd "$folder/by-$order" && cat study.ini config.ini scene.scene device.plant conditions.csv | sha256sum | cut -d' ' -f1)" "$folder/plan" || fail "the hash of $order conditions"
  "$python3" - "$folder" $order <<'END' || fail "$order conditions aren't the table's"
import collections, csv, sys
folder, order = sys.argv[1:]
wanted = [(r["transition"], r["speed"]) for r in csv.DictReader(open(folder + "/mine.csv", newline=""))]
taps = [t for t in csv.DictReader(open(f"{folder}/by-{order}/taps.csv")) if t["part"] == "test" and t["valid"] == "1"]
assert collections.Counter((t["participant"], t["transition"], t["speed"]) for t in taps) == {(f"P0{p}", *c): 2 for p in range(1, 7) for c in wanted}
END
done
for k in 1 4; do "$study" "$folder/table.study" --quiet --participant $k-$((k + 2)) --out "$folder/table$k" >/dev/null || fail "a table's station"; done
"$study" --merge "$folder/table1" "$folder/table4" --out "$folder/table" >"$folder/out" 2>&1 || fail "merging a table's stations: $(cat "$folder/out")"
[ "$(sort "$folder/table/taps.csv" | cut -d, -f1-27 | sha256sum)" = "$(sort "$folder/by-interleaved/taps.csv" | cut -d, -f1-27 | sha256sum)" ] || fail "a table's stations have other taps"
for n in 1 2; do
  for i in $(seq $n); do "$study" "$folder/table.study" --simulate 3 --shard $i/$n --out "$folder/bulk$n" >"$folder/out" 2>&1 || fail "a table's shard: $(cat "$folder/out")"; done
  "$study" --merge "$folder/bulk$n" >/dev/null || fail "merging a table's shards"
done
cmp "$folder/bulk1/taps.csv" "$folder/bulk2/taps.csv" || fail "a table's shards"
echo 0.3,smooth >>"$folder/by-random/conditions.csv"
refuse 2 'begun with other files' "$study" --resume "$folder/by-random"
table() { # PATTERN TEXT
  printf "$2" >"$folder/mine.csv"
  refuse 2 "$1" "$study" "$folder/table.study" --out "$folder/no"
  [ "$(wc -l <"$folder/err")" = 1 ] && [ ! -e "$folder/no" ] || fail "$1: $(cat "$folder/err")"
}
table 'mine.csv: is empty' ''
table 'mine.csv:2: columns transition and speed, and a row' 'transition,speed\n'
table 'mine.csv:1: columns transition and speed' 'transition\noffset\n'
table 'mine.csv:1: found the column "colour"; transition and speed are allowed' 'transition,colour,speed\noffset,red,low\n'
table 'mine.csv:3: transition: .*"rough"' 'transition,speed\noffset,low\nrough,low\n'
table 'mine.csv:3: speed: found "9"; low, high' 'transition,speed\noffset,low\noffset,9\n'
table 'mine.csv:4: the condition of row 2 again' 'transition,speed\noffset,low\nsmooth,low\noffset,low\n'
table 'mine.csv:2: speed: a cell of 0 bytes; 1 to 64' 'transition,speed\noffset,\n'
table 'mine.csv:2: 1 cell, the header names 2 columns' 'transition,speed\noffset\n'
table 'mine.csv:2: transition: a cell of 100000 bytes; 1 to 64 are allowed' "transition,speed\n$(head -c 100000 /dev/zero | tr '\0' x),low\n"
table 'mine.csv: 1001 rows, at most 1000' "transition,speed\n$(seq -f 'offset,%g' 1001)\n"
table 'mine.csv:10: over 8 strategies or speeds' "transition,speed\n$(seq -f 'offset,0.%g' 11 20)\n"
rm "$folder/mine.csv"
refuse 2 'mine.csv: No such file' "$study" "$folder/table.study" --out "$folder/no"
printf '[study]\nconditions = mine.csv\nspeeds = low\n' >"$folder/both.study"
refuse 2 'both.study:2: study.conditions: stands there beside study.strategies or study.speeds' "$study" "$folder/both.study" --plan

# ---- orders: printed, kept, and counted here ----
printf '[study]\nparticipants = 12\nstrategies = abrupt,smooth,offset\norder = latin\ntraining = 1\n' >"$folder/orders.study"
"$study" "$folder/orders.study" --plan >"$folder/plan" || fail "--plan"
grep -q '^   12  first  low 4:4:4  high 4:4:4  last  low 4:4:4  high 4:4:4  neighbours 4 to 4  balanced$' "$folder/plan" || fail "the balance: $(tail -n 3 "$folder/plan")"
grep -q WARNING "$folder/plan" && fail "a warning about 12"
sed 's/= 12/= 9/' "$folder/orders.study" >"$folder/nine.study"
"$study" "$folder/nine.study" --plan | grep -q "^WARNING: order = latin isn't balanced with 9 participants; 12 are$" || fail "no warning about 9"
sed 's/latin/paper/' "$folder/orders.study" >"$folder/paper.study"
"$study" "$folder/paper.study" --plan | grep -q 'no number near that is, but order = latin with 12$' || fail "no warning about the paper's order"
sed 's/^order.*/&\nseed = 2/' "$folder/orders.study" >"$folder/seed.study"
"$study" "$folder/seed.study" --plan | head -n 12 | cmp -s - "$folder/plan" && fail "latin doesn't take the seed"
"$study" "$folder/orders.study" --quiet --participant 1 --out "$folder/orders" >"$folder/out" 2>&1 || fail "orders: $(cat "$folder/out")"
"$python3" - "$folder" <<'END' || fail "the orders"
import collections, csv, sys
rows = list(csv.DictReader(open(sys.argv[1] + "/orders/orders.csv")))
plan = [l.split() for l in open(sys.argv[1] + "/plan")][:12]
for person in plan:
    mine = [r for r in rows if r["participant"] == person[0]]
    words = [("(%s-%s)" if r["part"] == "training" else "%s-%s") % (r["transition"], r["speed"]) for r in mine]
    assert words == person[1:], (words, person)
for speed in ("low", "high"):
    first, last, pair = collections.Counter(), collections.Counter(), collections.Counter()
    for person in plan:
        order = [r["transition"] for r in rows if r["participant"] == person[0] and r["part"] == "test" and r["speed"] == speed]
        first[order[0]] += 1; last[order[-1]] += 1; pair.update(zip(order, order[1:]))
    assert set(first.values()) == set(last.values()) == {4} and len(pair) == 6 and set(pair.values()) == {4}, (first, last, pair)
done = {r["block"]: (r["part"], r["transition"], r["speed"]) for r in csv.DictReader(open(sys.argv[1] + "/orders/taps.csv"))}
assert done == {r["block"]: (r["part"], r["transition"], r["speed"]) for r in rows if r["participant"] == "P01"}
END

# ---- both verdicts of a tap are those of the two rules ----
for by in paper finger; do
  printf '[study]\nname = sim\ntraining = 0\ntaps = 1\nattempts = 1\nstrategies = smooth,offset,predictive\n[validity]\nby = %s\n[grid]\ncontact.k_e = 1000,2500\ntransition.b_d = 50,100\n' $by >"$folder/$by.study"
  "$study" "$folder/$by.study" --simulate 8 --out "$folder/$by" >"$folder/out" 2>&1 && "$study" --merge "$folder/$by" >"$folder/out" 2>&1 || fail "a simulation: $(cat "$folder/out")"
done
"$python3" - "$folder" <<'END' || fail "the verdicts"
import csv, sys
ring, finger = (list(csv.DictReader(open(f"{sys.argv[1]}/{by}/taps.csv"))) for by in ("paper", "finger"))
assert len(ring) == len(finger) == 8 * 6 * 4
for a, b in zip(ring, finger):
    assert [a[k] for k in ("point", "participant", "transition", "speed", "tap")] == [b[k] for k in ("point", "participant", "transition", "speed", "tap")]
    assert a["reason"] == a["by_ring"] == b["by_ring"] and b["reason"] == b["by_finger"] == a["by_finger"], (a, b)
assert sum(a["by_ring"] != a["by_finger"] for a in ring) > 10
END

# ---- sidecars: every column of every table, with its unit where its name has one, and the words that may stand there ----
"$python3" - "$folder/whole" "$folder/paper" <<'END' || fail "the sidecars"
import csv, json, pathlib, sys
units = {"_m": "m", "_mps": "m/s", "_s": "s", "_ms": "ms", "_n": "N"}
words = {"part", "transition", "speed", "valid", "reason", "hand", "by_ring", "by_finger", "event", "status", "analysed", "checked"}
for folder in map(pathlib.Path, sys.argv[1:]):
    tables = sorted(folder.glob("*.csv"))
    names = {t.stem for t in tables if not t.stem.startswith("shard")}
    assert names == ({"taps", "survey", "events", "participants", "orders"} if folder.name == "whole" else {"taps", "orders"}), names
    for path in tables:
        rows = csv.DictReader(open(path))
        name = "taps" if path.stem.startswith("shard") else path.stem
        sidecar = json.load(open(folder / f"{name}.json"))
        assert list(sidecar) == rows.fieldnames, (path, rows.fieldnames)
        assert all(v["Description"] for v in sidecar.values())
        for column in rows.fieldnames:
            for end, unit in units.items():
                if column.endswith(end) and "." not in column: assert sidecar[column]["Units"] == unit, column
            assert ("Levels" in sidecar[column]) == ((column in words and (name, column) not in {("participants", "reason"), ("participants", "valid")}) or "." in column or column[1:].isdigit()), column
        for row in rows:
            for column, value in row.items():
                if "Levels" in sidecar[column] and value: assert value in sidecar[column]["Levels"], (path, column, value)
    readme = (folder / "README.md").read_text()
    for name in names:
        for column in json.load(open(folder / f"{name}.json")): assert f"| {column} |" in readme, column
whole, paper = sys.argv[1:]
taps = json.load(open(paper + "/taps.json"))
assert list(taps)[:3] == ["study", "point", "participant"] and list(taps)[-2:] == ["contact.k_e", "transition.b_d"]
assert taps["contact.k_e"]["Units"] == "N/m" and taps["transition.b_d"]["Units"] == "Ns/m" and set(taps["contact.k_e"]["Levels"]) == {"1000", "2500"}
assert json.load(open(whole + "/survey.json"))["q3"]["Levels"]["5"] == "very unnatural"
assert json.load(open(whole + "/dataset_description.json"))["Name"] == "small"
END

# ---- nobody's files are written over: a study.ini of somebody's, or the same one beside other files ----
for what in study.ini config.ini taps.csv taps.json; do
  mkdir "$folder/foreign"
  cp "$folder/small.study" "$folder/foreign/study.ini"
  echo mine >"$folder/foreign/$what"
  cp -r "$folder/foreign" "$folder/foreign.before"
  refuse 2 "foreign: holds $what, of another study or your own" "$study" "$folder/small.study" --out "$folder/foreign"
  rm -f "$folder/foreign/.lock"
  unchanged "$folder/foreign" "$folder/foreign.before" "a foreign $what"
  rm -r "$folder/foreign" "$folder/foreign.before"
done

# ---- study files that can't be ----
bad() { # PATTERN TEXT
  printf "$2" >"$folder/bad.study"
  refuse 2 "$1" "$study" "$folder/bad.study" --out "$folder/nothing"
  [ ! -e "$folder/nothing" ] || fail "$1: something was written"
}
bad 'bad.study:2: survey.q1: stands there without study.survey = on' '[survey]\nq1 = Why?\n'
bad 'bad.study:4: survey.q2: stands there without the questions before it' '[study]\nsurvey = on\n[survey]\nq2 = Why?\n'
bad 'bad.study:5: survey.q1: one answer' '[study]\nsurvey = on\n[survey]\nq1 = Why?\nq1_answers = so\n'
bad 'bad.study:5: survey.q1: over nine answers' '[study]\nsurvey = on\n[survey]\nq1 = Why?\nq1_answers = a|b|c|d|e|f|g|h|i|j\n'
bad 'bad.study:4: survey.q10: no key of this section; q1 to q9' '[study]\nsurvey = on\n[survey]\nq10 = Why?\n'
bad 'bad.study:4: after.q2: stands there without the questions before it' '[before]\nq1 = Why?\n[after]\nq2 = Why?\n'
bad 'bad.study:2: before.age: no key of this section; q1 to q9' '[before]\nage = Why?\n'
bad 'bad.study:2: pages.welcome: no key of this section; consent1 to' '[pages]\nwelcome = hello\n'
bad 'bad.study:2: words.tap: 191 bytes; at most 190 are allowed, any number in .pages.' "[words]\ntap = $(printf %191s | tr ' ' x)\n"
bad 'bad.study:3: found "consent2", .section. or key = value is allowed' '[pages]\nconsent1 = a ; b\nconsent2\n'
bad 'bad.study:3: pages.consent1: occurs twice' '[pages]\nconsent1 = a ; b\nconsent1 = c\n'
bad 'bad.study:2: study.rest: found "-1"' '[study]\nrest = -1\n'
bad 'bad.study:2: hand.source: found "paw", simulated|recorded|people|mouse' '[hand]\nsource = paw\n'
unchanged "$folder/whole" "$folder/kept" "the session that all of this began with"
exit $failed
