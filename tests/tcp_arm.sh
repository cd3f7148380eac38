#!/bin/sh
# The example tcp_arm.c, a driver of an arm that takes velocities over TCP, in the example arm.c, before a simulated controller
# and a headset (peers/arm_peer.py): the plate stands at the wall when the finger comes; states that are late, lost, doubled
# or damaged change nothing; a protective stop and a broken line disarm the device.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit 77; }
strict="-std=gnu11 -O2 -Wall -Wextra -Werror -Iinclude"
$CC $strict -shared -fPIC apps/examples/tcp_arm.c -o "$folder/tcp_arm.so" &&
  $CC $strict apps/examples/arm.c -o "$folder/arm" -L"$BUILD" -lethd-drivers -lethd -lm || { fail "the examples don't compile"; exit 1; }
export LD_LIBRARY_PATH="$BUILD"
port=$((20000 + $$ % 20000))
cat >"$folder/arm.ini" <<END
[space]
period = 0.002
effector = plate
radius = 0.068
finger_radius = 0.008
finger_radius_max = 0.010
speed = 1
acceleration = 8
[device]
driver = file:tcp_arm.so, camera
tcp_arm.at = 127.0.0.1:$port
camera.listen = 127.0.0.1:$port
camera.delay = 0.001
camera.patience = 20
[scene]
file = wall.solids
END
echo 'halfspace 1 0 0 0.3' >"$folder/wall.solids"

# kept SENTENCE MOST: how the trial ended, and how far the tool came
kept() {
  tail -n 1 "$folder/said" | grep -q "$1" && "$PYTHON" - "$folder/peer" $2 <<'END'
import json, sys
tool = json.loads(open(sys.argv[1]).read().splitlines()[-1])
sys.exit(not (tool["most"] < float(sys.argv[2]) and tool["hit"] < 0.1 and tool["off"] < 1e-9 and tool["stopped"] < 3.3))
END
}
# trial FAULT SENTENCE MOST: once more where the machine held the peer or the loop up
trial() {
  for attempt in 1 2 3 4; do
    : >"$folder/peer"
    "$PYTHON" tests/peers/arm_peer.py $port $port $1 4 >"$folder/peer" 2>&1 &
    peer=$!
    for wait in $(seq 100); do grep -q ready "$folder/peer" && break || sleep 0.2; done
    "$folder/arm" "$folder/arm.ini" 3 >"$folder/said" 2>&1 || fail "$1: $(cat "$folder/said")"
    wait $peer || fail "$1: $(cat "$folder/peer")"
    kept "$2" $3 && { echo "$1: $(tail -n 1 "$folder/peer")"; return; }
    late=$(sed -n 's/.*"late": \([^,]*\),.*/\1/p' "$folder/peer")
    grep -qE "ticks are late|thread doesn't run|feedback is too old|finger wasn't seen" "$folder/said" ||
      awk "BEGIN { exit !(${late:-0} > 0.002) }" || { fail "$1: $(tail -n 3 "$folder/said" "$folder/peer")"; return; }
  done
  echo "SKIP: the machine is too busy for a loop at 500 Hz"
  exit 77
}
trial none 'armed, no fault' 0.304
trial late 'armed, no fault' 0.304
trial lost 'armed, no fault' 0.304
trial doubled 'armed, no fault' 0.304
trial damaged 'armed, no fault' 0.304
trial protective 'disarmed, the drive reports a fault' 0.1
trial disconnect 'disarmed, the link to the servo is lost' 0.1

# ethd-run drives it, too; the recording knows the camera's limit of a reading's age, and replays
: >"$folder/peer"
"$PYTHON" tests/peers/arm_peer.py $port $port none 4 >"$folder/peer" 2>&1 &
peer=$!
for wait in $(seq 100); do grep -q ready "$folder/peer" && break || sleep 0.2; done
"$BUILD/bin/ethd-run" --config "$folder/arm.ini" --duration 1.5 --record "$folder/run" </dev/null >"$folder/said" 2>&1 || fail "ethd-run: $(cat "$folder/said")"
wait $peer
says "$folder/run/events.csv" '^0,set,space.finger_lost [0-9.]*$'
"$BUILD/bin/ethd-replay" --verify "$folder/run" >"$folder/said" 2>&1 || fail "the recording: $(cat "$folder/said")"

# a place where nobody answers
sed 's/tcp_arm.at = .*/tcp_arm.at = 127.0.0.1:1/' "$folder/arm.ini" >"$folder/none.ini"
"$folder/arm" "$folder/none.ini" 1 >"$folder/said" 2>&1 && fail "it opens without an arm"
says "$folder/said" 'at = 127.0.0.1:1: no arm answers there'
exit $failed
