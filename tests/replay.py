"""A second derivation of the control law: random traces through ethd-replay and through this file.

Everything below is written from the equations (paper, eq. 1-8) in plain Python, without a look at lib/.
Agreement: 1e-9 Nm, 1e-10 in beta, states equal.  Usage: replay.py PROGRAM FOLDER
"""
import csv
import math
import random
import subprocess
import sys

T = 0.001
INF = math.inf
SCENES = {
    "one": ["halfplane -1 0 -0.238"],
    "four": ["halfplane -1 0 -0.238", "halfplane 1 0 0.302", "halfplane 0 -1 -0.222", "halfplane 0 1 0.278"],
    "slanted": ["halfplane -0.8 0.6 -0.05", "halfplane -0.6 -0.8 -0.37"],
    "round": ["circle 0.243 0.25 0.01", "capsule 0.29 0.28 0.32 0.23 0.004"],
    "cornered": ["box 0.235 0.25 0.02 0.015 0.4", "polygon 0.29 0.24 0.33 0.22 0.32 0.27"],
    "thin": ["segment 0.25 0.22 0.262 0.28", "segment 0.31 0.27 0.27 0.29"],
}


# ---- the law ----

def jacobian(mechanism, q):
    """X, J with the absolute link angles a, b; dX/da, dX/db are the links turned by 90 degrees."""
    a = q[0]
    b = q[1] if mechanism == "parallel" else q[0] + q[1]
    l1 = (0.25 * math.cos(a), 0.25 * math.sin(a))
    l2 = (0.25 * math.cos(b), 0.25 * math.sin(b))
    x = (l1[0] + l2[0], l1[1] + l2[1])
    da, db = (-l1[1], l1[0]), (-l2[1], l2[0])
    first = da if mechanism == "parallel" else (da[0] + db[0], da[1] + db[1])
    return x, ((first[0], db[0]), (first[1], db[1]))


def solve(m, v):
    det = m[0][0] * m[1][1] - m[0][1] * m[1][0]
    return ((m[1][1] * v[0] - m[0][1] * v[1]) / det, (m[0][0] * v[1] - m[1][0] * v[0]) / det)


# ---- objects: the surface's nearest point P, its signed distance, n into the object ----

def to_point(x, p):
    v = (p[0] - x[0], p[1] - x[1])
    d = math.hypot(*v)
    return d, p, (v[0] / d, v[1] / d)


def to_edge(x, a, b):
    """From outside, and on which side x is: 1 left, -1 right, 0 where an end is the nearest point."""
    u = (b[0] - a[0], b[1] - a[1])
    length = math.hypot(*u)
    along = ((x[0] - a[0]) * u[0] + (x[1] - a[1]) * u[1]) / length
    if along <= 0 or along >= length:
        return *to_point(x, a if along <= 0 else b), 0
    n = (u[1] / length, -u[0] / length)  # for x on the left
    d = (a[0] - x[0]) * n[0] + (a[1] - x[1]) * n[1]
    side = 1 if d > 0 else -1
    return side * d, (x[0] + d * n[0], x[1] + d * n[1]), (side * n[0], side * n[1]), side


def turned(d, p, n):
    return -d, p, (-n[0], -n[1])


def polygon(x, corners):
    inside, best = False, None
    for a, b in zip(corners, corners[1:] + corners[:1]):
        if (a[1] > x[1]) != (b[1] > x[1]) and x[0] < a[0] + (x[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]):
            inside = not inside
        here = to_edge(x, a, b)[:3]
        if best is None or here[0] < best[0]:
            best = here
    return turned(*best) if inside else best


def circle(x, centre, r):
    d, _, n = to_point(x, centre)
    return d - r, (centre[0] - r * n[0], centre[1] - r * n[1]), n


def touch(kind, w, x, side):
    """side: of a thin wall, the one on which the contact began; the one that holds now comes back."""
    if kind == "halfplane":
        d = w[2] - (w[0] * x[0] + w[1] * x[1])
        return (d, (x[0] + d * w[0], x[1] + d * w[1]), (w[0], w[1])), 0
    if kind == "circle":
        return circle(x, w[:2], w[2]), 0
    if kind == "capsule":
        return circle(x, to_edge(x, w[:2], w[2:4])[1], w[4]), 0
    if kind == "box":
        c, s = math.cos(w[4]), math.sin(w[4])
        corners = [(w[0] + c * u - s * v, w[1] + s * u + c * v)
                   for u, v in ((-w[2], -w[3]), (w[2], -w[3]), (w[2], w[3]), (-w[2], w[3]))]
        return polygon(x, corners), 0
    if kind == "polygon":
        return polygon(x, list(zip(w[::2], w[1::2]))), 0
    *here, now = to_edge(x, w[:2], w[2:4])
    through = now != 0 and now == -side
    return (turned(*here) if through else here), side if through else now


def beta_of(d, d_beta, beta_min):
    if d > d_beta:
        return 1.0
    return (1 - beta_min) / d_beta * d + beta_min if d > 0 else beta_min


class Machine:
    """Figure 5, one per contact."""

    def __init__(self):
        self.forget()

    def forget(self):
        self.state, self.eps, self.ticks, self.branch, self.side = 0, 0.0, 0, 1, 0

    def step(self, c, d_re, v, d_beta):
        if self.state == 0:
            if d_re < 0:
                self.state, self.ticks = 1, 0
        elif self.state == 1:
            self.ticks += 1
            if abs(v) < c["v_th"]:
                self.state, self.eps = 2, -d_re
            elif d_re > d_beta:
                self.state = 0
            elif -d_re >= c["eps_max"] or self.ticks >= round(c["t_max"] / T if c["t_max"] < INF else 1e18):
                self.state, self.eps = 2, -d_re
        elif d_re > d_beta:
            self.state, self.eps = 0, 0.0


def contact_force(c, k_e, gap, v, entering):
    if not gap < 0:
        return 0.0
    if c["contact"] == "spring":
        return k_e * gap
    if c["contact"] == "hunt-crossley":
        return min(0.0, k_e * gap * (1 + c["c_e"] * v))
    return min(0.0, k_e * gap - (c["b_e"] * v if entering else 0.0))


def run(c, rows):
    d_beta = c["ring"] - c["radius_max"]
    objects = [(line.split()[0], [float(w) for w in line.split()[1:]]) for line in SCENES[c["scene"]]]
    machines = [Machine() for _ in objects]
    q_prev = qd = e_prev = None
    a = 1 - math.exp(-2 * math.pi * c["cutoff"] * T)
    out = []
    for r in rows:
        q = (r["q1_rad"], r["q2_rad"])
        x, j = jacobian(c["mechanism"], q)
        if "dq1_radps" in r:
            qd = (r["dq1_radps"], r["dq2_radps"])
        elif q_prev is None:
            qd = (0.0, 0.0)
        else:
            qd = tuple(qd[i] + a * ((q[i] - q_prev[i]) / T - qd[i]) for i in (0, 1))
        q_prev = q
        vr = (j[0][0] * qd[0] + j[0][1] * qd[1], j[1][0] * qd[0] + j[1][1] * qd[1])
        xf, vf = (r["xf_m"], r["yf_m"]), (r["vxf_mps"], r["vyf_mps"])
        e = solve(j, (xf[0] - x[0], xf[1] - x[1]))
        ed = solve(j, (vf[0] - vr[0], vf[1] - vr[1]))
        if c["derivative"] == "difference":
            ed = (0.0, 0.0) if e_prev is None else tuple((e[i] - e_prev[i]) / T for i in (0, 1))
        e_prev = e
        beta, force, brake, deepest = 1.0, [0.0, 0.0], [0.0, 0.0], None
        for number, ((kind, numbers), m) in enumerate(zip(objects, machines)):
            (distance, p, (nx, ny)), side = touch(kind, numbers, x, m.side)
            d_re = distance - c["ring"]
            to_finger = nx * (p[0] - xf[0]) + ny * (p[1] - xf[1])
            v = nx * vr[0] + ny * vr[1]
            if c["law"] == "offset":
                d_fe = to_finger - c["ring"]
                near = d_re < d_beta or d_fe <= d_beta or m.state != 0
                if near:
                    m.step(c, d_re, v, d_beta)
                d_fe += m.eps
                b = beta_of(d_fe, d_beta, c["beta_min"])
                state, eps = m.state, m.eps
            else:
                d_fe = to_finger - c["radius"]
                state, eps = (2 if d_re < 0 else 0), 0.0
                near = d_re < d_beta or d_fe <= d_beta
                b = (0.0 if d_re < 0 else 1.0) if c["law"] == "abrupt" else beta_of(d_fe, d_beta, c["beta_min"])
            if not (d_re < d_beta or d_fe <= d_beta or state != 0):
                m.branch, m.side = 1, 0
                continue
            m.side = side
            if v < -c["v_hysteresis"]:
                m.branch = -1
            elif v > c["v_hysteresis"]:
                m.branch = 1
            pushes = state == 2 or c["law"] == "smooth"
            f = contact_force(c, c["k_e_of"][number], d_re + eps, v, m.branch > 0) if pushes else 0.0
            damping = -c["b_d"] * v if c["law"] == "offset" and state == 1 else 0.0
            force = [force[0] + f * nx, force[1] + f * ny]
            brake = [brake[0] + damping * nx, brake[1] + damping * ny]
            beta = min(beta, b)
            if deepest is None or d_re < deepest[0]:
                deepest = (d_re, d_fe, v, state, eps)
        tau = []
        for i in (0, 1):
            tau_t = c["k_t"] * e[i] + c["b_t"] * ed[i]
            tau.append(beta * tau_t + j[0][i] * (force[0] + brake[0]) + j[1][i] * (force[1] + brake[1]))
        out.append((tau, beta, force, brake, deepest, x, vr, e))
    return out


# ---- the traces ----

def inverse(mechanism, x):
    r2 = x[0] ** 2 + x[1] ** 2
    half = math.acos(math.sqrt(r2) / 0.5)
    middle = math.atan2(x[1], x[0])
    a, b = middle + half, middle - half
    return (a, b) if mechanism == "parallel" else (a, b - a)


def make_rows(rng, mechanism, with_speed, n=2500):
    w = [(rng.uniform(0.5, 3), rng.uniform(0, 6.28)) for _ in range(4)]
    lag = [rng.uniform(-0.004, 0.004) for _ in range(2)]
    rows, t0 = [], rng.uniform(0, 100)
    held, hold_until = None, 0
    for k in range(n):
        t = k * T
        if rng.random() < 0.002 and k > hold_until:
            held, hold_until = t, k + rng.randrange(20, 120)
        s = held if k < hold_until else t  # now and then the ring stands still
        moving = 0.0 if k < hold_until else 1.0
        c = [(math.sin(f * 6.28 * s + p), f * 6.28 * math.cos(f * 6.28 * s + p) * moving) for f, p in w]
        x = (0.270 + 0.016 * c[0][0] + 0.012 * c[1][0], 0.250 + 0.014 * c[2][0] + 0.012 * c[3][0])
        v = (0.016 * c[0][1] + 0.012 * c[1][1], 0.014 * c[2][1] + 0.012 * c[3][1])
        q = inverse(mechanism, x)
        row = {"t_s": t0 + t, "q1_rad": q[0], "q2_rad": q[1],
               "xf_m": x[0] + 0.008 * v[0] + lag[0], "yf_m": x[1] + 0.008 * v[1] + lag[1],
               "vxf_mps": v[0] + rng.gauss(0, 0.02), "vyf_mps": v[1] + rng.gauss(0, 0.02)}
        if with_speed:
            qd = solve(jacobian(mechanism, q)[1], v)
            row["dq1_radps"], row["dq2_radps"] = qd[0] + rng.gauss(0, 0.02), qd[1] + rng.gauss(0, 0.02)
        rows.append(row)
    return rows


def make_case(rng, number):
    laws = ["abrupt", "smooth", "offset"]
    contact = rng.choice(["kelvin-voigt", "kelvin-voigt", "spring", "hunt-crossley"])
    c = {"mechanism": ["parallel", "serial"][number % 2], "law": laws[number // 2 % 3],
         "scene": list(SCENES)[number // 6 % 6], "contact": contact,
         "ring": rng.choice([0.012, 0.0125]), "radius": rng.uniform(0.005, 0.009),
         "radius_max": rng.uniform(0.0092, 0.0108), "cutoff": rng.uniform(20, 300),
         "k_t": rng.uniform(1, 80), "b_t": rng.uniform(0, 2), "derivative": rng.choice(["velocity", "difference"]),
         "k_e": rng.uniform(100, 5000), "b_e": rng.uniform(0, 90), "c_e": rng.uniform(0, 3),
         "b_d": rng.uniform(10, 200), "v_th": rng.uniform(0.005, 0.05), "beta_min": rng.choice([0.0, 0.1, 0.3]),
         "eps_max": rng.choice([0.001, 0.006, INF]), "t_max": rng.choice([0.004, 0.050, INF]),
         "v_hysteresis": rng.choice([0.0, 0.0, 0.03])}
    c["k_e_of"] = [c["k_e"]] + [rng.choice([c["k_e"], 300.0]) for _ in SCENES[c["scene"]][1:]]
    paper = c["law"] == "offset" and rng.random() < 0.3
    if paper:
        c["eps_max"] = c["t_max"] = INF
        c["v_hysteresis"] = 0.0
    own = {"kelvin-voigt": ["k_e", "b_e"], "spring": ["k_e"], "hunt-crossley": ["k_e", "c_e"]}[contact]
    lines = ["[arm]", f"mechanism = {c['mechanism']}", "[ring]", f"radius = {c['ring']!r}",
             "[finger]", f"radius = {c['radius']!r}", f"radius_max = {c['radius_max']!r}",
             "[velocity]", "method = lowpass", f"cutoff = {c['cutoff']!r}",
             "[tracking]", f"k_t = {c['k_t']!r}", f"b_t = {c['b_t']!r}", f"derivative = {c['derivative']}",
             "[contact]", f"law = {contact}"] + [f"{k} = {c[k]!r}" for k in own]
    lines += ["[transition]", f"law = {c['law']}"]
    if paper:
        lines.append("preset = paper")
    else:
        lines.append(f"v_hysteresis = {c['v_hysteresis']!r}")
    keys = {"abrupt": [], "smooth": ["beta_min"], "offset": ["beta_min", "b_d", "v_th"] + ([] if paper else ["eps_max", "t_max"])}
    lines += [f"{k} = {c[k]!r}" for k in keys[c["law"]]] + ["[scene]", "file = walls.scene", ""]
    return c, "\n".join(lines)


def worst_difference(c, expected, path):
    worst = {}

    def note(name, a, b):
        worst[name] = max(worst.get(name, 0.0), abs(a - b))

    with open(path) as f:
        for (tau, beta, force, brake, deepest, x, vr, e), row in zip(expected, csv.DictReader(f), strict=True):
            for i in (0, 1):
                note("tau", tau[i], float(row[f"tau{i + 1}_Nm"]))
                note("tau", tau[i], float(row[f"tau{i + 1}_raw_Nm"]))
                note("eps_q", e[i], float(row[f"epsq{i + 1}_rad"]))
                note("force", force[i], float(row["fex_N" if i == 0 else "fey_N"]))
                note("force", brake[i], float(row["fdx_N" if i == 0 else "fdy_N"]))
                note("ring", x[i], float(row["x_m" if i == 0 else "y_m"]))
                note("ring", vr[i], float(row["vx_mps" if i == 0 else "vy_mps"]))
            note("beta", beta, float(row["beta"]))
            if deepest is None:
                assert row["d_re_m"] == row["d_fe_m"] == row["v_n_mps"] == "", row
                assert row["state"] == "0" and float(row["eps_m"]) == 0 and float(row["beta"]) == 1, row
                continue
            for name, a in zip(("d_re_m", "d_fe_m", "v_n_mps", "state", "eps_m"), deepest):
                note(name, a, float(row[name]))
    return worst


def check_guard(program, folder):
    """The guard acts behind `raw`, never latches, and is no failure of the replay."""
    rows = make_rows(random.Random(3), "parallel", False, 600)
    with open(f"{folder}/in.csv", "w") as f:
        f.write(",".join(rows[0]) + "\n")
        f.writelines(",".join(map(repr, r.values())) + "\n" for r in rows)
    out = []
    for limits in ("", "[limits]\ntorque = 1.5\nworkspace = 0.26 1 -1 1\n"):
        with open(f"{folder}/c.ini", "w") as f:
            f.write(limits)
        subprocess.run([program, "--config", f"{folder}/c.ini", "--in", f"{folder}/in.csv",
                        "--out", f"{folder}/out.csv"], check=True, capture_output=True)
        with open(f"{folder}/out.csv") as f:
            out.append([{k: float(v or "nan") for k, v in row.items()} for row in csv.DictReader(f)])
    left = returned = 0
    for free, held in zip(*out):
        outside = held["x_m"] < 0.26
        left += outside
        returned += left > 0 and not outside
        for tau, raw in (("tau1_Nm", "tau1_raw_Nm"), ("tau2_Nm", "tau2_raw_Nm")):
            assert free[tau] == free[raw] == held[raw], (free, held)
            assert abs(held[tau]) <= 1.5, held
            assert outside or held[tau] == max(-1.5, min(1.5, held[raw])), held
    assert left > 20 and returned > 20, (left, returned)


def main():
    program, folder = sys.argv[1:3]
    check_guard(program, folder)
    rng = random.Random(20)
    limits = {"tau": 1e-9, "beta": 1e-10, "state": 0}
    total, states = {}, {}
    for number in range(72):
        c, ini = make_case(rng, number)
        rows = make_rows(rng, c["mechanism"], number % 4 < 2)
        with open(f"{folder}/c.ini", "w") as f:
            f.write(ini)
        with open(f"{folder}/walls.scene", "w") as f:
            f.write("material soft k_e=300\n")
            f.writelines(line + (" material=soft" if k_e == 300 else "") + "\n"
                         for line, k_e in zip(SCENES[c["scene"]], c["k_e_of"]))
        with open(f"{folder}/in.csv", "w") as f:
            names = list(rows[0])
            rng.shuffle(names)
            f.write(",".join(names) + "\n")
            f.writelines(",".join(repr(r[k]) for k in names) + "\n" for r in rows)
        subprocess.run([program, "--config", f"{folder}/c.ini", "--in", f"{folder}/in.csv",
                        "--out", f"{folder}/out.csv"], check=True, stdout=subprocess.DEVNULL)
        expected = run(c, rows)
        for _, _, _, _, deepest, *_ in expected:
            key = (c["law"], deepest[3] if deepest else None)
            states[key] = states.get(key, 0) + 1
        for name, value in worst_difference(c, expected, f"{folder}/out.csv").items():
            total[name] = max(total.get(name, 0.0), value)
            if not value <= limits.get(name, 1e-9):
                sys.exit(f"case {number}: {name} differs by {value:g}\n{ini}")
    for key in [("offset", 0), ("offset", 1), ("offset", 2), ("smooth", 2), ("abrupt", 2), ("offset", None)]:
        if states.get(key, 0) < 100:
            sys.exit(f"the traces hardly visit {key}: {states}")
    print("72 traces agree; largest differences: " + ", ".join(f"{k} {v:.2g}" for k, v in total.items()))


main()
