#!/bin/sh
# ethd-calibrate: the self-test, recorded counts, what is refused, and a guided session on a pty.
. tests/begin.sh
program=$BUILD/bin/ethd-calibrate
tests=$(cd "$(dirname "$0")" && pwd)
cd "$folder" || exit 1


for seed in 1 2 3; do
  "$program" --self-test --seed $seed --record counts.csv --csv points.csv --out ring.ini --serial 'ring 7' >self ||
    fail "self-test $seed: exit $?"
done
grep -q '^  law  *0\.0' self || fail "no error of the law: $(cat self)"
grep -q '^level = law$' ring.ini && grep -q '^serial = ring 7$' ring.ini && grep -q '^date = 20' ring.ini || fail "ring.ini: $(head -5 ring.ini)"
[ "$(grep -c '^\[sensor' ring.ini)" = 16 ] || fail "ring.ini: not 16 sensors"
[ "$(wc -l <counts.csv)" = 19 ] || fail "counts.csv: $(wc -l <counts.csv) lines"
"$program" --self-test --noise 3000 >/dev/null && fail "a self-test with too much noise passes"

# The same counts from the file give the same calibration.
"$program" --in counts.csv --out again.ini --serial 'ring 7' >again || fail "recorded counts: exit $?"
cmp ring.ini again.ini || fail "recorded counts give another calibration"
for level in none common gain law table; do
  "$program" --in counts.csv --level $level --out $level.ini >/dev/null && grep -q "^level = $level\$" $level.ini || fail "level $level"
done

head -1 counts.csv >short.csv
sed '2d' counts.csv >unempty.csv
sed '5s/^\([^,]*\),/9,/' counts.csv >far.csv
cut -d, -f1-19 counts.csv >narrow.csv
sed '4s/,[^,]*$/,70000/' counts.csv >much.csv
try=yes
refuse 2 'one of --port, --in and --self-test is needed' "$program"
refuse 2 'one of --port, --in and --self-test is needed' "$program" --self-test --in counts.csv
refuse 2 '--level: found "best"' "$program" --self-test --level best
refuse 2 '--plot draws the file of --csv' "$program" --self-test --plot x.png
refuse 2 '--rod: a rod thinner than the ring is needed' "$program" --self-test --rod 0.02
refuse 2 '--serial: found' "$program" --self-test --serial 'a;b'
refuse 2 'short.csv: 0 rows; the empty ring and places are needed' "$program" --in short.csv
refuse 2 'unempty.csv:2: the empty ring, rod_m 0, comes first' "$program" --in unempty.csv
refuse 2 'far.csv:5: the empty ring' "$program" --in far.csv
refuse 2 'narrow.csv:1: the column c15 is missing' "$program" --in narrow.csv
refuse 2 'much.csv:4: c15: found 70000, 0 to 65535 is allowed' "$program" --in much.csv
refuse 2 'nowhere.csv: No such file' "$program" --in nowhere.csv
refuse 1 'nowhere: No such file' "$program" --port nowhere
refuse 1 "isn't a serial line" "$program" --port /dev/null

"$PYTHON" "$tests/calibrate_guided.py" "$program" || fail "the guided session"
exit $failed
