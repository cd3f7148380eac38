"""simulator.py PLANT RECORDING: the simulated device's taps, integrated again by SciPy under the recorded torques.

The equations are those of include/ethd/sim.h for two joints without coupling, written from its text; DOP853 in place of
the simulator's power series.
"""
import configparser
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import make_interp_spline

L, PERIOD, RING = 0.25, 1e-3, 12e-3  # m, s, m: the default arm, loop and ring
file = configparser.ConfigParser(inline_comment_prefixes=";")
file.read(sys.argv[1])
d, t, f = ({k: float(v) for k, v in file[s].items() if v[0] in "-.0123456789i"} for s in ("device", "transmission", "finger"))
mass = np.array([d["mass_x"], d["mass_y"]]) - t["motor_mass"]
assert d["coupling"] == 0 and np.isfinite(t["stiffness"])


def vectors(angle):
    """x and y of both links."""
    return L * np.array([np.cos(angle), np.sin(angle)])


def change(time, s, torque, path, gap):
    """The state's slope: angles, motors' angles, finger; then their speeds."""
    (angle, motor, finger), (w, motor_w, v) = s[:6].reshape(3, 2), s[6:].reshape(3, 2)
    x, y = vectors(angle)
    away = finger - (x.sum(), y.sum())
    away_v = v - (-(y * w).sum(), (x * w).sum())
    distance = np.hypot(*away)
    p, p_dot = distance - gap, away @ away_v / distance
    force = max(0.0, f["pad_stiffness"] * p * (1 + f["pad_damping"] * p_dot)) * away / distance if p > 0 else np.zeros(2)
    drive = L**2 * (t["stiffness"] * (motor - angle) + t["damping"] * (motor_w - w))
    friction = L * (d["friction"] * np.tanh(L * motor_w / 3e-3) + d["viscous"] * L * motor_w)
    slope = np.empty(12)
    slope[:6] = s[6:]
    slope[6:8] = (drive + x * force[1] - y * force[0]) / (mass * L**2)
    slope[8:10] = (torque - friction - drive) / (t["motor_mass"] * L**2)
    hand = path(time) - finger
    slope[10:] = path(time, 2) + (f["hand_stiffness"] * hand + f["hand_damping"] * (path(time, 1) - v) - force) / f["mass"]
    return slope


tick, truth = np.load(sys.argv[2] + "/tick.npy"), np.load(sys.argv[2] + "/truth.npy")
begins = np.append(np.flatnonzero(truth["t"] == 0), len(truth))
worst = {}
for a, b in zip(begins, begins[1:]):
    rows, torque = truth[a:b], np.clip(tick["tau"][a:b], -d["force_limit"] * L, d["force_limit"] * L)
    path = make_interp_spline(rows["t"], rows["hand"], k=7)  # the finger moves on it, and swings about it when pushed
    gap = np.hypot(*(rows["finger"][0] - rows["ring"][0])) - rows["pad"][0]
    x, y = rows["ring"][0]  # the first link stands to the left of the second, as in the paper's figure 8
    half = np.arccos(np.hypot(x, y) / (2 * L))
    angle = np.arctan2(y, x) + (half, -half)
    s = np.concatenate((angle, angle, rows["finger"][0], np.zeros(6)))
    held = np.zeros(2)
    for k in range(len(rows)):
        at = {"ring": vectors(s[:2]).sum(axis=1), "motor": vectors(s[2:4]).sum(axis=1), "finger": s[4:6]}
        for name, where in at.items():
            worst[name] = max(worst.get(name, 0), np.abs(where - rows[name][k]).max())
        for begin, end, held in ((0, d["delay"], held), (d["delay"], PERIOD, torque[k])):
            s = solve_ivp(change, (rows["t"][k] + begin, rows["t"][k] + end), s, "DOP853", rtol=1e-11, atol=1e-13,
                          args=(held, path, gap)).y[:, -1]
    assert max(worst.values()) < 1e-8, worst  # include/ethd/sim.h, ETHD_SIM_GOLDEN
print(len(begins) - 1, "taps;", ", ".join(f"{name} {w:.2g} m" for name, w in worst.items()), "away at most")
