"""An arm that this project's simulator has no part in: numpy integrates it, and its encoders go into a recording.

identify_arm.py make TEMPLATE OUT [LIMIT [BACKLASH [PHASE]]]: a recording like TEMPLATE, of an arm of ARM whose motors give at
    most LIMIT N at the ring (default: all that is asked), with so much play, m at the ring, between motor and link; another
    phase, rad, of the sines makes another recording.
identify_arm.py check PLANT WHAT...: the plant file's numbers are ARM's, within 1 % (delay: 0.01 ms) and within their intervals
    widened by half; limit=N: this too.
identify_arm.py judge RECORDING PLANT SAID: what --judge said of them is what numpy's prediction comes to, within 1 %.
identify_arm.py scipy RECORDING PLANT: scipy.optimize.least_squares, with numpy's prediction of the same windows, comes to the
    plant's numbers, within a fifth of their intervals' half widths."""
import math, pathlib, re, shutil, sys

import numpy as np

T, L, STICK = 1e-3, 0.25, 3e-3
ARM = {"mass_x": 0.152, "mass_y": 0.203, "friction": 0.31, "viscous": 0.9, "delay": 0.31e-3}
COUNT = 2 * math.pi / 40000
STEPS = 8 # of the integration in a period

def torques(n, phase):
    """N at the ring, tick by tick: sines that no period repeats."""
    t = np.arange(n) * T
    out = np.zeros((n, 2))
    for j in range(2):
        for k in range(18):
            f = 0.9 * 1.21 ** (k + 0.5 * j)
            out[:, j] += np.sin(2 * math.pi * f * t + 2.4 * k * k + j + phase * k) * min(1, 0.25 * f)
    return 1.1 * out

def slope(v, force, m, p):
    return (force - p["friction"] * np.tanh(v / STICK) - p["viscous"] * v) / m

def advance(x, v, force, h, m, p, n):
    """Runge and Kutta's classical method."""
    h = h / n
    for _ in range(n):
        a1 = slope(v, force, m, p)
        a2 = slope(v + h / 2 * a1, force, m, p)
        a3 = slope(v + h / 2 * a2, force, m, p)
        a4 = slope(v + h * a3, force, m, p)
        x = x + h * v + h * h / 6 * (a1 + a2 + a3)
        v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return x, v

def rigid(force, p):
    """Positions, m, of both axes from rest; the force of a tick acts from `delay` after it on."""
    m = np.array([p["mass_x"], p["mass_y"]])
    x, v, out, before = np.zeros(2), np.zeros(2), np.zeros_like(force), np.zeros(2)
    for k in range(len(force)):
        out[k] = x
        x, v = advance(x, v, before, p["delay"], m, p, STEPS // 2)
        x, v = advance(x, v, force[k], T - p["delay"], m, p, STEPS)
        before = force[k]
    return out

def with_play(force, p, play):
    """The motor's side, which has a fifth of the mass and the friction, pushes the rest only at the ends of its play."""
    m = np.array([p["mass_x"], p["mass_y"]])
    motor, link, n = 0.2 * m, 0.8 * m, 40
    x, v, y, w = (np.zeros(2) for _ in range(4))
    out, before = np.zeros_like(force), np.zeros(2)
    for k in range(len(force)):
        out[k] = x
        for i in range(n):
            h = T / n
            f = before if (i + 0.5) * h < p["delay"] else force[k]
            gap = x - y
            over = np.sign(gap) * np.maximum(np.abs(gap) - play / 2, 0)
            push = 4e4 * over + 20 * (v - w) * (over != 0)
            v = v + h * slope(v, f - push, motor, p)
            w = w + h * push / link
            x, y = x + h * v, y + h * w
        before = force[k]
    return out

def make(template, out, limit=math.inf, play=0.0, phase=0.0):
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(template, out)
    rows = np.load(out / "tick.npy")
    force = torques(len(rows), phase)
    given = np.clip(force, -limit, limit)
    x = with_play(given, ARM, play) if play else rigid(given, ARM)
    rows["q"] = np.rint((np.array([math.pi / 2, 0]) + x * np.array([1, 1]) / L) / COUNT) * COUNT
    rows["tau"] = force * L
    np.save(out / "tick.npy", rows)
    print(f"{np.abs(x).max():.3f} m at most, {np.abs(np.diff(x, axis=0)).max() / T:.2f} m/s,"
          f" limited in {100 * (given != force).mean():.1f} %")

def plant(path):
    text = pathlib.Path(path).read_text()
    value = {m[1]: float(m[2]) for m in re.finditer(r"^(\w+)\s*=\s*(-?[\d.][-\d.e]*)\s", text, re.M)}
    ends = {m[1]: (float(m[2]), float(m[3])) for m in re.finditer(r"^(\w+)\s*=.*; \S.*, (\S+) to (\S+) \(95 %\)", text, re.M)}
    return value, ends

def check(path, more):
    value, ends = plant(path)
    truth = dict(ARM, **{k: float(v) for k, v in (w.split("=") for w in more)})
    failed = 0
    for name, is_ in truth.items():
        low, high = ends.get(name, (math.inf, -math.inf))
        near = abs(value[name] - is_) <= (0.01e-3 if name == "delay" else 0.01 * is_)
        spare = 0.25 * (high - low)
        good = near and low - spare <= is_ <= high + spare
        failed += not good
        print(f"{name}: is {is_:.6g}, found {value[name]:.6g}, {low:.6g} to {high:.6g}{'' if good else '  FAILED'}")
    return failed > 0

# ---- the same windows, by scipy ----

FIRST, WINDOW = 150 + 8, 250 # ticks: the torque may rise at first; the longest delay

def windows(folder):
    rows = np.load(folder / "tick.npy")
    stop = int(next(l for l in (folder / "events.csv").read_text().splitlines() if "limits.speed 0" in l).split(",")[0])
    starts = np.arange(FIRST, stop - WINDOW + 1, WINDOW)
    tail = stop - (starts[-1] + WINDOW)
    if tail >= 30: sys.exit(f"{tail} ticks are left over, which are a window of their own")
    return rows, starts

AHEAD = 50 # ticks

def judge(folder, path, said):
    """Both axes of all windows at once: place and speed at the beginning are fitted to all but the last AHEAD ticks."""
    value, _ = plant(path)
    rows, starts = windows(folder)
    q, force = rows["q"] * L, np.clip(rows["tau"] / L, -value["force_limit"], value["force_limit"])
    m, seen = np.array([value["mass_x"], value["mass_y"]]), WINDOW - AHEAD

    def predict(x, v, count):
        out = [x]
        for k in range(count - 1):
            x, v = advance(x, v, force[starts + k - 1], value["delay"], m, value, 3)
            x, v = advance(x, v, force[starts + k], T - value["delay"], m, value, 6)
            out.append(x)
        return np.stack(out)

    measured = np.stack([q[starts + k] for k in range(WINDOW)])
    x, v = measured[0], (measured[6] - measured[0]) / (6 * T)
    for _ in range(12):
        base = predict(x, v, seen)
        a, b = (predict(x + 1e-7, v, seen) - base) / 1e-7, (predict(x, v + 1e-5, seen) - base) / 1e-5
        r = measured[:seen] - base
        aa, ab, bb, ar, br = ((s * t).sum(axis=0) for s, t in ((a, a), (a, b), (b, b), (a, r), (b, r)))
        x = x + (bb * ar - ab * br) / (aa * bb - ab * ab)
        v = v + (aa * br - ab * ar) / (aa * bb - ab * ab)
    off = (measured - predict(x, v, WINDOW)) / L
    rms = np.sqrt((off ** 2).mean(axis=1))
    lines = re.findall(r"joint (\d) +one tick ahead (\S+) .*, 50 ms ahead (\S+) \(", pathlib.Path(said).read_text())
    failed = len(lines) != 2
    for joint, step, ahead in lines:
        for name, text, own in (("one tick", step, rms[seen][int(joint) - 1]), ("50 ms", ahead, rms[-1][int(joint) - 1])):
            good = abs(float(text) - own) <= 0.01 * own
            failed |= not good
            print(f"joint {joint}, {name} ahead: {text} rad, numpy {own:.6g}, {own / COUNT:.2f} counts{'' if good else '  FAILED'}")
    return failed

def compare(folder, path):
    from scipy.optimize import least_squares
    value, ends = plant(path)
    rows, starts = windows(folder)
    q, force = rows["q"] * L, rows["tau"] / L
    names = ["mass_x", "mass_y", "friction", "viscous", "delay"]
    scale = np.array([value[n] if n != "delay" else 1e-3 for n in names])
    measured = np.stack([q[starts + k] for k in range(WINDOW)])

    def predict(theta, x, v):
        p = dict(zip(names, theta * scale))
        m = np.array([p["mass_x"], p["mass_y"]])
        out = [x]
        for k in range(WINDOW - 1):
            x, v = advance(x, v, force[starts + k - 1], p["delay"], m, p, 3)
            x, v = advance(x, v, force[starts + k], T - p["delay"], m, p, 6)
            out.append(x)
        return np.stack(out)

    n, w = len(names), len(starts)
    split = lambda z: (z[:n], z[n:n + 2 * w].reshape(w, 2), z[n + 2 * w:].reshape(w, 2))
    left = lambda z: ((predict(*split(z)) - measured) / COUNT).ravel()

    def slopes(z):
        theta, x, v = split(z)
        base = predict(theta, x, v)
        out = np.zeros((WINDOW, w, 2, len(z)))
        for i in range(n):
            moved = theta.copy()
            moved[i] += 1e-4
            out[..., i] = (predict(moved, x, v) - base) / 1e-4
        for part, h, at in ((0, 1e-6, n), (1, 1e-5, n + 2 * w)):
            change = (predict(theta, x + h * (part == 0), v + h * (part == 1)) - base) / h
            for a in range(w):
                for j in range(2):
                    out[:, a, j, at + 2 * a + j] = change[:, a, j]
        return out.reshape(-1, len(z)) / COUNT

    speed = np.stack([(q[starts + 6] - q[starts])]) / (6 * T)
    begin = np.concatenate([np.array([1.1, 0.9, 0.8, 1.2, 0.2]) , measured[0].ravel(), speed.ravel()])
    found = least_squares(left, begin, jac=slopes, x_scale="jac", xtol=1e-7, ftol=1e-9)
    failed = 0
    for name, x in zip(names, found.x[:n] * scale):
        half = (ends[name][1] - ends[name][0]) / 2
        good = abs(x - value[name]) <= 0.2 * half
        failed += not good
        print(f"{name}: ethd-identify {value[name]:.7g}, scipy {x:.7g}, {abs(x - value[name]) / half:.3f} half widths"
              f"{'' if good else '  FAILED'}")
    return failed > 0

if __name__ == "__main__":
    word, rest = sys.argv[1], sys.argv[2:]
    if word == "make":
        sys.exit(make(pathlib.Path(rest[0]), pathlib.Path(rest[1]), *map(float, rest[2:])))
    if word == "judge": sys.exit(judge(pathlib.Path(rest[0]), *rest[1:]))
    sys.exit(check(rest[0], rest[1:]) if word == "check" else compare(pathlib.Path(rest[0]), rest[1]))
