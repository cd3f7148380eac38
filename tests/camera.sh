#!/bin/sh
# A motion capture's bridge, written in Python, beside a device in true time: its positions arrive as it sent them, with their
# noise and instants, and no reading counts as old at its own 90 Hz.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit 77; }
bridge=
trap '[ -z "$bridge" ] || kill $bridge 2>/dev/null; rm -rf "$folder"' EXIT
bin=$BUILD/bin
python=${PYTHON:-python3}
port=$((20000 + $$ % 20000))
printf '[device]\ndriver = hello, camera\ncamera.listen = 127.0.0.1:%s\ncamera.patience = 20\ncamera.delay = 0\n' $port >"$folder/c.ini"
"$python" apps/examples/tracker.py $port 12 &
bridge=$!
"$bin/ethd-run" --config "$folder/c.ini" --duration 2 --record "$folder/rec" >"$folder/out" 2>"$folder/err" </dev/null ||
  fail "exit $?: $(cat "$folder/out" "$folder/err")"
kill $bridge 2>/dev/null
wait $bridge 2>/dev/null
bridge=
"$bin/ethd-replay" --verify "$folder/rec" >"$folder/said" 2>&1 || fail "verify: $(cat "$folder/said")"
"$bin/ethd-convert" "$folder/rec" "$folder/ticks.csv" >/dev/null || fail "convert"
"$python" - "$folder/ticks.csv" <<'END' || fail "what arrived isn't what was sent"
import csv, math, sys
rows = list(csv.DictReader(open(sys.argv[1])))
seen = [r for r in rows if int(r["have"]) & 8]
gaps = [1e9 * (float(b["t_ring_s"]) - float(a["t_ring_s"])) for a, b in zip(seen, seen[1:])]
late = max(1e9 * (float(r["t_s"]) - float(r["t_ring_s"])) for r in seen)
print(f"{len(seen)} readings in {len(rows)} ticks, mean spacing {sum(gaps) / len(gaps) / 1e6:.2f} ms, at most {late / 1e6:.2f} ms late")
assert len(seen) > 60, "hardly any"
assert all(int(r["have"]) & 1024 for r in seen), "not the world's"
assert all(abs(float(r["finger_noise_m"]) - 2e-4) < 1e-18 for r in seen), "another noise"
assert abs(sum(gaps) / len(gaps) / 1e6 - 1000 / 90) < 2, "another rate"
for r in seen:
    x, y = float(r["centre_x_m"]), float(r["centre_y_m"])
    assert abs(math.hypot(x - 0.25, y - 0.25) - 1e-3) < 1e-12, (x, y)
END
# row 16 is the controller's own, by its counter; readings that the machine held back for 30 ms are its business
if grep -q "the finger wasn't seen" "$folder/out"; then
  "$python" - "$folder/ticks.csv" <<'END' && fail "row 16 at 90 Hz: $(cat "$folder/out")"
import csv, sys
times = [1e9 * float(r["t_s"]) for r in csv.DictReader(open(sys.argv[1])) if int(r["have"]) & 8]
sys.exit(max(b - a for a, b in zip(times, times[1:])) > 30_000_000)
END
fi
[ $failed = 0 ] || { cat "$folder/out"; exit 1; }
echo "positions of a camera arrive as they were sent"
