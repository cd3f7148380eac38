"""Apart from our own code, in NumPy: the front of apps/explain/README.md seen by a model of seven of its lines.

The ring is one mass, or two with a spring and a damper; the current loop may be a first-order lag of up to 0.8 ms (200 Hz);
the encoder sits on the motor's side or on the ring's. A tick's torque is held, delayed and saturated, the speed is the
low-pass of the encoder's difference, and no finger comes. Its lines are the four means of Table 1, braked from 0.2 and
0.4 m/s, and the largest stable K_e, B_e and B_d, from the eigenvalues of one tick.

  explain_forms.py PAGE SHARE  the page's limits of K_e, B_e and B_d for n, p and the two plants beside it; the points
                               that the search below has found, and that their misses are as the page says
  explain_forms.py search      searches for these points: some six minutes of one processor"""
import pathlib, re, sys
import numpy as np

T = 1e-3
LINES = {"ds_low": (1.709, 4.513), "eps_low": (0.2625, 0.5135), "ds_high": (13.844, 15.268), "eps_high": (2.2555, 2.6125),
         "K_e": (1.2, 2.5), "B_e": (1.2, 2.5), "B_d": (1.2, 2.5)}
KEYS = ("mass", "deceleration", "delay", "cutoff", "share", "resonance", "damping", "lag")
LOW = np.array([0.1, 25, 0.05e-3, 30, 0.05, 30, 0.01, 0.05e-3])
HIGH = np.array([0.5, 100, 4e-3, 500, 0.6, 300, 0.5, 0.8e-3])

def exponential(a):
    halvings = max(0, int(np.ceil(np.log2(max(np.abs(a).sum(1).max(), 1e-300)))) + 2)
    term = out = np.eye(len(a))
    for k in range(1, 20):
        term = term @ a / 2.0**halvings / k
        out = out + term
    for _ in range(halvings): out = out @ out
    return out

class Ring:
    """State: motor's x and v, how far and how fast the ring is ahead, force in effect; then the force that is asked for."""

    def __init__(self, mass, delay, cutoff, motor=0, spring=0, damper=0, lag=0, on_ring=False):
        driven, rest = motor or mass, mass - motor
        a = np.zeros((6, 6))
        a[0, 1] = 1
        a[1, 4 if lag else 5] = 1 / driven
        if motor:
            a[1, 2:4] = spring / driven, damper / driven
            a[2, 3] = 1
            a[3] = -a[1]
            a[3, 2] -= spring / rest
            a[3, 3] -= damper / rest
        if lag: a[4, 4], a[4, 5] = -1 / lag, 1 / lag
        self.ticks = int(delay / T + 1e-9)
        self.late = delay - self.ticks * T > 1e-9
        self.before = exponential(a * (delay - self.ticks * T))
        self.after = exponential(a * (T - (delay - self.ticks * T)))
        self.keep = np.exp(-2 * np.pi * cutoff * T)
        self.mass, self.on_ring = mass, on_ring

    def seen(self, s): return s[0] + (s[2] if self.on_ring else 0)

    def move(self, s, forces):
        """Over a tick; forces: as they were asked for, the newest first."""
        if self.late: s = self.before[:5, :5] @ s + np.outer(self.before[:5, 5], forces[self.ticks + 1])
        return self.after[:5, :5] @ s + np.outer(self.after[:5, 5], forces[self.ticks])

    def radius(self, stiffness, damping):
        n = 7 + self.ticks + 1 # the five, the speed, the last position, forces that wait
        e = np.eye(n)
        x = self.seen(e)
        v = self.keep * e[5] + (1 - self.keep) / T * (x - e[6])
        forces = np.vstack([-stiffness * x - damping * v, e[7:]])
        return np.abs(np.linalg.eigvals(np.vstack([self.move(e[:5], forces), v, x, forces[:-1]]))).max()

    def times(self, stiffness, damping, raised, most=16, steps=24):
        """The largest stable multiple of one gain: of the band of 1 if that is stable, else the first one below it."""
        def stable(g): return self.radius(stiffness * (g if raised == "K" else 1), damping * (g if raised == "B" else 1)) < 1 + 1e-7
        own, low, high = stable(1), 1, 1
        while stable(low) == own and 1 / most < low and high < most:
            if own: low *= 1.05
            else: low /= 1.05
        if stable(low) == own: return low if own else 0
        low, high = (low / 1.05, low) if own else (low, low * 1.05)
        for _ in range(steps):
            middle = (low * high) ** 0.5
            low, high = (middle, high) if stable(middle) else (low, middle)
        return low

    def brake(self, speed, force):
        """Mean Delta_s, ms, and eps, mm, over speeds and over where between two ticks the wall is met."""
        speed, phase = np.repeat(speed, 3), np.tile([1 / 6, 0.5, 5 / 6], len(speed))
        s = np.zeros((5, len(speed)))
        s[0], s[1] = speed * phase * T, speed
        last, v, forces = s[0] - speed * T, speed.copy(), np.zeros((self.ticks + 2, len(speed)))
        time, depth = np.full((2, len(speed)), np.nan)
        for k in range(60):
            x = self.seen(s)
            v = self.keep * v + (1 - self.keep) / T * (x - last)
            last = x.copy()
            stands = np.isnan(time) & (np.abs(v) < 0.02)
            time[stands], depth[stands] = k, 1e3 * x[stands]
            if not np.isnan(time).any(): break
            forces = np.vstack([np.clip(-100 * v, -force, force), forces[:-1]])
            s = self.move(s, forces)
        return time.mean(), depth.mean()

def figures(point, structure, lag, steps=24):
    p = dict(zip(KEYS, point))
    mu, turn = p["mass"] * p["share"] * (1 - p["share"]), 2 * np.pi * p["resonance"]
    soft = {} if structure == "rigid" else dict(motor=p["mass"] * p["share"], spring=mu * turn**2,
                                                damper=2 * p["damping"] * mu * turn, on_ring=structure == "encoder on the ring")
    ring = Ring(p["mass"], p["delay"], p["cutoff"], lag=p["lag"] if lag else 0, **soft)
    force = p["mass"] * p["deceleration"]
    low, high = ring.brake(0.2 * np.array([0.8, 1, 1.2]), force), ring.brake(0.4 * np.array([0.9, 1, 1.1]), force)
    return dict(zip(LINES, [*low, *high, *(ring.times(k, b, raised, 8, steps) for k, b, raised in
                                           ((2500, 45, "K"), (2500, 45, "B"), (0, 100, "B")))]))

def miss(name, value):
    """As ethd-explain counts it: halves of a mean's bounds, factors of 2 of a gain's, 4 at most."""
    low, high = LINES[name]
    if np.isnan(value): return 4
    if name in ("K_e", "B_e", "B_d"): return min(4, max(0, np.log2(low / max(value, 1e-3)), np.log2(value / high)))
    return min(4, max(0, low - value, value - high) / (high - low) * 2)

def misses(of): return {name: miss(name, value) for name, value in of.items()}

def search(structure, lag, seed, population=24, generations=60):
    rng = np.random.default_rng(seed)
    points = rng.random((population, len(KEYS)))
    def total(share): return sum(misses(figures(LOW * (HIGH / LOW) ** share, structure, lag, 5)).values())
    totals = np.array([total(p) for p in points])
    for _ in range(generations):
        order = totals.argsort()
        for i in range(population):
            step, best = 0.3 + 0.6 * rng.random(), points[order[rng.integers(5)]]
            a, b = points[rng.integers(population)], points[rng.integers(population)]
            child = points[i] + step * (best - points[i]) + step * (a - b)
            taken = rng.random(len(KEYS)) < 0.85
            taken[rng.integers(len(KEYS))] = True
            child = np.where(taken, child, points[i])
            child = np.where(child < 0, points[i] / 2, np.where(child > 1, (1 + points[i]) / 2, child))
            is_ = total(child)
            if is_ <= totals[i]: points[i], totals[i] = child, is_
    return LOW * (HIGH / LOW) ** points[totals.argmin()]

# what `search` found, and the lines that each of them misses
FOUND = {
    ("rigid", False): ((0.1204, 39.5, 0.5784e-3, 41.25, 0.1571, 59.11, 0.04698, 0.09133e-3), {"ds_low", "B_d"}),
    ("rigid", True): ((0.1207, 39.53, 0.3801e-3, 41.24, 0.1057, 85.93, 0.02682, 0.2035e-3), {"ds_low", "B_d"}),
    ("encoder on the motor", False): ((0.1882, 35.62, 0.2192e-3, 109, 0.3062, 82.31, 0.0537, 0.1952e-3), {"B_d"}),
    ("encoder on the motor", True): ((0.1621, 32.21, 0.1189e-3, 95.18, 0.2417, 73.98, 0.2345, 0.1155e-3), {"B_d"}),
    ("encoder on the ring", False): ((0.1185, 39.28, 0.5197e-3, 41.43, 0.1565, 299.2, 0.2193, 0.1273e-3), {"ds_low", "B_d"}),
    ("encoder on the ring", True): ((0.1204, 39.34, 0.4147e-3, 41.06, 0.2927, 265.9, 0.05373, 0.1076e-3), {"ds_low", "B_d"}),
}

def show(structure, lag, point):
    is_ = figures(point, structure, lag)
    print(f"{structure}, {'current loop of up to 0.8 ms' if lag else 'no current loop'}: misses {sum(misses(is_).values()):.2f} in sum;",
          " ".join(f"{n} {v:.3g}{'*' if miss(n, v) > 0.02 else ''}" for n, v in is_.items()), flush=True)
    return is_

def limits_of(path):
    plant = {m[1]: float(m[2]) for m in re.finditer(r"^(\w+) *= *([\d.e+-]+|inf)", path.with_suffix(".plant").read_text(), re.M)
             if m[1] != "mass"}
    cutoff = float(re.search(r"^cutoff *= *(\S+)", path.with_suffix(".ini").read_text(), re.M)[1])
    soft = dict(motor=plant["motor_mass"], spring=plant["stiffness"], damper=plant["damping"]) if plant["motor_mass"] else {}
    ring = Ring(plant["mass_x"], plant["delay"], cutoff, **soft)
    return ring.times(2500, 45, "K"), ring.times(2500, 45, "B"), ring.times(0, 100, "B")

def main():
    if sys.argv[1] == "search":
        for structure, lag in FOUND:
            point = search(structure, lag, 1)
            show(structure, lag, point)
            print("   ", " ".join(f"{k} {v:.4g}" for k, v in zip(KEYS, point)), flush=True)
        return 0
    page, share = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    rows = {m[1]: m[2].replace("*", "").split("|") for m in
            re.finditer(r"^\| largest stable (\S+?),? .*?\| [^|]*\|(.*)\|$", page.read_text(), re.M)}
    failed = 0
    for i, path in enumerate([share / "n", share / "p", page.parent / "rigid", page.parent / "compliant"]):
        for name, value in zip(("K_e", "B_e", "B_d"), limits_of(path)):
            said = float(rows[name][i])
            if said == 0: continue # no stable value below the own one; where it begins again isn't looked for here
            print(f"{path.name}: largest stable {name} {value:.4g}, the page {said}")
            if abs(value / said - 1) > 0.01: failed += 1; print("FAILED: the page has another")
    for name, text, ring in (("a delay", "1.53 times B_d and 7.1 times K_e", Ring(0.1783, 0.8e-3, 133.4)),
                             ("a lag", "1.82 and 7.5", Ring(0.1783, 0, 133.4, lag=0.8e-3))):
        b_d, k_e = ring.times(0, 100, "B"), ring.times(2500, 45, "K")
        print(f"{name} of 0.8 ms leaves {b_d:.3g} times B_d, {k_e:.2g} times K_e")
        said = [float(x) for x in re.findall(r"[\d.]+", text)]
        if [round(b_d, 2), round(k_e, 1)] != said or text not in page.read_text(): failed += 1; print("FAILED: the page says", text)
    sums = {}
    for (structure, lag), (point, missed) in FOUND.items():
        is_ = show(structure, lag, point)
        sums[structure, lag] = sum(misses(is_).values())
        if not missed <= {n for n, m in misses(is_).items() if m > 0.02}: failed += 1; print("FAILED: meets a line of", missed)
        said = re.search(rf"^\| {structure} \| [^|]*\| *([\d.]+) *\| *([\d.]+) *\|$", page.read_text(), re.M)
        if not said or abs(float(said[2 if lag else 1]) - sums[structure, lag]) > 0.006: failed += 1; print("FAILED: the page says", said and said[0])
    return failed > 0

if __name__ == "__main__": sys.exit(main())
