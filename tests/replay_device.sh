#!/bin/sh
# A recorded session as a device: ethd-run runs it anew without what it was recorded with, to the bit.
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
run=$BUILD/bin/ethd-run
fail() { echo "$*"; exit 1; }

cp apps/config/p.plant apps/config/wall.scene "$work"
config() { # name, lines of [device]
  { printf '[transition]\nlaw = offset\n[scene]\nfile = wall.scene\n[device]\n'; printf '%b\n' "$2"; } >"$work/$1.ini"
}
config sim 'driver = sim\nplant = p\ntap = 7'
config replay 'driver = replay\nfolder = session'
config other 'driver = replay\nfolder = session\n[contact]\nk_e = 1900'

"$run" --virtual --duration 2 --config "$work/sim.ini" --record "$work/session" </dev/null >"$work/out" 2>&1 ||
  fail "recording: $(cat "$work/out")"
"$run" --virtual --duration 2 --config "$work/replay.ini" --record "$work/again" </dev/null >"$work/out" 2>&1 ||
  fail "replaying: $(cat "$work/out")"
cmp "$work/session/tick.npy" "$work/again/tick.npy" || fail "the replayed session differs from the recorded one"

# another wall gives other torques, and the program says so
"$run" --virtual --duration 2 --config "$work/other.ini" </dev/null >"$work/out" 2>&1
status=$?
[ $status = 1 ] || fail "other gains: exit $status"
grep -q 'a replay that differs from its recording' "$work/out" || fail "other gains: $(cat "$work/out")"

# with the commands of the recorded session given again, all is compared to the end, beyond a fault and a new start
printf '1.2 fault9 set\n' >"$work/broken.inject"
config faulty 'driver = sim\nplant = p\ntap = 7\ninject = broken.inject'
printf '[limits]\nclean_time = 0.1\n' >>"$work/faulty.ini"
config commanded 'driver = replay\nfolder = faulty'
printf '[limits]\nclean_time = 0.1\n' >>"$work/commanded.ini"
script='wait 0.7\ntransition smooth\nwait 0.8\nack\nwait 0.01\nenable\nwait 0.4\nset contact.k_e 1900\nwait 5\n'
rows() { sed -n "s/^.*$2  *\([0-9][0-9]*\) *$/\1/p" "$1"; }
printf "$script" | "$run" --virtual --duration 3 --config "$work/faulty.ini" --record "$work/faulty" >"$work/out" 2>&1 ||
  fail "commanded: $(cat "$work/out")"
grep -q '^ok: enabled' "$work/out" || fail "it isn't enabled again: $(cat "$work/out")"
printf "$script" | "$run" --virtual --duration 3 --config "$work/commanded.ini" --record "$work/again" --force >"$work/out" 2>&1 ||
  fail "replaying with commands: $(cat "$work/out")"
cmp "$work/faulty/tick.npy" "$work/again/tick.npy" || fail "the session that was commanded again differs"
[ "$(rows "$work/out" 'compared commands')" = "$(rows "$work/out" 'recorded ticks')" ] || fail "not all is compared: $(cat "$work/out")"
grep -q '^device: tick 70[0-9] of the recording had the command transition smooth; ' "$work/out" || fail "no remark: $(cat "$work/out")"
# without them it differs from there on
"$run" --virtual --duration 3 --config "$work/commanded.ini" </dev/null >"$work/out" 2>&1
status=$?
[ $status = 1 ] || fail "without its commands: exit $status"
[ "$(rows "$work/out" 'first difference at tick')" -ge 700 ] || fail "without its commands: $(cat "$work/out")"

# refusals
rm "$work/session/tick.npy"
"$run" --virtual --duration 2 --config "$work/replay.ini" </dev/null >"$work/out" 2>&1
status=$?
[ $status = 2 ] || [ $status = 1 ] || fail "no recording: exit $status"
grep -q 'tick.npy' "$work/out" || fail "no recording: $(cat "$work/out")"
config key 'driver = replay\nfolder = session\ncolour = red'
"$run" --virtual --duration 2 --config "$work/key.ini" </dev/null >"$work/out" 2>&1
grep -q ':8: device.colour: ' "$work/out" || fail "an unknown key: $(cat "$work/out")"
config none 'driver = replay'
"$run" --virtual --duration 2 --config "$work/none.ini" </dev/null >"$work/out" 2>&1
grep -q 'device.folder: ' "$work/out" || fail "no folder: $(cat "$work/out")"
echo "replayed to the bit"
