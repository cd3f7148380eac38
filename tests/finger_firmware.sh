#!/bin/sh
# Light barriers and the nail's plate speak the proximity ring's frames (drivers/finger/README.md), so its real firmware in
# four simulated boards (simavr) stands for theirs: each of its sensors' counts is a barrier's, or the plate's. The finger's
# positions are asserted, worked out here from the counts; their times aren't, since they depend on the machine.
set -u
. tests/peers/desk.sh
. tests/peers/board.sh
needs_board
first_rank
board
counts() { # 16 of them, to the boards
  "$python3" - $udp "$@" <<'END2'
import socket, sys
socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(" ".join(sys.argv[2:]).encode(), ("127.0.0.1", int(sys.argv[1])))
END2
}
ini() { # NAME LINES...
  name=$1
  shift
  printf '[device]\ndriver = hello, %s\n%s.port = ring\n%s.patience = 30\n' "$name" "$name" "$name" >"$folder/$name.ini"
  printf '%s\n' "$@" >>"$folder/$name.ini"
}
record() { # NAME RECORDING: a second of it, the finger where it is
  $alone "$run" --config "$folder/$1.ini" --duration 1 --record "$folder/$2" </dev/null >"$folder/$2.out" 2>&1 6>&- ||
    fail "$2: exit $?: $(cat "$folder/$2.out")"
}

# ---- twelve barriers, three of them lit: 1, 2 and 3, then 11, 0 ----
ini zones 'zones.zones = 12' 'zones.level = 30000'
counts 900 40000 40000 40000 900 900 900 900 900 900 900 900 7 7 7 7
sleep 0.1
record zones three
counts 40000 900 900 900 900 900 900 900 900 900 900 40000 7 7 7 7
sleep 0.1
record zones two

# ---- the plate: sensor 5 counts 200 + 0.5 / (d + 2.5 mm)^2, at rest 5 mm away, along 30 degrees ----
{
  printf '[calibration]\nlevel = common\n[law]\na = 0.5\np = 2\nd0 = 0.0025\n'
  for k in $(seq 0 15); do printf '[sensor %d]\ndark = 200\n' "$k"; done
} >"$folder/nail.cal"
ini nail 'nail.calibration = nail.cal' 'nail.sensor = 5' 'nail.angle = 0.5235987755982988' 'nail.rest = 0.005'
far=$(awk 'BEGIN { printf "%.0f", 200 + 0.5 / (0.0062 + 0.0025) ^ 2 }')
counts 900 900 900 900 900 "$far" 900 900 900 900 900 900 900 900 900 900
sleep 0.1
record nail plate

"$python3" - "$folder" <<'END2' || fail "the finger isn't where its counts are"
import sys
import numpy as np

RING, FINGER, REACH, ZONES = 0.012, 0.0075, 0.0035, 12  # m; the defaults


def places(name):
    """The finger's centre in the ring's frame at every reading."""
    r = np.load(f"{sys.argv[1]}/{name}/tick.npy")
    found = r["centre"][(r["have"] & 8) != 0]
    assert len(found) > 50, (name, len(found))
    return found


def mean_place(lit):
    """The mean of all centres that light just these barriers, by drawing centres."""
    xy = np.random.default_rng(1).uniform(-1, 1, (400000, 2)) * (RING - FINGER)
    xy = xy[np.hypot(*xy.T) <= RING - FINGER]
    on = []
    for k in range(ZONES):
        u = np.array([np.cos(2 * np.pi * k / ZONES), np.sin(2 * np.pi * k / ZONES)])
        across = xy @ np.array([-u[1], u[0]])
        on.append(RING - xy @ u - np.sqrt(FINGER**2 - across**2) <= REACH)
    just = np.all(np.array(on).T == [k in lit for k in range(ZONES)], axis=1)
    return xy[just].mean(axis=0)


for name, lit in (("three", {1, 2, 3}), ("two", {11, 0})):
    found, wanted = places(name), mean_place(lit)
    print(name, "barriers:", 1e3 * found[-1], "mm, by drawing", 1e3 * wanted)
    assert np.all(np.abs(found - wanted) < 0.03e-3), (name, found[-1], wanted)
found = places("plate")
wanted = (0.005 - 0.0062) * np.array([np.cos(np.pi / 6), 0.5])
print("plate:", 1e3 * found[-1], "mm, by the law", 1e3 * wanted)
assert np.all(np.abs(found - wanted) < 2e-6), (found[-1], wanted)
END2
[ $failed = 0 ] || cat "$folder"/*.out
exit $failed
