"""Metrics of recorded taps from tick.npy and truth.npy, against taps.csv: a second derivation.

usage: record_metrics.py FOLDER PLANT     PLANT n or p
"""
import csv
import os
import sys

import numpy as np

folder, plant = sys.argv[1:]
PERIOD = 1e-3
SIDE = {"n": "ring_v", "p": "motor_v"}[plant]
BANDS = {"n": {"low": (0.2, 0.06), "high": (0.4, 0.08)}, "p": {"low": (0.2, 0.0339), "high": (0.4, 0.0577)}}[plant]
D_BETA = {"n": 12e-3 - 10.546e-3, "p": 12e-3 - 9.782e-3}[plant]
WALL, RING = 0.238, 0.012

tick = np.load(os.path.join(folder, "tick.npy"))
truth = np.load(os.path.join(folder, "truth.npy"))
assert len(tick) == len(truth) and len(tick) > 0
with open(os.path.join(folder, "taps.csv"), newline="") as file:
    taps = list(csv.DictReader(file))
with open(os.path.join(folder, "events.csv"), newline="") as file:
    starts = [e for e in csv.DictReader(file) if e["kind"] == "start"]
assert len(starts) == len(taps), (len(starts), len(taps))
begins = [int(e["row"]) for e in starts] + [len(tick)]


def first(flags, start=0):
    hits = np.flatnonzero(flags[start:])
    return start + int(hits[0]) if len(hits) else None


def rebound(depth):
    """First maximum minus the next minimum; an extremum counts once 0.1 mm is turned back."""
    below = first(depth < np.maximum.accumulate(depth) - 1e-4)
    if below is None:
        return 0.0
    peak = depth[: below + 1].max()
    rest = depth[below:]
    above = first(rest > np.minimum.accumulate(rest) + 1e-4)
    return peak - rest[: above if above is None else above + 1].min()


def begin_of(k, t):
    """Tick at which the tap begins: 0 unless the ring starts in the wall."""
    if not k["d_re"][0] < 0:
        return 0
    clear = (np.isnan(k["d_re"]) | (k["d_re"] > D_BETA)) & (t["hand"][:, 0] > WALL + RING + D_BETA)
    return first(clear)


def measure(k, t, speed, never_fast):
    v, depth, ring = -t[SIDE][:, 0], -t[SIDE[:-2]][:, 0], -t["ring"][:, 0]
    out = dict.fromkeys(("v_rvo_mps", "v_of_mps", "d_max_m", "v_rmin_mps", "delta_s_ms", "eps_m", "t_rvo_s", "t_of_s", "v_of_tick_mps", "d_max_ring_m"))
    out["peak_force_n"] = np.sqrt((k["fe"] ** 2).sum(axis=1)).max()
    begin = begin_of(k, t)
    met = None if begin is None else first(k["d_re"] < 0, begin)
    touch = None
    if met is not None:
        out["t_rvo_s"], out["v_rvo_mps"], out["d_max_m"] = t["t"][met], v[met], rebound(depth[met:])
        out["d_max_ring_m"] = rebound(ring[met:])
        braking = first(k["state"] == 1, met)
        vo = None if braking is None else first(k["state"] == 2, braking)
        if vo is not None:
            out["delta_s_ms"] = None if met and k["state"][met - 1] == 1 else (vo - braking) * 1e3 * PERIOD
            out["eps_m"] = k["eps"][vo]
        touch = first(t["pad"] > 0, met)
    if touch is not None:
        out["t_of_s"], out["v_of_tick_mps"], out["v_rmin_mps"] = t["t"][touch], v[touch], v[touch + 1 : touch + 101].min()
        around = slice(touch - 1, touch + 1)
        out["v_of_mps"] = np.interp(0, t["pad"][around], v[around]) if t["pad"][touch - 1] <= 0 else v[touch]
    out["reason"] = reason(k, t, begin, met, touch, v, speed, never_fast)
    out["valid"] = "1" if out["reason"] == "ok" else "0"
    # the tap ends 0.15 s after t_r/vo
    if met is not None:
        assert len(k) == met + 151, (len(k), met)
    return out


def reason(k, t, begin, met, touch, v, speed, never_fast):
    centre, band = BANDS[speed] if speed in BANDS else (float(speed), 0.04 + 0.1 * float(speed))
    if k["fault"].any():
        return "fault"
    if never_fast:
        return "too-slow"
    if met is None:
        return "no-contact"
    if (t["pad"][begin:met] > 0).any():
        return "early-contact"
    if v[met] < centre - band:
        return "too-slow"
    if v[met] > centre + band:
        return "too-fast"
    return "no-contact" if touch is None else "ok"


numbers = 0
for i, row in enumerate(taps):
    words = starts[i]["detail"].split(" ", 4)
    assert words[:4] == ["tap", row["tap"], row["transition"], row["speed"]], (words, row)
    span = slice(begins[i], begins[i + 1])
    expected = measure(tick[span], truth[span], row["speed"], "never that fast" in starts[i]["detail"])
    for name, value in expected.items():
        written = row[name]
        where = f"row {i + 2}: {name}: written {written!r}, recomputed {value!r}"
        if value is None:
            assert written == "", where
        elif isinstance(value, str):
            assert written == value, where
        else:
            assert abs(float(written) - value) <= 1e-12 * max(1, abs(value)), where
            numbers += 1
print(f"{len(taps)} taps, {len(tick)} ticks: {numbers} figures recomputed")
