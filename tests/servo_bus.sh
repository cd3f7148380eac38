#!/bin/sh
# The servo over a bus, by an independent server (pymodbus) with the simulated plant behind its registers: taps in
# lock-step, equal to the bit; a live run that is unplugged and killed; a serial line at 500 kBd. No time is asserted: a
# machine too busy for a drive in true time is told from a fault of ours by a program that knows nothing of it.
set -u
. tests/peers/desk.sh
verify="$BUILD/bin/ethd-replay --verify"
. tests/peers/plant.sh

cp apps/config/wall.scene "$folder"
configure() { # NAME PORT
  { sed '/^\[device\]/,$d' apps/config/n.ini; printf '[limits]\nstop_time = 0.4\n[device]\ndriver = servo\nmap = plant.map\nport = %s\n' "$2"; } >"$folder/$1.ini"
}
# A busy machine answers late, which is no fault in lock-step.
sed -e 's/^response = .*/response = 5/' -e 's/^drain = .*/drain = 0.1/' apps/config/plant.map >"$folder/plant.map"

# ---- lock-step: all three strategies tap through the bus, twice the same ----
script='status\nwait 3.2\ntransition smooth\nwait 3.2\ntransition abrupt\nwait 3.2\nstatus\nstop\n'
for k in 1 2; do
  plant lock --lock-step 1
  peer --tcp 0
  configure lock "127.0.0.1:$at"
  printf "$script" | "$run" --virtual --duration 100 --config "$folder/lock.ini" --record "$folder/v$k" >"$folder/v$k.out" 2>"$folder/v$k.err" ||
    fail "in lock-step: exit $?: $(cat "$folder/v$k.err")"
  kill $peer
  plant_ends
  $verify "$folder/v$k" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || fail "v$k: $(cat "$folder/verify")"
done
cmp "$folder/v1/tick.npy" "$folder/v2/tick.npy" || fail "two runs in lock-step differ"
says "$folder/v1.out" '^ok: t .* enabled, abrupt, .* no fault$' 'servo answers missing  *0 ' 'servo answers stale  *0 ' 'virtual'
"$python3" - "$folder/v1/tick.npy" <<'END2' || fail "the taps aren't what they should be"
import sys
import numpy as np
r = np.load(sys.argv[1])
inside = r["state"] == 2
begins = np.flatnonzero(inside[1:] & ~inside[:-1]) + 1
third = len(r) // 3
ring, finger, wall = r["x"][:, 0], r["xf"][:, 0], 0.25
print(len(begins), "contacts; the ring went", 1e3 * (wall - ring.min()), "mm into the wall, the finger", 1e3 * (wall - finger.min()), "mm")
assert all(np.any((begins >= k * third) & (begins < (k + 1) * third)) for k in range(3)), begins
assert 0 < wall - ring.min() < 0.008 and finger.min() < wall - 0.001
assert np.all(r["faults"] == 0) and np.abs(r["tau"]).max() > 0.2
END2

# ---- a drive whose watchdog is patient enough for a busy machine; if no priority is granted, the shortfall of the device's
# I/O is printed, or ends the run if that is asked for ----
plant patient --finger 0 --watchdog 0.5
peer --tcp 0
sed 's/^response = .*/response = 2/' apps/config/plant.map >"$folder/plant.map"
configure patient "127.0.0.1:$at"
"$BUILD/bin/ethd-conform" --probe "$folder/plant.map" --port "127.0.0.1:$at" --duration 0.2 --try-watchdog >"$folder/tried" 2>&1 ||
  fail "watchdog: exit $?: $(cat "$folder/tried")"
says "$folder/tried" '^watchdog .*it is disabled after 1 s of silence: it has one; the map says it has one'
ordinary="prlimit --rtprio=0"
[ "$(id -u)" != 0 ] || ordinary="setpriv --bounding-set=-sys_nice $ordinary"
$ordinary "$run" --config "$folder/patient.ini" --duration 0.3 </dev/null >"$folder/ordinary" 2>&1 8>&- ||
  fail "without a priority: exit $?: $(cat "$folder/ordinary")"
says "$folder/ordinary" "^not realtime: no real-time priority for the device's I/O: two busy programs are enough to make its feedback too old" \
  '^not realtime: no real-time priority: the loop waits'
$ordinary "$run" --config "$folder/patient.ini" --require-rt --duration 0.3 </dev/null >"$folder/ordinary" 2>&1 8>&-
[ $? = 1 ] && [ "$(wc -l <"$folder/ordinary")" = 1 ] || fail "--require-rt without a priority: $(cat "$folder/ordinary")"
says "$folder/ordinary" '--require-rt: .*; mend: '
kill $peer
plant_ends

# ---- live ----
first_rank
cp apps/config/plant.map "$folder"
plant live
peer --tcp 0
port=$at
configure live "127.0.0.1:$port"
$alone "$BUILD/bin/ethd-conform" --probe "$folder/plant.map" --port "127.0.0.1:$port" --duration 0.5 >"$folder/probe" 2>&1 ||
  fail "probe: exit $?: $(cat "$folder/probe")"
says "$folder/probe" '^round trip p50 .* p99 .* max .* ms' 'this bus can do [1-9][0-9]* Hz' ' position1  *raw' ' bus_voltage  *raw 480 *48 V'
mkfifo "$folder/commands"
$alone "$run" --config "$folder/live.ini" --record "$folder/live" <"$folder/commands" >"$folder/live.out" 2>"$folder/live.err" 8>&- &
live=$!
children="$children $live"
exec 9>"$folder/commands"
answers() { grep -c '^ok: t ' "$folder/live.out"; }
status() { # until it is answered
  before=$(answers)
  echo status >&9
  for _ in $(seq 600); do
    [ "$(answers)" -gt "$before" ] && return
    sleep 0.05
  done
  fail "no answer to status"
}
# Late answers on a busy machine disable the drive, as they must; then it is tried once more.
skip=
vain() { # WHY
  [ -z "$skip" ] || return
  skip=$($alone "$python3" tests/peers/late.py 'a drive' 8>&- 9>&-)
  [ $? = 77 ] || fail "$1; $skip"
}
enabled() {
  for _ in $(seq 30); do
    status
    grep '^ok: t ' "$folder/live.out" | tail -n 1 | grep -q ' enabled,' && return
    printf 'wait 1.2\nack\nenable\nwait 0.1\n' >&9
    sleep 1.5
  done
  vain "it can't be enabled: $(tail -n 5 "$folder/live.out")"
}
enabled
# unplugged ETHD_SERVO_PLUGS times: it connects again, and stays disabled
lines=$(wc -l <"$folder/live.out")
for n in $(seq "${ETHD_SERVO_PLUGS:-2}"); do
  kill $peer
  wait $peer 2>/dev/null
  echo 'wait 0.2' >&9
  status
  peer --tcp "$port"
  echo 'wait 0.2' >&9
  status
done
sed "1,${lines}d" "$folder/live.out" >"$folder/after"
[ "$(grep -c ' disabled,' "$folder/after")" = $((2 * ${ETHD_SERVO_PLUGS:-2})) ] || fail "not disabled all the time: $(cat "$folder/after")"
if grep -q ' enabled,' "$folder/after"; then fail "it enabled itself: $(cat "$folder/after")"; fi
enabled
# killed: the recording is whole, and the drive's own watchdog lets go
kill -KILL $live
wait $live 2>/dev/null
exec 9>&-
sleep 0.3
$verify "$folder/live" >"$folder/verify" 2>&1 # says that it was never closed
grep -q 'equal to the bit' "$folder/verify" || fail "killed: $(cat "$folder/verify")"
"$python3" - "$folder/live/tick.npy" <<'END2' || fail "records are missing"
import sys
import numpy as np
tick = np.load(sys.argv[1])["tick"]
gaps = np.flatnonzero((np.diff(tick) != 1) & (tick[1:] > 1))
assert len(gaps) == 0, (gaps, tick[gaps])
print(len(tick), "records of the live run, without a gap")
END2
kill $peer
"$python3" - "$plant" <<'END2' || fail "the drive pushes still, or doesn't answer"
import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.settimeout(10)
s.sendto(b"F", ("127.0.0.1", int(sys.argv[1])))
words = s.recv(256).split()
assert len(words) == 7 and float(words[5]) == 0 and float(words[6]) == 0, words
END2
plant_ends
grep -q 'the watchdog let go [1-9]' "$folder/live.plant" || vain "no watchdog: $(cat "$folder/live.plant")"

# ---- a serial line, 500 kBd ----
plant serial
mkfifo "$folder/wire.in"
"$BUILD/tests/wire" 500000 <"$folder/wire.in" >"$folder/wire.out" 8>&- &
wire=$!
children="$children $wire"
exec 7>"$folder/wire.in"
await "$folder/wire.out" '/dev/'
read -r ours theirs <"$folder/wire.out"
peer --serial "$theirs"
sed -e 's/^transport = tcp/transport = rtu\nbaud = 500000\nexchange = combined/' -e 's/^response = .*/response = 2/' apps/config/plant.map >"$folder/rtu.map"
"$BUILD/bin/ethd-conform" --probe "$folder/rtu.map" --port "$ours" --duration 1 >"$folder/rtu" 2>&1 || fail "serial: exit $?: $(cat "$folder/rtu")"
says "$folder/rtu" 'this bus can do [1-9][0-9]* Hz' ' bus_voltage  *raw 480 *48 V'
kill $peer
exec 7>&-
plant_ends

grep -h -E '^rate|^round' "$folder/probe" "$folder/rtu"
[ $failed = 0 ] || exit 1
echo "$(grep -c . "$folder/v1/events.csv") events replayed"
[ -z "$skip" ] || { echo "$skip"; exit 77; }
