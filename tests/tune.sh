#!/bin/sh
# ethd-tune: what it chooses is better than what it began from by another program's figures, keeps its margins by another
# program's bounds, and is the same in a second run. Bad input. ETHD_WHOLE=1: also for an identified plant, as make ci does.
. tests/begin.sh
bin=$BUILD/bin
tests=$(cd "$(dirname "$0")" && pwd)
tune() { "$bin/ethd-tune" --plant n --points 16 --taps 40 "$@"; }
cd "$folder" || exit 1

tune --out one.ini --csv one.csv >one.txt 2>err || fail "a search: $(cat err)"
tune --out two.ini --csv two.csv >two.txt 2>err || fail "a second run: $(cat err)"
for name in ini csv txt; do cmp one.$name two.$name || fail "a second run gives another .$name"; done

# What each gain buys stands at the top of the file that is written, and in --help.
for key in tracking.k_t transition.b_d velocity.cutoff; do
  grep -q "^#   $key .* [0-9.]* *[0-9.]*$" one.ini || fail "one.ini doesn't say what $key buys"
  "$bin/ethd-tune" --help | grep -q "$key: a\|$key: l\|$key: q" || fail "--help doesn't say what $key buys"
done

# Which points settle at their margins in time stands in the table: all of the last round do, and no other is chosen.
"${PYTHON:-python3}" - "$(sed -n 's/.*margins (\([0-9]*\) tried).*/\1/p' one.txt)" <<'END' || fail "the table doesn't say what settles"
import csv, sys
rows = list(csv.DictReader(open("one.csv")))
tried = [r for r in rows if r["round"] == "3" and r["settled"]]
last = [r for r in rows if r["round"] == "4" and r["point"] != "0"]
assert len(tried) == int(sys.argv[1]) >= len(last) == sum(float(r["settled"]) for r in tried) > 0, (len(tried), len(last))
assert all(r["settled"] == "1" for r in last) and all(r["settled"] == "1" for r in rows if r["chosen"] == "1")
assert not any(r["settled"] for r in rows if r["keeps"] == "0")
END

# Its margins are ethd-check's: no bound exceeded, nothing thin.
"$bin/ethd-check" one.ini >check.txt 2>err || fail "ethd-check refuses it: $(cat err)"
sed -n '/^stability/,/^passivity/p' check.txt | grep -E 'EXCEEDED|thin' && fail "thin margins by ethd-check"

# On p, whose transmission gives way, the own gains of the wall and the brake are unstable on the motors' side, for
# ethd-check and for ethd-tune in the same words; those that are chosen keep their margins, and the torque rests.
"$bin/ethd-tune" --plant p --points 8 --taps 20 --out p.ini >p.txt 2>err || fail "a search on p: $(cat err)"
"$bin/ethd-check" "$bin/../share/ethd/p.ini" | grep -q 'one encoder count makes .*: the ring chatters' ||
  fail "ethd-check doesn't say that p's own gains chatter"
grep -q 'own, thin' p.txt || fail "ethd-tune takes p's own gains as stable"
"$bin/ethd-check" p.ini >check.txt
stability() { sed -n '/^  loop/,/^$/p' "$1" | sed '/^What each/,$d'; }
stability check.txt | grep -E 'EXCEEDED|thin' && fail "thin margins on p by ethd-check"
stability check.txt >a
stability p.txt >b
[ -s a ] && cmp a b || fail "ethd-check and ethd-tune say other margins on p"
unrest() { # CONFIG: rms change of the torque from tick to tick, at the end of a tap
  "$bin/ethd-tap" --config "$1" --plant p --transition offset --speed high --taps 12 --seed 7 --force --trace rest >/dev/null
  "${PYTHON:-python3}" -c '
import csv
t = [float(r["tau1_Nm"]) for r in csv.DictReader(open("rest/offset-high.csv"))][-50:]
print((sum((a - b) ** 2 for a, b in zip(t, t[1:])) / 49) ** 0.5)'
}
was=$(unrest "$bin/../share/ethd/p.ini") is=$(unrest p.ini)
echo "torque at the end of a tap on p, Nm a tick: $was -> $is"
"${PYTHON:-python3}" -c "import sys; sys.exit(not $is < 0.3 * $was)" || fail "p still chatters"

# Its taps are ethd-tap's: fewer early contacts, and none of the paper's figures of the wall is worse.
figure() { # CONFIG COLUMN: of the high speed's row
  "$bin/ethd-tap" --config "$1" --plant n --transition offset --speed high --taps 200 --seed 7 --csv taps.csv >/dev/null 2>err ||
    fail "ethd-tap $1: $(cat err)"
  "${PYTHON:-python3}" - "$2" <<'END'
import csv, sys
rows = list(csv.DictReader(open("taps.csv")))
valid = [r for r in rows if r["reason"] == "ok"]
print(sum(r["reason"] == "early-contact" for r in rows) / len(rows) if sys.argv[1] == "early"
      else sum(float(r[sys.argv[1]]) for r in valid) / len(valid))
END
}
for what in early eps_m d_max_m; do
  was=$(figure "$bin/../share/ethd/n.ini" $what) is=$(figure one.ini $what)
  echo "$what at high speed: $was -> $is"
  "${PYTHON:-python3}" -c "import sys; sys.exit(not $is <= 1.1 * $was)" || fail "$what got worse: $was -> $is"
done

# A device that is known only from its recordings; with ETHD_WHOLE=1 PLANTS=5 POINTS=64 TAPS=80 tries more plants, more thoroughly.
if [ -n "${ETHD_WHOLE:-}" ] && [ -z "${SAN:-}" ]; then
  "${PYTHON:-python3}" "$tests/tune_plants.py" "$bin" "$bin/../share/ethd" "${PLANTS:-1}" 5 20 "${POINTS:-16}" "${TAPS:-40}" ||
    fail "an identified plant"
fi

try=yes
refuse 2 'plant is needed' "$bin/ethd-tune"
refuse 2 'section.key=LOW:HIGH' "$bin/ethd-tune" --plant n --range contact.k_e
refuse 2 'section.key=LOW:HIGH' "$bin/ethd-tune" --plant n --range contact.k_e=4:2
refuse 2 'nothing' "$bin/ethd-tune" --plant n --range nothing.k=1:2
refuse 2 'tracking, brake, wall and calm' "$bin/ethd-tune" --plant n --prefer speed
refuse 2 'needs --csv' "$bin/ethd-tune" --plant n --plot x.png
refuse 2 'hardly any gains' "$bin/ethd-tune" --plant n --points 8 --gain-margin 50
refuse 2 'k_e T/2 + b_e under the device.s 1.27 Ns/m' "$bin/ethd-tune" --plant n --points 8 --passive
tune --passive --points 8 --taps 20 --range contact.k_e=100:1500 --range contact.b_e=0.05:0.5 --out passive.ini >/dev/null 2>err || fail "--passive: $(cat err)"
awk '$1 == "k_e" { k = $3 } $1 == "b_e" { b = $3 } END { exit !(k > 0 && k * 0.0005 + b <= 1.267) }' passive.ini || fail "the wall isn't passive: $(grep -E '^[kb]_e' passive.ini)"
refuse 2 'no such file\|No such file' "$bin/ethd-tune" --plant nowhere.plant
# a signal: no result of half a search
"$bin/ethd-tune" --plant n --out half.ini >out 2>err &
search=$!
sleep 1
kill -TERM $search
wait $search
[ $? = 1 ] && grep -q 'stopped; nothing is written' err && [ ! -e half.ini ] || fail "a search that was ended: $(cat err)"
printf '[plugins]\nfile = %s\n[transition]\nlaw = brake-ahead\n' "$BUILD/tests/plugins/mylaw.so" >foreign.ini
refuse 2 "the law brake-ahead doesn't name its gains" "$bin/ethd-tune" --plant n --config foreign.ini
cp one.ini own.ini
refuse 2 'only read' "$bin/ethd-tune" --config own.ini --out own.ini
exit $failed
