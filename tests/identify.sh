#!/bin/sh
# ethd-identify: it finds plants again from recordings, also an arm that numpy integrates; it says what doesn't fit; refusals.
# PLANTS=20 SECONDS_EACH=12 tries that many random plants and the intervals' coverage.
. tests/begin.sh
bin=$BUILD/bin
tests=$(cd "$(dirname "$0")" && pwd)
cd "$folder" || exit 1
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for fits"; exit 77; }

if [ -n "${PLANTS:-}" ]; then
  exec "$PYTHON" "$tests/identify_plants.py" "$bin" "$tests/../apps/config" "$PLANTS" 5 "${SECONDS_EACH:-12}"
fi


# A recording, which repeats to the bit and keeps its box; the same input gives the same plant.
printf '[device]\nplant = n\n' >n.ini
"$bin/ethd-identify" --excite --virtual --config n.ini --duration 6.158 --record sines >said || fail "excite: exit $?"
grep -q 'dry run  .*simulated' said || fail "the dry run isn't said"
"$bin/ethd-replay" --verify sines >/dev/null || fail "the recording doesn't repeat"
"$bin/ethd-identify" sines --out n.plant >said || fail "sines: exit $?"
grep -q 'pad_stiffness' said && ! grep -q 'NOT EXPLAINED' said || fail "what is said of n: $(cat said)"
"$bin/ethd-identify" sines --out again.plant >/dev/null && cmp n.plant again.plant || fail "the same input gives another plant"
awk '$1 == "mass_x" && ($3 < 0.1138 || $3 > 0.1208) || $1 == "mass_y" && ($3 < 0.2425 || $3 > 0.2575) ||
  $1 == "friction" && ($3 < 0.34 || $3 > 0.46) || $1 == "delay" && ($3 < 0.041e-3 || $3 > 0.101e-3) ||
  $1 == "stiffness" && $3 != "inf" { print "FAILED n.plant: " $0; bad = 1 } END { exit bad }' n.plant || failed=1
grep -q '^hand_damping .*not determined, kept as in q$' n.plant || fail "what isn't seen isn't said"

# The same for an elastic arm, whose transmission it tells from a rigid one.
printf '[device]\nplant = p\n' >p.ini
"$bin/ethd-identify" --excite --virtual --config p.ini --duration 6.158 --record elastic >/dev/null || fail "excite p: exit $?"
"$bin/ethd-identify" elastic --out p.plant >said && "$bin/ethd-identify" elastic --out again.plant >/dev/null &&
  cmp p.plant again.plant || fail "p: the same input gives another plant"
awk '$1 == "stiffness" && !($3 > 3385 && $3 < 3595) || $1 == "motor_mass" && !($3 > 0.0126 && $3 < 0.0139) ||
  $1 == "mass_x" && !($3 > 0.0919 && $3 < 0.0976) { print "FAILED p.plant: " $0; bad = 1 } END { exit bad }' p.plant || failed=1

# It predicts a session that it wasn't fitted to; another plant does so worse.
"$bin/ethd-identify" --excite --virtual --config n.ini --duration 9 --record more >/dev/null || fail "excite again: exit $?"
judged() { "$bin/ethd-identify" --judge "$1" more | sed -n 's/.*joint 1.*ahead .* (\(.*\) counts)$/\1/p'; }
awk -v own="$(judged n.plant)" -v other="$(judged b)" 'BEGIN { exit !(own > 0 && own < 2 && other > 3 * own) }' ||
  fail "judged: $(judged n.plant) and $(judged b) counts after 50 ms"

# An arm that this simulator didn't make, within its intervals; the same with motors weaker than the commands; with play.
arm() { "$PYTHON" "$tests/identify_arm.py" "$@"; }
arm make sines arm && "$bin/ethd-identify" arm --out arm.plant >said && arm check arm.plant || fail "numpy's arm"
if "$PYTHON" -c 'import scipy.optimize' 2>/dev/null; then
  arm scipy arm arm.plant || fail "scipy comes to other numbers"
else
  echo "python3-scipy isn't here: nobody else fits the same windows"
fi
arm make sines fresh inf 0 1.7 || fail "numpy's arm, again"
for plant in arm.plant "$bin/../share/ethd/b.plant"; do
  "$bin/ethd-identify" --judge "$plant" fresh >said && arm judge fresh "$plant" said || fail "what --judge says of $plant: $(cat said)"
done
arm make sines weak 4.5 && "$bin/ethd-identify" weak --out weak.plant >said && arm check weak.plant force_limit=4.5 || fail "weak motors"
arm make sines loose inf 0.0006 && "$bin/ethd-identify" loose >said || fail "an arm with play"
grep -q 'NOT EXPLAINED' said || fail "play isn't told: $(cat said)"

# Through swaps of the law and its gains, ticks without an answer, measurements that aren't numbers and the stops and new
# starts that follow, the numbers stay right.
printf '1.3 read stale for=0.004\n2.7 q1 nan for=0.003\n1.9 read stale for=0.003\n' >troubled.inject
sed 's/^driver = .*/&\ninject = troubled.inject/' sines/config.ini >troubled.ini
printf 'wait 2\ntransition smooth\nwait 1.5\nack\nwait 0.05\nenable\nwait 1\nset tracking.k_t 6\nwait 2.5\ntransition offset\nack\nwait 0.05\nenable\n' |
  "$bin/ethd-run" --virtual --duration 10 --config troubled.ini --record troubled >/dev/null 2>&1
[ "$(grep -c ',fault,' troubled/events.csv)" = 3 ] && [ "$(grep -c ',transition,' troubled/events.csv)" = 2 ] ||
  fail "the trouble isn't in the recording: $(cat troubled/events.csv)"
"$bin/ethd-identify" troubled --base b --out troubled.plant >said || fail "troubled: exit $?"
grep -q 'NOT EXPLAINED' said && fail "swaps and faults are taken for the device: $(cat said)"
awk '$1 == "mass_x" && ($3 < 0.1161 || $3 > 0.1185) || $1 == "mass_y" && ($3 < 0.2475 || $3 > 0.2525) ||
  $1 == "friction" && ($3 < 0.39 || $3 > 0.406) || $1 == "viscous" && ($3 < 1.2 || $3 > 1.33) ||
  $1 == "delay" && ($3 < 0.051e-3 || $3 > 0.091e-3) { print "FAILED troubled.plant: " $0; bad = 1 } END { exit bad }' troubled.plant || failed=1

# In real time, ended by a signal: the device is stopped, and what was recorded repeats to the bit; the dry run came first.
"$bin/ethd-identify" --excite --duration 60 --record live >said 2>err &
live=$!
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do [ -s live/tick.npy ] && break; sleep 0.5; done
sleep 1
kill -TERM $live
wait $live || fail "excite until a signal: exit $?: $(cat err)"
sed -n 1p said | grep -q '^torques up to' && sed -n 3p said | grep -q '^dry run .*simulated' || fail "what will be done comes first: $(cat said)"
grep -q ',end,closed' live/events.csv && "$bin/ethd-replay" --verify live >/dev/null || fail "the recording isn't whole"

identify() { "$bin/ethd-identify" "$@" --out none.plant; }
kept=none.plant try=yes
mkdir empty
refuse 2 'no recording' identify empty
mkdir still && sed 's/x/x/' sines/config.ini >still/config.ini && cp sines/events.csv still &&
  "$PYTHON" -c 'import numpy as n; r = n.load("sines/tick.npy"); r["q"][:] = r["q"][0]; n.save("still/tick.npy", r)'
refuse 2 'hardly moves.*record' identify still
"$bin/ethd-run" --virtual --duration 1 --record short >/dev/null </dev/null
refuse 2 'windows of .*are needed; record more' identify short
for what in 'no_numbers:r["q"][:] = n.nan' 'uneven:r["time_ns"] *= 2'; do
  name=${what%%:*}
  cp -r sines "$name" && "$PYTHON" -c "import numpy as n; r = n.load('sines/tick.npy'); ${what#*:}; n.save('$name/tick.npy', r)"
done
refuse 2 "aren't numbers: .*record" identify no_numbers
refuse 2 "don't come 0.001 s after the one before.*record" identify uneven
mkdir clipped && cp sines/config.ini sines/events.csv clipped &&
  "$PYTHON" -c 'import numpy as n; r = n.load("sines/tick.npy"); r["guard"][:] = 2; n.save("clipped/tick.npy", r)'
refuse 2 'the guard cut the torque in 100 %.*record' identify clipped
cp -r sines other && sed -i 's/^\[tracking\]/[arm]\nlink1 = 0.3\n[tracking]/' other/config.ini
refuse 2 'of another arm' identify sines other
refuse 2 'two devices are mixed' identify sines arm
sed '/^mass_x/s/0.1173/0.1290/' "$bin/../share/ethd/n.plant" >heavy.plant
printf '[device]\nplant = heavy.plant\n' >heavy.ini
"$bin/ethd-identify" --excite --virtual --config heavy.ini --duration 6.158 --record heavy >/dev/null || fail "excite heavy: exit $?"
refuse 2 'heavy: of another device than the rest, by itself its mass is 10 % more: .*record' identify sines heavy
refuse 2 'needs --record\|excite needs' identify --excite
exit $failed
