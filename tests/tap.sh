#!/bin/sh
# ethd-tap as its users see it.
set -eu
. tests/begin.sh
tap=$BUILD/bin/ethd-tap

# The same seed gives the same bytes; another one doesn't.
"$tap" --taps 6 --csv "$folder/a.csv" >"$folder/a.txt"
"$tap" --taps 6 --csv "$folder/b.csv" >"$folder/b.txt"
"$tap" --taps 6 --seed 2 --csv "$folder/c.csv" >"$folder/c.txt"
cmp "$folder/a.csv" "$folder/b.csv"
cmp "$folder/a.txt" "$folder/b.txt"
cmp -s "$folder/a.csv" "$folder/c.csv" && fail "seed 2 gives what seed 1 gives"
header=tap,transition,speed,seed,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,delta_s_ms,eps_m,t_rvo_s,t_of_s,peak_force_n,v_hand_mps,touch_depth_m,eps_felt_m,v_of_tick_mps,d_max_ring_m
[ "$(head -n 1 "$folder/a.csv")" = "$header" ] || fail "the header is $(head -n 1 "$folder/a.csv")"
[ "$(wc -l <"$folder/a.csv")" = 49 ] || fail "not 6 taps in 8 cells"

# A tap is a function of seed and number: alone, with others, in any order.
"$tap" --taps 4 --transition offset --speed high,low --csv "$folder/d.csv" >/dev/null
grep ',offset,' "$folder/a.csv" | awk -F, '$1 < 4' | sort >"$folder/a.sorted"
tail -n +2 "$folder/d.csv" | sort | diff "$folder/a.sorted" - || fail "a tap depends on the taps around it"

# Table 1 and the paper's sentences, for any seed; on plant p the finger touches early at another speed.
python=$(sh .ci/setup programs)
if [ -z "${SAN:-}" ]; then
  for run in 'n 1' 'n 20140101' 'p 1'; do
    "$tap" --taps 400 --plant "${run% *}" --seed "${run#* }" --csv "$folder/claims.csv" >"$folder/table"
    "$python" tests/tap_claims.py "$folder/claims.csv" "${run% *}" >"$folder/out" 2>&1 || { cat "$folder/table"; fail "plant and seed $run: $(tail -n 1 "$folder/out")"; }
  done
  grep -q 'within people: ethd-report tests them' "$folder/table" || fail "it doesn't say who tests"
fi
grep -q 'not realtime' "$folder/a.txt" || fail "it doesn't say that nothing is realtime"
grep -q 'not measured' "$folder/a.txt" || fail "it doesn't say that the plant is fitted"
grep -q '^scene queried [0-9]* of [0-9]* ticks$' "$folder/a.txt" || fail "it doesn't say how often the scene was asked"

# A configuration without a scene has the default wall; a scene that it names takes its place.
: >"$folder/empty.ini"
"$tap" --config "$folder/empty.ini" --taps 2 --transition offset --record "$folder/rec" --csv "$folder/e.csv" >/dev/null
[ "$(cut -d, -f13 "$folder/e.csv" | grep -c .)" = 5 ] || fail "an empty configuration has no wall"
"$BUILD/bin/ethd-replay" --verify "$folder/rec" >/dev/null
printf '[contact]\nk_e = 2501\n' >>"$folder/rec/config.ini"
code=0
"$BUILD/bin/ethd-replay" --verify "$folder/rec" >"$folder/out" 2>"$folder/err" || code=$?
[ $code = 1 ] && grep -q ': tick [1-9].*recorded .*replayed ' "$folder/err" || fail "a replay that differs: exit $code, $(cat "$folder/err")"
code=0
"$tap" --taps 1 --csv /dev/full >"$folder/out" 2>"$folder/err" || code=$?
[ $code = 1 ] && grep -q '/dev/full: No space' "$folder/err" || fail "no room for the CSV: exit $code, $(cat "$folder/err")"
printf '[contact]\nk_e = 500\n' >"$folder/soft.ini"
"$tap" --config "$folder/soft.ini" --taps 2 --transition offset --csv "$folder/s.csv" >/dev/null
cmp -s "$folder/e.csv" "$folder/s.csv" && fail "k_e changes nothing"

# The [device] section: its plant unless --plant names one, its sensor, nothing unknown.
printf '[device]\nplant = b\n' >"$folder/b.ini"
"$tap" --config "$folder/b.ini" --taps 2 --transition offset --csv "$folder/e.csv" | grep -q 'Plant b, ' || fail "the configuration's plant"
"$tap" --config "$folder/empty.ini" --plant b --taps 2 --transition offset --csv "$folder/s.csv" >/dev/null
cmp -s "$folder/e.csv" "$folder/s.csv" || fail "plant = b isn't --plant b"
"$tap" --config "$folder/b.ini" --plant n --taps 2 --transition offset --csv "$folder/s.csv" | grep -q 'Plant n, ' || fail "--plant goes first"
printf '[device]\nplant = b\nfinger = rays\n' >"$folder/rays.ini"
"$tap" --config "$folder/rays.ini" --taps 2 --transition offset --csv "$folder/s.csv" >/dev/null
cmp -s "$folder/e.csv" "$folder/s.csv" && fail "finger = rays changes nothing"

# Traces of typical taps.
"$tap" --taps 3 --transition smooth,offset --speed 0.3 --trace "$folder/traces" >/dev/null
for law in smooth offset; do
  head -n 1 "$folder/traces/$law-0.3.csv" | grep -q '^t_s,since_wall_s,ring_m,' || fail "no trace of $law"
done

# By the finger: a law that stops the ring before the wall is judged by the same hands as the others; and options.
"$tap" --taps 80 --speed low --transition offset,predictive --validity finger --csv "$folder/v.csv" >/dev/null
awk -F, 'NR > 1 { n[$2] += $5; if ($5 && $18 != "") { s[$2] += $18; m[$2]++ } hand[$1, $2] = $16 }
  END { for (i = 0; i < 80; i++) if (hand[i, "offset"] != hand[i, "predictive"]) exit 1
        exit !(n["predictive"] >= 12 && s["predictive"] / m["predictive"] < 1e-4 && s["offset"] / m["offset"] > 2e-4) }' \
  "$folder/v.csv" || fail "by the finger: $(cat "$folder/v.csv")"
# The table has the same taps twice: by the ring, which says nothing of such a law, and by the finger; its means are the CSV's.
"$tap" --taps 80 --speed low --transition offset,predictive >"$folder/v.txt"
"$tap" --taps 80 --speed low --transition offset,predictive --validity finger >"$folder/w.txt"
grep -q '^predictive low  .* stops before the wall: see below$' "$folder/v.txt" || fail "no word of a law that stops the ring: $(cat "$folder/v.txt")"
[ "$(grep -c '^offset ' "$folder/v.txt")" = 2 ] || fail "not two rows of offset: $(cat "$folder/v.txt")"
for law in offset predictive; do
  [ "$(grep "^$law " "$folder/v.txt" | tail -n 1)" = "$(grep "^$law " "$folder/w.txt")" ] || fail "two tables by the finger: $(cat "$folder/v.txt" "$folder/w.txt")"
  awk -F, -v law=$law 'NR > 1 && $2 == law && $5 { n++; s[7] += $16; s[9] += $8; s[11] += 1e3 * $9; s[13] += $10; s[15] += 1e3 * $17; s[17] += 1e3 * $18 }
    END { printf "%.3f %.3f %.2f %.3f %.3f %.3f", s[7] / n, s[9] / n, s[11] / n, s[13] / n, s[15] / n, s[17] / n }' "$folder/v.csv" >"$folder/means"
  [ "$(awk -v law=$law '$1 == law { print $6, $8, $10, $12, $14, $16 }' "$folder/w.txt")" = "$(cat "$folder/means")" ] ||
    fail "means by the finger: $(cat "$folder/means" "$folder/w.txt")"
done
"$tap" --taps 2 --speed high --transition predictive --learn 2 --set transition.learn=0.3 --set arm.mass_x=0.15 \
  --record "$folder/learnt" >/dev/null
grep -q ',learned,' "$folder/learnt/events.csv" || fail "what was learnt isn't in the recording"
"$BUILD/bin/ethd-replay" --verify "$folder/learnt" >/dev/null
"$BUILD/bin/ethd-convert" "$folder/learnt" "$folder/learnt.csv" >/dev/null
learnt=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "learnt2") c = i } NR > 1 { print $c }' "$folder/learnt.csv" | uniq)
[ "$(echo "$learnt" | wc -l)" -ge 3 ] || fail "no tick shows what the law learns: $learnt"

# A recorded movement is named, and is never scaled unless that is asked for.
awk 'BEGIN { print "t_s,x_m,y_m"; for (i = 0; i < 120; i++) { t = i / 200; printf "%.4f,%.6f,0\n", t, 0.05 * cos(5 * t) } }' \
  >"$folder/swing.csv"
"$tap" --finger "$folder/swing.csv" --speed 0.2 --taps 2 >"$folder/f.txt"
grep -q 'swing.csv, not scaled' "$folder/f.txt" || fail "it doesn't say that the movement wasn't scaled"
"$tap" --finger "$folder/swing.csv" --speed high --taps 2 --csv "$folder/f.csv" >/dev/null
[ "$(grep -c ',too-slow,' "$folder/f.csv")" = 8 ] || fail "a movement of 0.25 m/s isn't too slow for 0.4"
"$tap" --finger "$folder/swing.csv" --scale 2 --transition abrupt,smooth,offset --speed high --taps 2 --csv "$folder/g.csv" >"$folder/f.txt"
grep -q 'SCALED by 2' "$folder/f.txt" || fail "it doesn't say that the movement was scaled"
grep -q ',too-slow,' "$folder/g.csv" && fail "0.5 m/s is too slow"

# The same movement as a spreadsheet may have it: centimetres, milliseconds, semicolons, decimal commas, to +x.
awk -F, 'NR == 1 { print "Time;Left;Up" } NR > 1 { printf "%.1f;%.4f;0\n", 1e3 * $1, -100 * $2 }' "$folder/swing.csv" |
  tr . , >"$folder/sheet.csv"
"$tap" --finger "$folder/sheet.csv" --columns Time,-Left,Up --units cm,ms --speed high --taps 2 --csv "$folder/sheet-f.csv" >/dev/null
paste -d, "$folder/f.csv" "$folder/sheet-f.csv" | awk -F, '{ for (i = 1; i <= NF / 2; i++) { d = $i - $(i + NF / 2); w += d > 1e-9 || d < -1e-9 } }
  END { exit !(NR == 9 && !w) }' || fail "another writing of a movement changes its taps"

motion=${ETHD_MOTION_DIR:-tests/motion}
for file in tests/motion/*/*.csv "$motion"/*/*_tap.csv "$motion"/*/*_reach.csv "$motion"/*/*_free.csv "$motion"/*/*_move*.csv; do
  case $file in tests/* | *1.csv | *01_*) ;; *) continue ;; esac
  "$tap" --finger "$file" --taps 1 >/dev/null || fail "$file: exit $?"
done
# The example of --help, from a folder that has no such file: one that came with the programs.
example=$("$tap" --help | tr -s ' \n' ' ' | grep -o 'ethd-tap --finger [^ ]*')
(cd "$folder" && "$tap" --finger "${example##* }" --speed high --taps 2 --csv h.csv >/dev/null) || fail "$example: exit $?"
grep -q ',ok,' "$folder/h.csv" || fail "$example: no valid tap"

# Wrong usage and bad input: exit 2, one line, nothing written over.
echo precious >"$folder/kept.csv"
kept=$folder/kept.csv* try=yes
once() { "$tap" --taps 1 --csv "$folder/kept.csv" "$@"; }
refuse 2 'a whole number from 1' once --taps 0
refuse 2 'a whole number from 1' once --taps 1.5
refuse 2 'low, high and numbers' once --speed fast
refuse 2 'low, high and numbers' once --speed nan
refuse 2 'low, high and numbers' once --speed 0
refuse 2 'twice' once --speed low,low
refuse 2 'empty word' once --transition offset,
refuse 2 'abrupt' once --transition bumpy
refuse 2 'paper or finger' once --validity hand
refuse 2 '1000' once --learn 1001
refuse 2 'section.key=value' once --set force
refuse 2 'foo.bar: unknown section' once --set foo.bar=3
refuse 2 'contact.k_ee: not a key of kelvin-voigt' once --set contact.k_ee=3
refuse 2 'arm.mas_x: unknown key' once --set arm.mas_x=0.3
refuse 2 'not a key of abrupt' once --transition abrupt,smooth --set transition.b_d=50
refuse 2 'mass_x' once --set arm.mass_x=-1
refuse 2 'range' once --transition predictive --set transition.range=9
refuse 2 'whole number from 0' once --seed -1
refuse 2 'no-such' once --plant "$folder/no-such"
refuse 2 'no-such' once --config "$folder/no-such.ini"
refuse 2 'no-such' once --finger "$folder/no-such.csv"
refuse 2 'need --finger' once --scale 2
refuse 2 'need --finger' once --units cm
refuse 2 'm, cm, mm or in' once --finger "$folder/swing.csv" --units feet
refuse 2 'those of time, x and y' once --finger "$folder/swing.csv" --columns t_s
refuse 2 'from 0.01 to 100' once --finger "$folder/swing.csv" --scale 0
refuse 2 'y_m' once --finger "$folder/a.csv"
printf 'halfplane -1 0 0.9\n' >"$folder/far.scene"
printf '[scene]\nfile = far.scene\n' >"$folder/far.ini"
printf '[device]\ndriver = servo\n' >"$folder/far.ini"
refuse 2 'far.ini:2: device.driver: found "servo", sim is allowed' once --config "$folder/far.ini"
printf '[device]\nplnt = n\n' >"$folder/far.ini"
refuse 2 'far.ini:2: device.plnt: sim knows plant, ' once --config "$folder/far.ini"
printf '[device]\nplant = none\n' >"$folder/far.ini"
refuse 2 'none.plant: No such file' once --config "$folder/far.ini"
printf '[scene]\nfile = far.scene\n' >"$folder/far.ini"
refuse 2 'no wall' once --config "$folder/far.ini"

# A signal: what was done is kept.
"$tap" --taps 100000 --csv "$folder/cut.csv" --record "$folder/cut" >"$folder/out" 2>"$folder/err" &
pid=$!
sleep 1
kill -TERM $pid
code=0
wait $pid || code=$?
[ $code = 1 ] || fail "after a signal: exit $code, not 1"
grep -q 'what was done is kept' "$folder/err" || fail "it doesn't say that it was stopped"
[ "$(tail -n +2 "$folder/cut.csv" | awk -F, 'NF != 20' | wc -l)" = 0 ] || fail "a cut row"
[ "$(wc -l <"$folder/cut.csv")" -gt 1 ] || fail "nothing was kept"
"$BUILD/bin/ethd-replay" --verify "$folder/cut" >/dev/null
exit $failed
