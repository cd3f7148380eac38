#!/bin/sh
# NumPy opens a recording in one call, and reads the numbers that were written.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
[ -n "${PYTHON:-}" ] || { echo 'python3 with numpy is missing'; exit 77; }
"$BUILD/bin/ethd-tap" --taps 2 --transition offset --speed high --record "$folder/rec" --csv "$folder/taps.csv" >/dev/null
"$PYTHON" - "$folder/rec" <<'END'
import csv, sys
import numpy

folder = sys.argv[1]
ticks = numpy.load(folder + "/tick.npy")
assert ticks.ndim == 1 and len(ticks) > 100, ticks.shape
assert ticks.dtype.names[0] == "time_ns" and ticks.dtype.names[-1] == "learnt", ticks.dtype.names
assert ticks["rays"].shape == (len(ticks), 16) and ticks["q"].shape == (len(ticks), 2)
assert ticks.dtype["time_ns"] == "<i8" and ticks.dtype["beta"] == "<f8"
starts = [int(row["row"]) for row in csv.DictReader(open(folder + "/events.csv")) if row["kind"] == "start"]
assert len(starts) == 2 and starts[0] == 0, starts
for first, end in zip(starts, starts[1:] + [len(ticks)]):
    tap = ticks[first:end]
    assert (numpy.diff(tap["time_ns"]) == 1000000).all()
    assert (numpy.diff(tap["tick"]) == 1).all()
    q = tap["q"]  # parallel arm, 0.25 m links: the ring is where the angles say
    x = 0.25 * (numpy.cos(q[:, 0]) + numpy.cos(q[:, 1]))
    y = 0.25 * (numpy.sin(q[:, 0]) + numpy.sin(q[:, 1]))
    assert abs(x - tap["x"][:, 0]).max() < 1e-12 and abs(y - tap["x"][:, 1]).max() < 1e-12
    assert set(tap["state"]) <= {0, 1, 2} and 1 in tap["state"]
    assert ((tap["beta"] >= 0.1) & (tap["beta"] <= 1)).all()
END
