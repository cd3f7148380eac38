#!/bin/sh
# Rows 4, 5, 8, 11, 12, 13 and 36 of the fault table before a drive of another's making (an SVD48V by pymodbus, on a serial
# line), each within its bound, in the drive's own time or in ticks. The rows of the drive itself are in servo_drive.sh.
set -u
. tests/peers/desk.sh
. tests/peers/drive.sh
cp apps/config/wall.scene "$folder"
slow_map apps/config/svd48v.map "$folder/svd48v.map"

# row 4: one answer is missing; it is counted, and ends nothing
broken mute 'mute 1' never
grep -q "x the servo didn't answer once" "$folder/mute.out" || fail "row 4 isn't counted: $(cat "$folder/mute.out")"
# row 11: one wrong count is told and ends nothing; a counter that stays elsewhere, or jumps twice within 10 ms, does
broken spike 'jump 1; 0.605=jump -1' never
grep -q 'x an encoder jumped' "$folder/spike.out" || fail "row 11 isn't counted: $(cat "$folder/spike.out")"
broken jump 'jump 1' 0.02 'an encoder jumped, twice in 10 ms'
# row 13: let go under torque, joint 1 counts the other way round: 20 ms, and two exchanges until zero is there
broken reversed 'reversed 1; free' 0.04 'the arm runs away: an encoder or a motor is reversed'
# row 12: the arm goes and its encoder stands: 50 ms after the torque has risen by 0.35 Nm, of 0.9 in 0.1 s, and two exchanges
when=asked first=free stiff=3600 broken frozen 'frozen 1' 0.11 'an encoder stands still under torque'

# ticks from the last sample to the tick at which a row stopped the ring
ticks() { # NAME ROW MOST
  "$python3" - "$folder/$1" "$2" "$3" <<'END' || fail "row $2, $1: $(cat "$folder/$1.out")"
import sys
import numpy as np
r = np.load(sys.argv[1] + "/tick.npy")
row, most = int(sys.argv[2]), int(sys.argv[3])
at = np.flatnonzero(r["fault"] == row)[0]
last = np.flatnonzero(np.diff(r["time_ns"][:at + 1], prepend=0) > 0)[-1]
ticks = int(np.sum(1 + r["missed"][last + 1:at + 1]))  # a row a step; between two there may be ticks without one
print(f"row {row}: {ticks} ticks after the last sample, {most} are allowed")
assert ticks <= most and np.all(r["tau"][at:] == 0)
END
}
lost() { # NAME COMMAND SENTENCE: like broken, but with a recording, since the drive can no longer say what it sees
  drive svd48v --lock-step 0.005
  tell hold >/dev/null
  servo_ini "$1" quick.map 'q1 = 1.5747963' 'q2 = 0'
  what=$2
  [ "$what" != line ] || what="end $wire"
  tell at 0.6 "$what" >/dev/null
  printf 'wait 1.2\nstatus\nstop\n' | "$run" --config "$folder/$1.ini" --virtual --duration 9 --record "$folder/$1" >"$folder/$1.out" 2>&1 ||
    fail "$1: exit $?: $(cat "$folder/$1.out")"
  drive_ends
  says "$folder/$1.out" "fault: $3\$" '^ok: t 1.2.* disabled, '
}
sed -e 's/^response = .*/response = 0.1/' -e 's/^drain = .*/drain = 0.01/' apps/config/svd48v.map >"$folder/quick.map"
# row 5: no answer comes: two exchanges, 10 ms, and the tick that sees it
lost silent 'mute 25' "the servo's feedback is too old"
ticks silent 5 11
# row 8: the line is gone: one exchange, and the tick
lost gone line "the link to the servo is lost"
ticks gone 8 6

# row 36: set-points that don't change: refused, and the drive isn't enabled
drive svd48v --lock-step 0.005
tell old >/dev/null
servo_ini old svd48v.map 'q1 = 1.5747963' 'q2 = 0'
"$run" --config "$folder/old.ini" --virtual --duration 1 </dev/null >"$folder/old.out" 2>&1 && fail "started with an old set-point"
set -- $(tell state)
[ "$4 $5" = "0.000000 0.000000" ] || fail "enabled with an old set-point: $*"
drive_ends
says "$folder/old.out" "the drive doesn't show what was written to it"
[ $(wc -l <"$folder/old.out") = 1 ] || fail "not one line: $(cat "$folder/old.out")"

[ $failed = 0 ] && echo "seven rows seen at the drive"
exit $failed
