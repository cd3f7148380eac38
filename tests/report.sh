#!/bin/sh
# ethd-report: a page that stands alone, its files, a survey with answers, a grid, recorded fingers, and what it refuses.
. tests/begin.sh
study=$BUILD/bin/ethd-study
report=$BUILD/bin/ethd-report

cat >"$folder/small.study" <<'END'
[study]
name = small <&> "study"
END
"$study" "$folder/small.study" --out "$folder/bad" >"$folder/out" 2>"$folder/err" && fail "a name that isn't a word"
cat >"$folder/small.study" <<'END'
[study]
name = small
participants = 2
taps = 1
attempts = 8
training = 1
survey = on
[statistics]
margin_d_max = 0.0005
END
"$study" --quiet "$folder/small.study" --out "$folder/a study's" >"$folder/out" 2>&1 || fail "$(cat "$folder/out")"
here="$folder/a study's"

for margin in -1 0 nan 1e9; do
  printf '[statistics]\nmargin_v_of = %s\n' "$margin" >"$folder/margin.study"
  refuse 2 'margin.study:2: statistics.margin_v_of: found' "$study" "$folder/margin.study" --out "$folder/bad"
done

# What a study asked for, for programs: each figure of the file that it was asked in, and the device's own.
"$study" --describe "$here" --out "$folder/facts" >"$folder/out" 2>&1 || fail "--describe: $(cat "$folder/out")"
"${PYTHON:-python3}" - "$folder/facts" <<'END' || fail "--describe: other facts"
import csv, json, os, sys
facts = json.load(open(os.path.join(sys.argv[1], "study.json")))
wanted = dict(name="small", hands="simulated", plant="q", device="sim", is_simulated=True, valid_by_finger=False, survey=True, margin_d_max_m=0.0005,
              strategies=["smooth", "offset"], mechanism="parallel", ring_radius_m=0.012, normal_x=-1, normal_y=0, wall_m=-0.238, grid=[])
assert {k: facts[k] for k in wanted} == wanted, facts
assert facts["speeds"]["high"] == {"centre_mps": 0.4, "band_mps": 0.03373} and len(facts["questions"]) == 3 and len(facts["hash"]) == 64, facts
for law in facts["strategies"]:
    rows = list(csv.DictReader(open(os.path.join(sys.argv[1], f"encounter-{law}.csv"))))
    assert law == "smooth" or max(float(r["offset_wall_m"] or 0) for r in rows) > 1e-3, "the offset is too small to be seen"
    assert len(rows) == 900 and max(float(r["pad_force_N"]) for r in rows) > 1 > float(rows[-1]["pad_force_N"]), law
END
"$study" --describe "$here" --out "$folder/facts" >"$folder/out" 2>&1 && fail "--describe writes over facts"

# Without gnuplot: one line, before anything is drawn.
mkdir "$folder/empty"
refuse 1 'gnuplot: not found; .*Debian: gnuplot-nox' env PATH="$folder/empty" "$report" "$here"
[ ! -e "$here/report/report.html" ] || fail "a page without gnuplot"
try=yes # of usage, argp says a second line
refuse 2 'describe needs --out DIR' "$study" --describe "$here"
if ! command -v gnuplot >/dev/null; then
  [ $failed = 0 ] || exit 1
  echo "SKIP: gnuplot (Debian: gnuplot-nox)"
  exit 77
fi

# drawn NAME ARGUMENTS...: the page, whole and alone
drawn() {
  where=$1
  shift
  "$report" --force "$@" >"$folder/out" 2>"$folder/err" || { fail "$*: $(cat "$folder/err")"; return; }
  grep . "$folder/err" && fail "$*: says something"
  page=$where/report.html
  [ "$(cat "$folder/out")" = "$page" ] || fail "$*: it says $(cat "$folder/out")"
  grep -q '^</html>$' "$page" || fail "$*: the page has no end"
  grep -qE '<script|<link|https?://|src="[^d]|url\(' "$page" && fail "$*: the page needs something else"
  [ "$(grep -o '<img ' "$page" | wc -l)" = "$(grep -o 'src="data:image/png;base64,iVBOR' "$page" | wc -l)" ] || fail "$*: a picture that is none"
  [ "$(grep -o '<table>' "$page" | wc -l)" = "$(grep -o '</table>' "$page" | wc -l)" ] || fail "$*: a table without an end"
  "${PYTHON:-python3}" tests/report_width.py "$page" || fail "$*: a column is off the screen"
  for picture in "$where"/*.png; do [ "$(wc -c <"$picture")" -gt 8000 ] || fail "$picture is empty"; done
  for table in "$where"/*.csv; do
    awk -F, '{ gsub(/"[^"]*"/, "q") } NR == 1 { n = NF } NF != n { exit 1 }' "$table" || fail "$table isn't tidy"
  done
}
drawn "$here/report" "$here"
for words in 'Simulated, not measured' 'No significance is claimed' 'smallest two-sided p is 0.5' 'Nobody has answered' 'early-contact' \
  '2 participants: <b>simulated, no person</b>' 'uses seed 1: 2000 bootstrap samples' 'sign-flip' 'fitted to the four means' \
  'none of them is evidence about people' 'VO-A: tracking fades' 'medians have no 95 % interval' 'margins of the study file' '&#177;0.5 mm (d_max) and &#177;0.02 and' \
  '<b>The task:</b> to tap once, at a speed that was asked for (low: 0.2 &#177; 0.017 m/s; high: 0.4 &#177; 0.034 m/s)' \
  "$(awk -F, 'NR > 1 && $3 == "test" && $9 { if (!n[$1 $5 $6]++) c[$1]++ } END { for (p in c) w += c[p] == 4; print "with a valid tap in every cell: " w + 0 }' "$here/taps.csv")" 'lmer(d_max_mm ~ strategy \* speed' 'second reaches the motors' 'mm into the wall that is asked for\. .* the limits let through at most 5\.[0-9] N'; do
  grep -q -e "$words" "$here/report/report.html" || fail "the page doesn't say: $words"
done
grep -q 'too few people' "$here/report/report.html" && ! grep -q '<td[^>]*>shown<' "$here/report/report.html" || fail "two people show something"
for picture in boxes braking delay reasons states encounter trace-offset-low trace-smooth-high; do
  [ -s "$here/report/$picture.png" ] || grep -q "no tap" "$folder/out" || fail "no $picture.png"
done
cp "$here/report/report.html" "$folder/before"
drawn "$here/report" "$here"
cmp "$here/report/report.html" "$folder/before" || fail "the same taps make another page"

# Every link leads somewhere on the page; the picture of an encounter has the wall's offset as its table has it.
"${PYTHON:-python3}" - "$here/report/report.html" <<'END' || fail "a dead link"
import re, sys
page = open(sys.argv[1]).read()
links, names = set(re.findall('href="#([^"]*)"', page)), set(re.findall('id="([^"]*)"', page))
sys.exit(f"{links - names} of {len(links)}" if links - names or len(links) < 10 else 0)
END
cp "$here/report/encounter-offset.csv" "$folder"
gnuplot -e "svg=1; in='$folder/encounter-offset.csv'; out='$folder/encounter.svg'" apps/plot/report-states.gp 2>"$folder/err" || fail "$(cat "$folder/err")"
grep -q "> $(awk -F, 'NR > 1 && $7 { e = $7 } END { printf "%.2f", 1e3 * e }' "$here/report/encounter-offset.csv") mm<" "$folder/encounter.svg" || fail "an encounter without eps"

# The table agrees with the taps.
awk -F, 'NR > 1 && $3 == "test" && $5 == "offset" && $6 == "low" && $9 { s += $11; n++ } END { printf "%d %.12g\n", n, s / n }' "$here/taps.csv" >"$folder/a"
awk -F, '$1 == "v_rvo" && $3 == "offset" && $4 == "low" { printf "%d %.12g\n", $5, $7 }' "$here/report/summary.csv" >"$folder/b"
cmp "$folder/a" "$folder/b" || fail "the mean: $(cat "$folder/a" "$folder/b")"

# A chosen tap, another place, taps beside.
tap=$(awk -F, '$3 == "test" && $5 == "offset" { printf "%s-%02d-%03d\n", $1, $2, $4; exit }' "$here/taps.csv")
"$study" "$BUILD/share/ethd/crowd.study" --simulate 60 --out "$folder/crowd" >/dev/null && "$study" --merge "$folder/crowd" >/dev/null || fail "the crowd"
drawn "$folder/other" "$here" --tap "$tap" --out "$folder/other" --beside "$folder/crowd" --seed 7
grep -q "tap $tap\." "$folder/other/report.html" || fail "the page doesn't name the tap"
grep -q 'uses seed 7' "$folder/other/report.html" || fail "the page doesn't state the seed"
[ "$(ls "$folder"/other/trace-*.png | wc -l)" = 1 ] || fail "other taps than the chosen one are drawn"

# Answers, made up here for the test alone.
awk -F, -v OFS=, 'NR > 1 { $5 = 3; $6 = 1 + NR % 5; $7 = 2 } 1' "$here/survey.csv" >"$folder/survey.csv" && cp "$folder/survey.csv" "$here/survey.csv"
rm -f "$here/SHA256SUMS"
drawn "$here/report" "$here"
grep -q 'Figure 18' "$here/report/report.html" && [ -s "$here/report/survey-q3.png" ] || fail "no survey"
[ "$(cut -d, -f5 "$here/report/survey-answers.csv" | sort -u | tr '\n' ' ')" = '2 n ' ] || fail "not everyone's answers count"

# What was asked of the motors and what they were given differ, as they do in the recordings.
"${PYTHON:-python3}" - "$here" <<'END' || fail "the forces aren't those of the recordings"
import csv, pathlib, sys
import numpy as np
study = pathlib.Path(sys.argv[1])
taps = [t for t in csv.DictReader(open(study / "taps.csv")) if t["part"] == "test" and t["reason"] == "ok"]
for row in csv.DictReader(open(study / "report/forces.csv")):
    most = []
    for t in taps:
        if (t["transition"], t["speed"]) == (row["transition"], row["speed"]):
            tick = np.load(study / "taps" / f"{t['participant']}-{int(t['block']):02d}-{int(t['attempt']):03d}" / "tick.npy")
            most.append((np.abs(tick["tau_raw"]).max(), np.abs(tick["tau"]).max()))
    most = np.array(most)
    assert len(most) == int(row["taps"]) > 0
    assert np.allclose([np.median(most[:, 0]), most[:, 0].max(), np.median(most[:, 1]), most[:, 1].max()],
                       [float(row[k]) for k in ("asked_Nm_median", "asked_Nm_max", "let_Nm_median", "let_Nm_max")], rtol=1e-12)
    assert float(row["asked_N_max"]) > 2 * float(row["let_N_max"]) and float(row["let_N_max"]) < 6 # plant n has 5.4 N
END

# Somebody isn't analysed.
cp -r "$here" "$folder/second"
rm -rf "$folder/second/report" "$folder/second/SHA256SUMS"
printf 'participant,status,analysed\nP01,excluded,0\nP02,complete,1\n' >"$folder/second/participants.csv"
drawn "$folder/one" "$folder/second" --out "$folder/one"
[ "$(awk -F, '$1 == "v_of" && $3 == "smooth" && $4 == "low" { print $6 }' "$folder/one/summary.csv")" = 1 ] || fail "the excluded participant's taps are counted"
grep -q 'of 1 participant who is not analysed' "$folder/one/report.html" || fail "the page doesn't say that somebody is left out"

# The report says how many people have all cells, and counts outcomes from the tables.
drawn "$folder/crowd/report" "$folder/crowd"
found=$(awk -F, 'NR > 1 { n++; k += $14 < 0.05 && $14 != "" } END { print n, k }' "$folder/crowd/report/pairs.csv")
grep -q "of ${found% *} <a href=\"#pairs\">differences between strategies</a> ${found#* } are significant" "$folder/crowd/report/report.html" || fail "what came out isn't what pairs.csv says: $found"
grep -q "of 10 <a href=\"#claims\">sentences of the paper</a> $("${PYTHON:-python3}" -c "
import csv, sys
v = {r['claim']: r['verdict'] for r in csv.DictReader(open(sys.argv[1]))}.values()
v = list(v)
print(v.count('shown'), 'are shown, of', v.count('the contrary is shown'))" "$folder/crowd/report/claims.csv") the contrary is shown" "$folder/crowd/report/report.html" || fail "what came out isn't what claims.csv says"

# The report of several stations is that of the merged folder, table by table and word by word; it refuses what --merge does.
for k in 1 2; do "$study" --quiet "$folder/small.study" --participant $k --out "$folder/station$k" >"$folder/out" 2>&1 || fail "station $k: $(cat "$folder/out")"; done
"$study" --resume "$folder/station2" --exclude 2 --reason 'told another task' >"$folder/out" 2>&1 || fail "exclude: $(cat "$folder/out")"
"$study" --merge "$folder/station1" "$folder/station2" --out "$folder/merged" >"$folder/out" 2>&1 || fail "merge: $(cat "$folder/out")"
drawn "$folder/both" "$folder/station1" "$folder/station2" --out "$folder/both"
drawn "$folder/merged/report" "$folder/merged"
tables=0
for table in "$folder"/merged/report/*.csv; do cmp "$table" "$folder/both/$(basename "$table")" && tables=$((tables + 1)); done
[ $tables -ge 12 ] && [ $tables = "$(ls "$folder"/both/*.csv | wc -l)" ] || fail "$tables tables are the merged folder's"
grep -v SHA256SUMS "$folder/merged/report/report.html" >"$folder/a"
grep -v SHA256SUMS "$folder/both/report.html" | cmp - "$folder/a" || fail "the stations' page isn't the merged folder's"
grep -q 'at 2 stations of one study' "$folder/both/report.html" && grep -q 'who \(is\|are\) not analysed' "$folder/both/report.html" || fail "the page doesn't name stations and who is left out"
alike() { # EXIT PATTERN FOLDERS..: one sentence, of both
  code=$1 pattern=$2
  shift 2
  "$study" --merge "$@" --out "$folder/none" >"$folder/out" 2>"$folder/a"
  [ $? = "$code" ] && grep -q -e "$pattern" "$folder/a" || fail "--merge: $pattern: $(cat "$folder/a")"
  "$report" "$@" --out "$folder/none" >"$folder/out" 2>"$folder/b"
  [ $? = "$code" ] && [ "$(sed 's/^ethd-report: //' "$folder/b")" = "$(sed 's/^ethd-study: //' "$folder/a")" ] || fail "two sentences: $(cat "$folder/a" "$folder/b")"
  [ ! -e "$folder/none" ] || fail "a refusal has written: $pattern"
}
alike 2 'P01 has tapped there and in .*; one participant, one station' "$folder/station1" "$folder/merged"
cp -r "$folder/station2" "$folder/worse"
printf ' ' >>"$folder/worse/taps.csv"
alike 2 "taps.csv isn't what it was" "$folder/station1" "$folder/worse"
rm "$folder/worse/SHA256SUMS"
alike 2 'SHA256SUMS: No such file' "$folder/station1" "$folder/worse"
printf x | dd of="$folder/worse/study.sqlite" bs=1 seek=4096 conv=notrunc 2>/dev/null
alike 2 'worse/study.sqlite: ' "$folder/worse" "$folder/station1"
rm "$folder/worse/study.sqlite"
alike 2 'study.sqlite: No such file' "$folder/station1" "$folder/worse"
printf '[study]\nname = small\nparticipants = 2\ntaps = 1\nattempts = 2\n' >"$folder/else.study"
"$study" --quiet "$folder/else.study" --participant 2 --out "$folder/else" >"$folder/out" 2>&1 || fail "$(cat "$folder/out")"
alike 2 'its study, configuration, walls or plant are other ones than those of' "$folder/station1" "$folder/else"

# A grid.
printf '[study]\ntraining = 0\ntaps = 1\nattempts = 6\n[grid]\ncontact.k_e = 1000,2500\ntransition.b_d = 50,100\n' >"$folder/grid.study"
"$study" "$folder/grid.study" --simulate 7 --out "$folder/grid" >/dev/null && "$study" --merge "$folder/grid" >/dev/null || fail "the grid's taps"
drawn "$folder/grid/report" "$folder/grid" --point 3
[ "$(wc -l <"$folder/grid/report/grid.csv")" = 17 ] || fail "not 4 points x 4 cells: $(wc -l <"$folder/grid/report/grid.csv")"
grep -q 'show point 3 of 4' "$folder/grid/report/report.html" || fail "the page doesn't name its point"
grep -q 'No ticks were recorded' "$folder/grid/report/report.html" || fail "the page draws ticks that aren't there"

# Recorded people's movements are said to be that, and so is who led the hand where the taps differ in it.
printf '[study]\nparticipants = 1\ntraining = 0\ntaps = 1\nattempts = 2\nspeeds = low\n[hand]\nsource = recorded\nmotion = avraham_free_mit\n' >"$folder/recorded.study"
"$study" --quiet "$folder/recorded.study" --out "$folder/recorded" >"$folder/out" 2>&1 || fail "$(cat "$folder/out")"
drawn "$folder/recorded/report" "$folder/recorded"
grep -q '1 participant: <b>simulated</b>, with hands that move as those of <b>recorded people</b> did: movements of <code>avraham_free_mit</code>' "$folder/recorded/report/report.html" || fail "the page doesn't say that people were recorded"
awk -F, -v OFS=, '{ for (i = 1; i <= NF; i++) if ($i == "hand") h = i } NR == 1 && !h { $(NF + 1) = "hand" } NR > 1 { $(h ? h : NF + 1) = NR % 2 ? "mouse" : "recorded" } 1' \
  "$folder/recorded/taps.csv" >"$folder/taps.csv" && cp "$folder/taps.csv" "$folder/recorded/taps.csv"
drawn "$folder/recorded/report" "$folder/recorded"
grep -q 'led the hand with a pointer' "$folder/recorded/report/report.html" && grep -q 'come from several sources' "$folder/recorded/report/report.html" ||
  fail "the page doesn't say that the taps have several sources"

# A simulation's ticks, of one worker out of two: its taps are drawn, no others.
printf '[study]\ntraining = 1\ntaps = 1\nattempts = 6\n[grid]\ncontact.k_e = 1000,2500\n' >"$folder/ticks.study"
"$study" "$folder/ticks.study" --simulate 4 --shard 1/2 --out "$folder/ticks" >/dev/null &&
  "$study" "$folder/ticks.study" --simulate 4 --shard 2/2 --ticks --out "$folder/ticks" >/dev/null &&
  "$study" --merge "$folder/ticks" >/dev/null || fail "the simulation's taps"
drawn "$folder/ticks/report" "$folder/ticks" --point 1
grep -o 'figcaption>As figure [0-9]* of the paper, a tap of one participant: [^<]*' "$folder/ticks/report/report.html" >"$folder/captions"
[ "$(cut -d' ' -f3 "$folder/captions" | sort -u | wc -l)" = 4 ] || fail "not a trace for each cell: $(cat "$folder/captions")"
while read -r _ _ number _ _ _ _ _ _ _ _ law speed _ tap _; do
  law=${law%,} speed=${speed%,} tap=${tap%,} chosen="$tap $law-$speed"
  case "$number $law-$speed" in
    "9 smooth-low" | "10 offset-low" | "11 smooth-high" | "12 offset-high") ;;
    *) fail "figure $number of the paper is another cell than $law, $speed" ;;
  esac
  [ -d "$folder/ticks/taps-2-of-2/$tap" ] || fail "$tap isn't recorded"
  sed 's/-/,/g; s/,0*/,/g' <<END | { IFS=, read -r point person block attempt
$tap
END
    awk -F, -v P="$point" -v I="${person#P}" -v B="$block" -v A="$attempt" -v L="$law" -v S="$speed" '
      $2 == P && substr($3, 2) + 0 == I + 0 && $4 == B && $6 == A && $7 == L && $8 == S && $11 { n++ } END { exit n != 1 }' \
      "$folder/ticks/taps.csv"; } || fail "$tap isn't a valid tap of $law, $speed"
done <"$folder/captions"
drawn "$folder/other2" "$folder/ticks" --tap "${chosen% *}" --point 1 --out "$folder/other2"
[ "$(ls "$folder"/other2/trace-*.png)" = "$folder/other2/trace-${chosen#* }.png" ] || fail "other taps than the chosen one are drawn"

# ---- refusals ----
bad() { # SED PATTERN: a table that was changed
  rm -rf "$folder/bad"
  cp -r "$folder/grid" "$folder/bad"
  sed -i "$1" "$folder/bad/taps.csv"
  refuse 2 "$2" "$report" "$folder/bad"
}
refuse 2 'DIR is needed' "$report"
refuse 2 'P01 has tapped there and in' "$report" "$here" "$here" --out "$folder/both" --force
refuse 2 'nowhere/study.ini: No such file' "$report" "$folder/nowhere"
refuse 2 'no test tap at point 9 of 4' "$report" "$folder/grid" --point 9
refuse 1 'no test tap P09-01-001' "$report" "$here" --force --tap P09-01-001
refuse 2 "report: holds .* already; --force" "$report" "$here"
refuse 2 "is the study's own folder" "$report" "$here" --out "$here" --force
bad '3s/,ok,/,fine,/' 'taps.csv:[0-9]*: reason: found "fine"\|'
bad '1s/,reason,/,why,/' 'taps.csv:1: no column reason'
bad '4s/$/,1/' 'taps.csv:4: found 36 cells, 35 are allowed'
bad 's/,ok,/,ok,x/' 'taps.csv:[0-9]*: v_rvo_mps: found "x'
bad '2,$d' 'no test tap'
rm "$folder/bad/taps.csv"
refuse 2 'taps.csv: No such file; ethd-study --resume' "$report" "$folder/bad"
echo untouched >"$folder/grid/report/report.html"
(ulimit -f 100; exec "$report" --force "$folder/grid") >"$folder/out" 2>"$folder/err" && fail "a quota for the page"
[ "$(cat "$folder/grid/report/report.html")" = untouched ] || fail "a page that was cut"

[ $failed = 0 ] && echo "$(ls "$here"/report/*.png | wc -l) pictures on $(wc -c <"$here/report/report.html") bytes of page"
exit $failed
