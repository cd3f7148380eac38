#!/bin/sh
# ethd-run and ethd-conform on an arm in space: commands, stops, recordings that replay, telemetry. No time is asserted.
. tests/begin.sh
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
run=$BUILD/bin/ethd-run arm=apps/config/ur5e.ini
replays() { "$BUILD/bin/ethd-replay" --verify "$1" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || fail "$1: $(cat "$folder/verify")"; }

# ---- virtual: equal bytes twice; a stop by a lower speed limit, acknowledged, enabled, with what the law has learnt ----
script='status\nwait 0.3\ntransition predictive\nset contact.k_e 2000\nset space.period 0.01\nset limits.speed 1\nwait 1.2\nset space.speed 0.01\nwait 0.3\nenable\nstatus\nset space.speed 1\nack\nwait 0.1\nenable\nwait 0.9\ntransition approach\nwait 0.4\nstatus\nstop\n'
for k in 1 2; do
  printf "$script" | "$run" --virtual --duration 100 --config $arm --record "$folder/v$k" >"$folder/v$k.out" 2>"$folder/v$k.err" ||
    fail "virtual run $k: exit $?: $(cat "$folder/v$k.err")"
  replays "$folder/v$k"
done
sed "s|$folder/v2|$folder/v1|g" "$folder/v2.out" | cmp - "$folder/v1.out" || fail "two virtual runs answer differently"
diff -r "$folder/v1" "$folder/v2" || fail "two virtual runs leave different recordings"
says "$folder/v1.out" '^ok: t 0.002 s, enabled, approach, transparent, beta 1.000, effector -0.5870 -0.1333 0.2509 m, velocity .* m/s, ' \
  '^ok: set contact.k_e 2000$' '^error: period: ' '^error: .*limits' '^error: a fault is latched: the ring is faster' \
  '^ok: acknowledged; the device is disabled' '^ok: enabled$' '^faults  *1 x the ring is faster than its limit$' \
  '^snapshot  .*v1/snapshot.npy: [0-9]* ticks around the first fault'
grep -q "isn't a finite number" "$folder/v1.out" "$folder/v1.err" && fail "a stop that isn't finite: $(cat "$folder/v1.out")"
says "$folder/v1/events.csv" ',transition,predictive$' ',clear,' ',start,enabled$' ',set,space.speed 0$'

# the snapshot's rows are the recording's; a command changes by at most the acceleration, and the plate's speed ends at zero
"${PYTHON:-python3}" - "$folder/v1" <<'END' || fail "the recording"
import sys
import numpy as np
ticks, snapshot = np.load(sys.argv[1] + "/tick.npy"), np.load(sys.argv[1] + "/snapshot.npy")
first = np.flatnonzero(ticks["fault"])[0]
assert snapshot.dtype == ticks.dtype and (np.isin(snapshot["tick"], ticks["tick"])).all() and (snapshot["fault"] == 24).any()
known = ticks[(ticks["have"] & 128) != 0]  # what the device says that it was commanded
change = np.linalg.norm(known["command"] - known["commanded"], axis=1)
assert change.max() <= 12 * 0.002 * (1 + 1e-9), change.max()
assert np.linalg.norm(ticks["command"][first - 1]) > 0.01 and (ticks["command"][-1] == 0).all()
END

# ---- a ball, to which the plate has to turn late: the joints' limits leave its point on its way, and it stays at the ball ----
sed '/^\[scene\]/,$d' $arm >"$folder/ball.ini"
printf 'arm.hand_beyond = 0.02\narm.hand_seed = SEED\n[scene]\nfile = ball.solids\n[transition]\nrange = 0.1\n' >>"$folder/ball.ini"
cp apps/config/ur5e.arm "$folder"
echo 'sphere -0.35662 -0.1333 0.18366 0.12' >"$folder/ball.solids"
for seed in 3 5 14; do
  sed "s/SEED/$seed/" "$folder/ball.ini" >"$folder/ball$seed.ini"
  "$run" --virtual --duration 4.5 --config "$folder/ball$seed.ini" --record "$folder/ball$seed" </dev/null >"$folder/out" 2>&1 || fail "a ball: $(cat "$folder/out")"
  "${PYTHON:-python3}" - "$folder/ball$seed" <<'END' || fail "the plate leaves its way at a ball, seed $seed"
import sys
import numpy as np
t = np.load(sys.argv[1] + "/tick.npy")
n = np.array([-0.35662, -0.1333, 0.18366]) - t["x"]
n /= np.linalg.norm(n, axis=1)[:, None]
speed = np.sum(np.gradient(t["x"], 0.002, axis=0) * n, axis=1)[t["state"] == 2]
off = np.abs(t["commanded"][6:] - t["command"][5:-1]).max()
print(f"slowest at the ball {speed.min():.3f} m/s, commands changed by {off:.3f} m/s")
assert len(speed) > 100 and speed.min() > -0.03 and off < 0.03
END
done

# ---- real: commands on stdin, telemetry ----
cat >"$folder/udp.py" <<'END'
import json, socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
s.settimeout(30)
open(sys.argv[1], "w").write(str(s.getsockname()[1]))
k = [json.loads(s.recv(4096)) for _ in range(20)]
assert all(b["timestamp"] > a["timestamp"] for a, b in zip(k, k[1:])), k
assert all(len(k[0][name]) == 3 for name in ("x", "v", "xf", "command", "fe")) and "q" not in k[0], k[0]
END
"${PYTHON:-python3}" "$folder/udp.py" "$folder/port" &
listener=$!
while ! [ -s "$folder/port" ] && kill -0 $listener; do sleep 0.05; done
printf 'wait 0.4\ntransition predictive\nstatus\n' | "$run" --config $arm --duration 1 --record "$folder/real" \
  --telemetry "127.0.0.1:$(cat "$folder/port")" >"$folder/real.out" 2>"$folder/real.err" || fail "real run: exit $?: $(cat "$folder/real.err")"
wait $listener || fail "telemetry isn't what it should be"
replays "$folder/real"
says "$folder/real.out" '^ok: transition predictive$' '^ok: t .*, predictive, ' '^wake-up .*p50.*p99 .*p99.9.*max'

# ---- an arm that nobody's finger leads; programs of the plane; the driver's contract ----
sed 's/reach  .*/none/; s/^file = .*//; s/^arm.hand_.*//' $arm >"$folder/blind.ini"
cp apps/config/ur5e.arm "$folder"
"$run" --config "$folder/blind.ini" --duration 0.3 </dev/null >"$folder/blind" 2>&1 || fail "no finger: $(cat "$folder/blind")"
says "$folder/blind" '^device: no sensor measures the finger, so the effector stands still' '^scene  *none' '^finger  *never measured'
"$BUILD/bin/ethd-tap" --config $arm >"$folder/out" 2>&1 && fail "ethd-tap takes [space]"
says "$folder/out" 'ur5e.ini: \[space\] is for a device in space, and this program works in the plane'
"$BUILD/bin/ethd-conform" --config $arm --virtual --move >"$folder/conform" 2>&1 || fail "conform: $(cat "$folder/conform")"
[ "$(grep -c ' kept ' "$folder/conform")" = 8 ] || fail "conform: $(cat "$folder/conform")"
exit $failed
