#!/bin/sh
# Taps of plant q, integrated again by SciPy from the equations in include/ethd/sim.h.
. tests/begin.sh
python=${PYTHON:-python3}
"$BUILD/bin/ethd-tap" --plant q --taps 1 --transition smooth,offset --record "$folder/taps" >"$folder/out" || fail "exit $?"
"$python" tests/simulator.py "$BUILD/share/ethd/q.plant" "$folder/taps" || failed=1
# A number that is 0.1 % off is seen.
sed 's/^pad_stiffness = 22480/pad_stiffness = 22500/' "$BUILD/share/ethd/q.plant" >"$folder/other.plant"
"$python" tests/simulator.py "$folder/other.plant" "$folder/taps" >"$folder/out" 2>&1 && fail "another pad isn't seen"
grep -q AssertionError "$folder/out" || fail "$(cat "$folder/out")"
exit $failed
