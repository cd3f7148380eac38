#!/bin/sh
# A recorded session as a device: ethd-run runs it anew without what it was recorded with, to the bit.
. tests/begin.sh
run=$BUILD/bin/ethd-run

cp apps/config/p.plant apps/config/wall.scene "$folder"
config() { # name, lines of [device]
  { printf '[transition]\nlaw = offset\n[scene]\nfile = wall.scene\n[device]\n'; printf '%b\n' "$2"; } >"$folder/$1.ini"
}
config sim 'driver = sim\nplant = p\ntap = 7'
config replay 'driver = replay\nfolder = session'
config other 'driver = replay\nfolder = session\n[contact]\nk_e = 1900'

"$run" --virtual --duration 2 --config "$folder/sim.ini" --record "$folder/session" </dev/null >"$folder/out" 2>&1 ||
  fail "recording: $(cat "$folder/out")"
"$run" --virtual --duration 2 --config "$folder/replay.ini" --record "$folder/again" </dev/null >"$folder/out" 2>&1 ||
  fail "replaying: $(cat "$folder/out")"
cmp "$folder/session/tick.npy" "$folder/again/tick.npy" || fail "the replayed session differs from the recorded one"

# another wall gives other torques, and the program says so
"$run" --virtual --duration 2 --config "$folder/other.ini" </dev/null >"$folder/out" 2>&1
status=$?
[ $status = 1 ] || fail "other gains: exit $status"
grep -q 'a replay that differs from its recording' "$folder/out" || fail "other gains: $(cat "$folder/out")"

# with the commands of the recorded session given again, all is compared to the end, beyond a fault and a new start
printf '1.2 fault9 set\n' >"$folder/broken.inject"
config faulty 'driver = sim\nplant = p\ntap = 7\ninject = broken.inject'
printf '[limits]\nclean_time = 0.1\n' >>"$folder/faulty.ini"
config commanded 'driver = replay\nfolder = faulty'
printf '[limits]\nclean_time = 0.1\n' >>"$folder/commanded.ini"
script='wait 0.7\ntransition smooth\nwait 0.8\nack\nwait 0.01\nenable\nwait 0.4\nset contact.k_e 1900\nwait 5\n'
rows() { sed -n "s/^.*$2  *\([0-9][0-9]*\) *$/\1/p" "$1"; }
printf "$script" | "$run" --virtual --duration 3 --config "$folder/faulty.ini" --record "$folder/faulty" >"$folder/out" 2>&1 ||
  fail "commanded: $(cat "$folder/out")"
grep -q '^ok: enabled' "$folder/out" || fail "it isn't enabled again: $(cat "$folder/out")"
printf "$script" | "$run" --virtual --duration 3 --config "$folder/commanded.ini" --record "$folder/again" --force >"$folder/out" 2>&1 ||
  fail "replaying with commands: $(cat "$folder/out")"
cmp "$folder/faulty/tick.npy" "$folder/again/tick.npy" || fail "the session that was commanded again differs"
[ "$(rows "$folder/out" 'compared commands')" = "$(rows "$folder/out" 'recorded ticks')" ] || fail "not all is compared: $(cat "$folder/out")"
grep -q '^device: tick 70[0-9] of the recording had the command transition smooth; ' "$folder/out" || fail "no remark: $(cat "$folder/out")"
# without them it differs from there on
"$run" --virtual --duration 3 --config "$folder/commanded.ini" </dev/null >"$folder/out" 2>&1
status=$?
[ $status = 1 ] || fail "without its commands: exit $status"
[ "$(rows "$folder/out" 'first difference at tick')" -ge 700 ] || fail "without its commands: $(cat "$folder/out")"

# refusals
rm "$folder/session/tick.npy"
"$run" --virtual --duration 2 --config "$folder/replay.ini" </dev/null >"$folder/out" 2>&1
status=$?
[ $status = 2 ] || [ $status = 1 ] || fail "no recording: exit $status"
grep -q 'tick.npy' "$folder/out" || fail "no recording: $(cat "$folder/out")"
config key 'driver = replay\nfolder = session\ncolour = red'
"$run" --virtual --duration 2 --config "$folder/key.ini" </dev/null >"$folder/out" 2>&1
grep -q ':8: device.colour: ' "$folder/out" || fail "an unknown key: $(cat "$folder/out")"
config none 'driver = replay'
"$run" --virtual --duration 2 --config "$folder/none.ini" </dev/null >"$folder/out" 2>&1
grep -q 'device.folder: ' "$folder/out" || fail "no folder: $(cat "$folder/out")"
[ $failed = 0 ] && echo "replayed to the bit"
exit $failed
