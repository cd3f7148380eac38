"""Every figure of a report, worked out again from taps.csv and survey.csv with NumPy, SciPy and statsmodels.

report_figures.py make KIND STUDY   writes made-up taps and answers into a study's folder: plain, ties or missing
report_figures.py check STUDY       compares STUDY/report/*.csv: exact figures to 1e-9, drawn ones within their noise
"""
import csv, itertools, math, sys, warnings
import numpy as np
from scipy import optimize, stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.weightstats import DescrStatsW

COLUMNS = ("participant,block,part,attempt,transition,speed,seed,tap,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,"
           "delta_s_ms,eps_m,t_rvo_s,t_of_s,t_seen_s,peak_force_n,finger_radius_m,commanded_mps,v_hand_mps,"
           "touch_depth_m,eps_felt_m").split(",")
QUANTITIES = { # key: of a row of taps.csv
    "v_rvo": lambda t: t["v_rvo_mps"], "v_of": lambda t: t["v_of_mps"], "d_max": lambda t: 1e3 * t["d_max_m"],
    "v_rmin": lambda t: t["v_rmin_mps"], "delta_s": lambda t: t["delta_s_ms"], "eps": lambda t: 1e3 * t["eps_m"],
    "delay": lambda t: 1e3 * (t["t_of_s"] - t["t_seen_s"]), "peak_force": lambda t: t["peak_force_n"],
    "v_hand": lambda t: t["v_hand_mps"], "touch_depth": lambda t: 1e3 * t["touch_depth_m"],
    "eps_felt": lambda t: 1e3 * t["eps_felt_m"]}
GRAIN = {"delta_s": 1, "delay": 1}
MARGIN = {"d_max": 0.3, "v_of": 0.02, "v_rmin": 0.02}
LAWS = ["abrupt", "smooth", "offset"]
SCALES = {"plain": [5, 5, 5], "ties": [5, 5, 5], "missing": [7, 5, 2, 9, 3, 0]} # answers to each question; 0: in words

# ---- made-up data ----

def make(kind, study):
    rng = np.random.default_rng({"plain": 1, "ties": 2, "missing": 3}[kind])
    people = {"plain": 8, "ties": 10, "missing": 20}[kind]
    laws = ["smooth", "offset"] if kind != "missing" else LAWS
    rows, answers = [], []
    for person in range(people):
        who = rng.normal(0, 1, 4)
        for block, (speed, law) in enumerate(itertools.product(["low", "high"], laws)):
            gone = kind == "missing" and (rng.random() < 0.12 or (person == 3 and speed == "high"))
            high, offset = speed == "high", law == "offset"
            for attempt in range(6):
                valid = not gone and (attempt < 3 or rng.random() < 0.3)
                if kind == "missing" and gone and rng.random() < 0.5:
                    continue
                noise = rng.normal(0, 1, 6)
                d_max = abs(0.4 + (0.6 if high and not offset else 0.02 * who[0]) + 0.15 * noise[0]) * 1e-3
                v_of = -0.03 + 0.04 * offset - 0.02 * high * (not offset) + 0.01 * who[1] + 0.01 * noise[1]
                v_rmin = -0.06 - 0.06 * high * (not offset) + 0.03 * offset + 0.01 * noise[2]
                delta_s = round(5 + 9 * high * (rng.random() < 0.6) + 0.8 * noise[3]) if offset else None
                eps = (0.4 + 1.9 * high + 0.2 * noise[4]) * 1e-3 if offset else None
                if kind == "ties":
                    d_max, v_of, v_rmin = round(d_max, 4), round(v_of, 2), round(v_rmin, 2)
                    d_max = 0 if rng.random() < 0.2 else d_max
                commanded = (0.4 if high else 0.2) * (1 + 0.25 * noise[5])
                early = not valid and commanded > 0.5 - 0.02 * who[3]
                reason = "ok" if valid else "early-contact" if early else "too-slow"
                row = [f"P{person + 1:02d}", block + 1, "test", attempt + 1, law, speed, 1, len(rows), int(valid), reason,
                       commanded * 0.98, v_of, d_max, v_rmin, delta_s, eps, 0.2, 0.2 + 0.001 * round(8 + noise[1]), 0.204,
                       20 + 5 * noise[2], 0.0075, commanded]
                if kind == "ties": # a table of today, without the hand's speed
                    row += [None] * 3
                else:
                    row += [commanded * 1.01, -1e-4 if early else 2e-4 + 1e-4 * abs(noise[0]), eps]
                    row += [reason, "ok" if abs(row[-3] - (0.4 if high else 0.2)) <= (0.08 if high else 0.06) and not early else "too-slow"]
                rows.append(["" if cell is None else cell if isinstance(cell, (str, int)) else repr(float(cell)) for cell in row])
            given = [int(np.clip(round((1 + n) / 2 + 0.14 * n * (offset + rng.normal())), 1, n)) if n else f"word {person}; {law}" for n in SCALES[kind]]
            answers.append([f"P{person + 1:02d}", block + 1, law, speed] + ([""] * len(given) if gone else given))
    columns = COLUMNS[:-3] if kind == "ties" else COLUMNS + ["by_ring", "by_finger"]
    with open(f"{study}/taps.csv", "w") as f:
        f.write("\n".join(",".join(map(str, row[:len(columns)])) for row in [columns] + rows) + "\n")
    with open(f"{study}/survey.csv", "w") as f:
        f.write("\n".join(",".join(map(str, row)) for row in [["participant", "block", "transition", "speed"] + [f"q{k + 1}" for k in range(len(SCALES[kind]))]] + answers) + "\n")

# ---- reading ----

def number(cell):
    try:
        return float(cell)
    except ValueError:
        return math.nan if cell == "" else cell

def table(path):
    with open(path, newline="") as f:
        return [{key: number(cell) for key, cell in row.items()} for row in csv.DictReader(f)]

NAN = math.nan
compared = 0
overlaps = []
worst = 0.0
failed = []

def same(what, here, there, tolerance=1e-9):
    global compared, worst
    compared += 1
    if isinstance(here, str) or isinstance(there, str):
        good = here == there
    elif math.isnan(there):
        good = math.isnan(here)
    else:
        off = abs(here - there) / max(1, abs(there))
        good = off <= tolerance
        if tolerance == 1e-9 and good:
            worst = max(worst, off)
    if not good:
        failed.append(f"{what}: the report has {here}, it should be {there}")

def drawn(what, low, high, draws):
    """The ends of a 95 % interval of 200 to 2000 draws, against many draws of NumPy's."""
    global compared
    compared += 1
    inside = np.quantile(draws, [0.012, 0.042, 0.958, 0.988])
    if not (inside[0] <= low <= inside[1] and inside[2] <= high <= inside[3]):
        failed.append(f"{what}: {low} to {high}, of NumPy's draws {inside}")

# ---- the statistics, by other people's code ----

def t_interval(x, level):
    if len(x) < 3:
        return math.nan, math.nan
    return stats.t.interval(level, len(x) - 1, np.mean(x), stats.sem(x))

def flips(x):
    """(p, exact?)"""
    if len(x) < 6:
        return math.nan, True
    if len(x) <= 16:
        signs = 1 - 2 * ((np.arange(2 ** len(x))[:, None] >> np.arange(len(x))) & 1)
        return float(np.mean(np.abs(signs @ x) >= abs(x.sum()) - 1e-9 * np.abs(x).sum())), True
    return stats.permutation_test((x,), lambda v, axis: np.mean(v, axis=axis), permutation_type="samples", n_resamples=20000,
                                  vectorized=True, random_state=1).pvalue, False

def same_p(what, here, x):
    p, exact = flips(x)
    if exact:
        same(what, here, p)
    else:
        same(what, here, p, 5 * math.sqrt(p * (1 - p) / 20000) + 4e-4)
    return here

def noncentrality(t, df, p):
    """The one at which t is the quantile p. Far from t SciPy's distribution may be NaN, so the bracket grows."""
    above = lambda s: stats.nct.cdf(t, df, s) - p
    low = high = t
    while above(low) <= 0:
        low -= 0.5
    while above(high) >= 0:
        high += 0.5
    return optimize.brentq(above, low, high, xtol=1e-13)


def d_z_interval(x):
    n = len(x)
    if n < 3 or np.std(x, ddof=1) == 0:
        return math.nan, math.nan
    t = np.mean(x) / np.std(x, ddof=1) * math.sqrt(n)
    return tuple(noncentrality(t, n - 1, p) / math.sqrt(n) for p in (0.975, 0.025))

def equivalent(x, low, high):
    return DescrStatsW(x).ttost_mean(low, high)[0] if len(x) >= 6 else math.nan

def holm(p):
    p = np.array(p, float)
    made = ~np.isnan(p)
    if made.any():
        p[made] = multipletests(p[made], method="holm")[1]
    return p

def cliff(a, b):
    return 2 * stats.mannwhitneyu(b, a).statistic / (len(a) * len(b)) - 1

def wilcoxon(x):
    x = np.array(x)
    if len(x) < 6 or not np.any(x):
        return math.nan
    ranks = stats.rankdata(np.abs(x))[x != 0]
    sign = np.sign(x[x != 0])
    if len(set(np.abs(x))) == len(x) and len(ranks) == len(x):
        return stats.wilcoxon(x, mode="exact").pvalue
    sums = {0.0: 1.0} # shares of all signs, rank by rank
    for r in ranks:
        new = {}
        for s, share in sums.items():
            for add in (0, r):
                new[s + add] = new.get(s + add, 0) + share / 2
        sums = new
    here = ranks[sign > 0].sum()
    return min(1, 2 * min(sum(v for s, v in sums.items() if s <= here), sum(v for s, v in sums.items() if s >= here)))

def dip(x):
    """The nearest unimodal distribution function by linear programming: its mode is at each value in turn."""
    x = np.sort(x)
    n, best = len(x), 1.0
    for k in range(n):
        left, right, d = list(range(k + 1)), list(range(k + 1, n + 2)), n + 1 # G at x[0..k-1], before x[k]; at x[k..]
        A, b = [], []
        def atmost(terms, bound):
            row = np.zeros(n + 2)
            for i, v in terms:
                row[i] += v
            A.append(row)
            b.append(bound)
        for i in range(k):
            atmost([(i, -1), (d, -1)], -(i + 1) / n)
            atmost([(i, 1), (d, -1)], i / n)
        atmost([(k, 1), (d, -1)], k / n)
        atmost([(k + 1, -1), (d, -1)], -(k + 1) / n)
        for i in range(k + 1, n):
            atmost([(i + 1, -1), (d, -1)], -(i + 1) / n)
            atmost([(i + 1, 1), (d, -1)], i / n)
        atmost([(k, 1), (k + 1, -1)], 0)
        for first, side, sign in ((0, left, 1), (k, right[:n - k], -1)):
            for i in range(1, len(side)):
                atmost([(side[i - 1], 1), (side[i], -1)], 0)
            for i in range(2, len(side)):
                h, g = x[first + i - 1] - x[first + i - 2], x[first + i] - x[first + i - 1]
                atmost([(side[i - 1], sign * (1 / h + 1 / g)), (side[i - 2], -sign / h), (side[i], -sign / g)], 0)
        cost = np.zeros(n + 2)
        cost[d] = 1
        found = optimize.linprog(cost, A_ub=np.array(A), b_ub=b, bounds=(0, 1), method="highs")
        best = min(best, found.fun) if found.status == 0 else best
    return best

def spread(x, grain):
    x = np.sort(x)
    out = []
    for value in np.unique(np.round(x / grain)) * grain:
        n = int(np.sum(np.abs(x - value) < grain / 2))
        out += [value + grain * ((k + 0.5) / n - 0.5) for k in range(n)]
    return np.array(out)

rng = np.random.default_rng(7)

def bootstrap(sides, figure, count=3000):
    """sides: for each, a person's taps; people are drawn, then each one's taps. figure takes all draws at once: a row
    each, NaN where a person has fewer taps."""
    people = sorted(set().union(*sides))
    who = rng.integers(len(people), size=(count, len(people)))
    drawn_sides = []
    for side in sides:
        taps = np.array([len(side.get(p, [])) for p in people])
        matrix = np.full((len(people), max(taps)), NAN)
        for i, p in enumerate(people):
            matrix[i, :taps[i]] = side.get(p, [])
        index = np.floor(rng.random((*who.shape, max(taps))) * taps[who][..., None]).astype(int)
        values = np.where(np.arange(max(taps)) < taps[who][..., None], matrix[who[..., None], index], NAN)
        drawn_sides.append(values.reshape(count, -1))
    whole = np.all([(~np.isnan(side)).any(1) for side in drawn_sides], axis=0)
    out = figure(*[side[whole] for side in drawn_sides])
    return out[~np.isnan(out)]

def median_draw(a):
    return np.nanmedian(a, axis=1)

def cliff_draw(a, b):
    pairs = (~np.isnan(a)).sum(1) * (~np.isnan(b)).sum(1)
    return np.array([np.sum(y[:, None] > x) - np.sum(y[:, None] < x) for x, y in zip(a, b)]) / pairs

def threshold_draw(a, b):
    return np.array([threshold(x[~np.isnan(x)], y[~np.isnan(y)]) for x, y in zip(a, b)])

# ---- the report's tables ----

class Study:
    def __init__(self, folder):
        self.report, self.kind = folder + "/report/", folder.split("/")[-1]
        self.taps = [t for t in table(folder + "/taps.csv") if t["part"] == "test"]
        for t in self.taps:
            for name in COLUMNS[-3:]:
                t.setdefault(name, math.nan)
        self.people = sorted({t["participant"] for t in self.taps})
        self.cells = sorted({(t["speed"], t["transition"]) for t in self.taps}, key=lambda c: (c[0] == "high", LAWS.index(c[1])))
        self.survey = table(folder + "/survey.csv") if self.kind in SCALES else []

    def values(self, law, speed, of, valid=True):
        """person: values of the taps"""
        out = {}
        for t in self.taps:
            if t["transition"] == law and t["speed"] == speed and (t["reason"] == "ok" or not valid):
                value = of(t)
                if not math.isnan(value):
                    out.setdefault(t["participant"], []).append(value)
        return out

    def medians(self, law, speed, of):
        return {p: float(np.median(v)) for p, v in self.values(law, speed, of).items()}

def check_summary(s):
    rows = table(s.report + "summary.csv")
    seen = {(r["metric"], r["transition"], r["speed"]) for r in rows}
    same("summary: rows", len(rows), len(seen))
    dips = 0
    for q, of in QUANTITIES.items():
        for speed, law in s.cells:
            v = s.values(law, speed, of)
            if not v:
                same(f"summary {q} {law} {speed}", float((q, law, speed) in seen), 0)
                continue
            r = next(r for r in rows if (r["metric"], r["transition"], r["speed"]) == (q, law, speed))
            x = np.concatenate(list(v.values()))
            what = f"summary {q} {law} {speed} "
            for key, value in dict(n=len(x), participants=len(v), mean=np.mean(x), sd=np.std(x, ddof=1), min=x.min(), max=x.max(),
                                   q1=np.quantile(x, 0.25), median=np.median(x), q3=np.quantile(x, 0.75)).items():
                same(what + key, r[key], value)
            if q in ("d_max", "delta_s"):
                drawn(what + "median's interval", r["median_low"], r["median_high"], bootstrap([v], median_draw))
            if q in ("v_of", "delta_s") and len(x) <= 32 and dips < 2:
                x = spread(x, GRAIN[q]) if q in GRAIN else np.sort(x)
                if len(set(x)) == len(x):
                    same(what + "dip", r["dip"], dip(x))
                    dips += 1

def check_within(what, r, x, with_alike):
    same(what + "participants", r["participants"], len(x))
    same(what + "positive", r["positive"], sum(x > 0))
    same(what + "mean", r.get("mean_b_minus_a", r.get("mean")), np.mean(x))
    same(what + "sd", r["sd"], np.std(x, ddof=1) if len(x) > 1 else math.nan)
    same(what + "median", r["median"], np.median(x))
    low, high = t_interval(x, 0.95)
    same(what + "low", r["mean_low"], low)
    same(what + "high", r["mean_high"], high)
    same_p(what + "p", r["p"], x)
    d_z = np.mean(x) / np.std(x, ddof=1) if len(x) > 1 and np.std(x, ddof=1) > 0 else math.nan
    same(what + "d_z", r["d_z"], d_z)
    low, high = d_z_interval(x)
    same(what + "d_z low", r["d_z_low"], low)
    same(what + "d_z high", r["d_z_high"], high)
    if with_alike:
        margin = MARGIN.get(r["metric"], math.nan)
        same(what + "equivalence", r["p_equivalent"], equivalent(x, -margin, margin) if not math.isnan(margin) else math.nan)
        if not math.isnan(margin) and len(x) >= 6:
            low, high = t_interval(x, 0.9)
            same(what + "90 % low", r["mean_low_90"], low)
            same(what + "90 % high", r["mean_high_90"], high)

def check_pairs(s):
    rows = table(s.report + "pairs.csv")
    for r in rows:
        of, speed = QUANTITIES[r["metric"]], r["speed"]
        a, b = (s.medians(r[key], speed, of) for key in ("transition_a", "transition_b"))
        what = f"pairs {r['metric']} {r['transition_b']} - {r['transition_a']} {speed} "
        check_within(what, r, np.array([b[p] - a[p] for p in s.people if p in a and p in b]), True)
        a, b = (s.values(r[key], speed, of) for key in ("transition_a", "transition_b"))
        same(what + "Cliff", r["cliff_delta"], cliff(np.concatenate(list(a.values())), np.concatenate(list(b.values()))))
        if r["metric"] == "d_max":
            drawn(what + "Cliff's interval", r["cliff_low"], r["cliff_high"], bootstrap([a, b], cliff_draw))
    for r, p in zip(rows, holm([r["p"] for r in rows])):
        same("pairs: Holm", r["p_holm"], p)
    return len(rows)

def check_interaction(s):
    rows = table(s.report + "interaction.csv")
    for r in rows:
        of = QUANTITIES[r["metric"]]
        m = [s.medians(r[law], r[speed], of) for law, speed in
             (("transition_b", "speed"), ("transition_a", "speed"), ("transition_b", "less_speed"), ("transition_a", "less_speed"))]
        x = np.array([m[0][p] - m[1][p] - (m[2][p] - m[3][p]) for p in s.people if all(p in k for k in m)])
        check_within(f"interaction {r['metric']} {r['transition_b']} {r['transition_a']} ", r, x, False)
    for r, p in zip(rows, holm([r["p"] for r in rows])):
        same("interaction: Holm", r["p_holm"], p)
    return len(rows)

CLAIMS = [ # figure of a tap; of a person; weights of smooth low, offset low, smooth high, offset high; bounds
    [("d_max", None, (-1, 1, 0, 0), -0.3, 0.3), ("v_of", None, (-1, 1, 0, 0), -0.02, 0.02), ("v_rmin", None, (-1, 1, 0, 0), -0.02, 0.02)],
    [("d_max", None, (0, 0, 1, -3), 0, NAN)],
    [("v_rmin", abs, (0, 0, 1, -2), 0, NAN)],
    [("v_of", abs, (0, 0, 1, -1), 0, NAN)],
    [("v_of", "share", (0, 0, 0, 1), 25, NAN)],
    [("d_max", None, (-1, 1, 1, -1), 0, NAN), ("v_of", abs, (-1, 1, 1, -1), 0, NAN), ("v_rmin", abs, (-1, 1, 1, -1), 0, NAN)],
    [("valid", "attempts", (0, 0, 0.5, 0.5), 20, 30)],
    [("delta_s", "most", (0, 1, 0, 0), NAN, 20), ("delta_s", "most", (0, 0, 0, 1), NAN, 20)],
    [("eps", "most", (0, 1, 0, 0), NAN, 3), ("eps", "most", (0, 0, 0, 1), NAN, 3)],
]

def contrast(s, key, how, weights):
    total = {p: 0.0 for p in s.people}
    for (law, speed), w in zip((("smooth", "low"), ("offset", "low"), ("smooth", "high"), ("offset", "high")), weights):
        if not w:
            continue
        if how == "share":
            v = {p: 100 * np.mean(np.array(x) > 0) for p, x in s.values(law, speed, QUANTITIES[key]).items()}
        elif how == "most":
            v = {p: max(x) for p, x in s.values(law, speed, QUANTITIES[key]).items()}
        elif how == "attempts":
            v = {p: 100 * np.mean(x) for p, x in s.values(law, speed, lambda t: float(t["reason"] == "ok"), False).items()}
        else:
            of = QUANTITIES[key]
            v = s.medians(law, speed, (lambda t: abs(of(t))) if how is abs else of)
        total = {p: x + w * v[p] for p, x in total.items() if p in v}
    return np.array([total[p] for p in s.people if p in total])

def overlap(first, second):
    """Partially overlapping samples with unequal variances (Derrick and others 2017), of two tables by person."""
    a, b, both = np.array(list(first.values())), np.array(list(second.values())), sorted(set(first) & set(second))
    if min(len(a), len(b)) < 6:
        return (NAN,) * 4
    r = stats.pearsonr([first[p] for p in both], [second[p] for p in both])[0] if len(both) > 2 else 0
    n, m, nc, va, vb = len(a), len(b), len(both), np.var(a, ddof=1) / len(a), np.var(b, ddof=1) / len(b)
    welch = (va + vb) ** 2 / (va ** 2 / (n - 1) + vb ** 2 / (m - 1))
    freedom = nc - 1 + (welch - nc + 1) / (n + m) * (n + m - 2 * nc)
    error = math.sqrt(va + vb - 2 * r * np.std(a, ddof=1) * np.std(b, ddof=1) * nc / (n * m))
    d = np.mean(a) - np.mean(b)
    return d, *stats.t.interval(0.95, freedom, d, error), 2 * stats.t.sf(abs(d) / error, freedom)

def at_one_speed(s, key, how, speed):
    of = QUANTITIES[key]
    v = [s.medians(law, speed, (lambda t: abs(of(t))) if how is abs else of) for law in ("smooth", "offset")]
    return {p: v[0][p] - v[1][p] for p in s.people if p in v[0] and p in v[1]}

def threshold(in_time, early):
    """Of all speeds between two taps the one above which calling them early mistakes the fewest."""
    speeds = np.unique(np.concatenate([in_time, early]))
    if not len(in_time) or not len(early):
        return math.nan
    cuts = (speeds[1:] + speeds[:-1]) / 2
    mistakes = len(in_time) - np.searchsorted(np.sort(in_time), cuts, "right") + np.searchsorted(np.sort(early), cuts, "left")
    return cuts[np.argmin(mistakes)] if mistakes.min() < len(in_time) else math.nan

def check_claims(s):
    rows = table(s.report + "claims.csv")
    ps = []
    for number_of, parts in enumerate(CLAIMS):
        mine = [r for r in rows if r["claim"] == number_of + 1]
        same("claims: parts", len(mine), len(parts))
        p_all, contrary = 0.0, False
        for r, (key, how, weights, low, high) in zip(mine, parts):
            x = contrast(s, key, how, weights)
            what = f"claim {number_of + 1} {r['contrast']} "
            if weights == (-1, 1, 1, -1) and len(x) < 6:
                at = at_one_speed(s, key, how, "low"), at_one_speed(s, key, how, "high")
                d, *ends, p = overlap(at[1], at[0])
                same(what + "test", r["test"], "overlap" if p == p else "")
                if p == p:
                    for name, value in dict(mean=d, low=ends[0], high=ends[1], p=p, participants=len(set(at[0]) | set(at[1])),
                                            people_low=len(at[0]), people_high=len(at[1]), d_z=NAN).items():
                        same(what + name, r[name], value)
                    overlaps.append(what)
                    contrary |= p < 0.05 and d < 0
                p_all = NAN if p != p or math.isnan(p_all) else max(p_all, p if d > 0 else 1.0)
                continue
            test = "sign flip" if math.isnan(low) or math.isnan(high) else "TOST"
            same(what + "test", r["test"], test if len(x) >= 6 else "")
            same(what + "n", r["participants"], len(x))
            same(what + "mean", r["mean"], np.mean(x))
            ends = t_interval(x, 0.95)
            same(what + "low", r["low"], ends[0])
            same(what + "high", r["high"], ends[1])
            if math.isnan(high) or math.isnan(low):
                y = x - low if math.isnan(high) else high - x
                p = same_p(what + "p", r["p"], y)
                if p < 0.05 and np.mean(y) < 0:
                    contrary = True
                p = p if np.mean(y) > 0 or math.isnan(p) else 1.0
            else:
                p = equivalent(x, low, high)
                same(what + "p", r["p"], p)
                if len(x) >= 6 and (ends[0] > high or ends[1] < low):
                    contrary, p = True, 1.0
            p_all = NAN if math.isnan(p) or math.isnan(p_all) else max(p_all, p)
        same(f"claim {number_of + 1} p", mine[0]["p_claim"], p_all)
        ps.append((p_all, contrary, mine[0]))
    r = rows[-1]
    sides = [{}, {}]
    for t in s.taps:
        if not math.isnan(t["commanded_mps"]):
            sides[t["reason"] == "early-contact"].setdefault(t["participant"], []).append(t["commanded_mps"])
    flat = [np.concatenate(list(side.values())) for side in sides]
    same("claim 10 threshold", r["mean"], threshold(*flat))
    draws = bootstrap(sides, threshold_draw, 500)
    p = (max(np.sum(draws < 0.4), np.sum(draws > 0.6)) + 0.5) / len(draws)
    same("claim 10 p", r["p"], p, 4 * math.sqrt(p * (1 - p) / 400) + 4e-3)
    ps.append((r["p"], r["low"] > 0.6 or r["high"] < 0.4, r))
    for (p, contrary, r), corrected in zip(ps, holm([p[0] for p in ps])):
        same("claims: Holm", r["p_holm"], corrected)
        verdict = "too few people" if math.isnan(p) else "the contrary is shown" if contrary else "shown" if corrected < 0.05 else "not shown"
        same("claims: " + r["text"], r["verdict"], verdict)

def check_table1(s):
    for r in table(s.report + "table1.csv"):
        of, speed = QUANTITIES[r["metric"]], r["speed"]
        v = s.values("offset", speed, of)
        x, means = np.concatenate(list(v.values())), np.array([np.mean(k) for k in v.values()])
        what = f"table 1 {r['metric']} {speed} "
        low, high = r["paper_mean"] - r["paper_sd"], r["paper_mean"] + r["paper_sd"]
        ends = t_interval(means, 0.9)
        for key, value in dict(study_mean=np.mean(x), study_sd=np.std(x, ddof=1), study_n=len(x), people=len(means), people_mean=np.mean(means),
                               people_low_90=ends[0], people_high_90=ends[1], p_equivalent=equivalent(means, low, high)).items():
            same(what + key, r[key], value)
        wide = t_interval(means, 0.95)
        p = equivalent(means, low, high)
        same(what + "verdict", r["verdict"], "shown" if p < 0.05 else "the contrary is shown" if wide[0] > high or wide[1] < low else "not shown")
        if len(x) < 30: # too few to draw nine from
            same(what + "nines", r["mean_as_far_off"], NAN)
            continue
        nines = rng.choice(x, (20000, 9))
        for key, drawn_figures, paper in (("mean_as_far_off", nines.mean(1), r["paper_mean"]), ("sd_as_far_off", nines.std(1, ddof=1), r["paper_sd"])):
            share = min(1, 2 * min(np.mean(drawn_figures >= paper), np.mean(drawn_figures <= paper)))
            same(what + key, r[key], share, 10 * math.sqrt(share * (1 - share) / 2000) + 0.01)

def check_survey(s):
    def answers(law, speed, q):
        return {r["participant"]: r[f"q{q}"] for r in s.survey if r["transition"] == law and r["speed"] == speed and not math.isnan(r[f"q{q}"])}
    scales = SCALES[s.kind]
    rows = table(s.report + "survey-answers.csv")
    same("survey: rows", len(rows), len(s.cells) * sum(n > 0 for n in scales))
    for r in rows:
        n = scales[int(r["question"]) - 1]
        same("survey: answers", r["answers"], n)
        same("survey: columns", r.get(f"n{max(scales)}", NAN), NAN if n < max(scales) else r[f"n{n}"])
        x = np.array(list(answers(r["transition"], r["speed"], int(r["question"])).values()))
        what = f"survey Q{r['question']:.0f} {r['transition']} {r['speed']} "
        for k in range(1, n + 1):
            same(what + str(k), r[f"n{k}"], np.sum(x == k))
        for key, value in dict(n=len(x), median=np.median(x), q1=np.quantile(x, 0.25), q3=np.quantile(x, 0.75), mean=np.mean(x), sd=np.std(x, ddof=1)).items():
            same(what + key, r[key], value)
    rows = table(s.report + "survey-tests.csv")
    for r in rows:
        q, speed = int(r["question"]), r["speed"]
        what = f"survey tests Q{q} {r['test']} {speed} "
        if r["test"] == "Friedman":
            laws = [law for at, law in s.cells if at == speed]
            a = [answers(law, speed, q) for law in laws]
            whole = [p for p in s.people if all(p in k for k in a)]
            chi, p = stats.friedmanchisquare(*[[k[w] for w in whole] for k in a])
            same(what + "n", r["n"], len(whole))
            same(what + "chi square", r["statistic"], chi)
            same(what + "p", r["p"], p)
            continue
        a, b = answers(r["transition_a"], speed, q), answers(r["transition_b"], speed, q)
        x = np.array([b[p] - a[p] for p in s.people if p in a and p in b])
        ranks = stats.rankdata(np.abs(x))
        same(what + "n", r["n"], len(x))
        same(what + "higher", r["higher"], np.sum(x > 0))
        same(what + "lower", r["lower"], np.sum(x < 0))
        same(what + "W", r["statistic"], min(ranks[x > 0].sum(), ranks[x < 0].sum()))
        same(what + "p", r["p"], wilcoxon(x))
    for r, p in zip(rows, holm([r["p"] for r in rows])):
        same("survey: Holm", r["p_holm"], p)
    speeds, laws = len({c[0] for c in s.cells}), len({c[1] for c in s.cells})
    same("survey: tests", len(rows), sum(n > 0 for n in scales) * speeds * (laws * (laws - 1) // 2 + (laws > 2)))
    if 0 in scales:
        page = open(s.report + "report.html").read()
        for r in s.survey:
            if isinstance(r["q6"], str):
                same("survey: words", page.count(f">{r['participant']}</td><td class=\"t s\">{r['transition']}, {r['speed']}</td><td class=\"t s\">{r['q6']}</td>"), 1)
    return len(rows)

def check_tidy(s, folder):
    """The table for R: its means of medians are those of the tables, and a mixed model of it gives their interaction."""
    rows = table(s.report + "tidy.csv")
    same("tidy: rows", len(rows), sum(t["reason"] == "ok" for t in s.taps))
    for r, t in zip(sorted(rows, key=lambda r: r["tap"]), [t for t in s.taps if t["reason"] == "ok"]):
        for q in ("d_max", "v_of", "eps", "delay"):
            same("tidy " + q, r[q], QUANTITIES[q](t))
    if not folder.endswith("plain"):
        return
    import pandas, statsmodels.formula.api as formula
    frame = pandas.DataFrame(rows)
    frame = frame[frame.strategy.isin(["smooth", "offset"])]
    with warnings.catch_warnings(record=True): # with eight people it says that it can't be sure of the variances
        fit = formula.mixedlm("d_max ~ strategy * speed", frame, groups=frame["participant"]).fit()
    cell = frame.groupby(["strategy", "speed"])["d_max"].mean()
    by_hand = (cell["smooth", "high"] - cell["offset", "high"]) - (cell["smooth", "low"] - cell["offset", "low"])
    same("mixed model: interaction", -fit.params["strategy[T.smooth]:speed[T.low]"], by_hand, 0.03)

def check_validity(s):
    rows = table(s.report + "validity.csv")
    same("validity: rows", len(rows), 0 if s.kind == "ties" else 3 * len(s.cells)) # ties: a table of an earlier version
    for r in rows:
        taps = [t for t in s.taps if (t["transition"], t["speed"]) == (r["transition"], r["speed"])]
        ring, hand = ([t[key] == "ok" for t in taps] for key in ("by_ring", "by_finger"))
        counts = ring if r["rule"].startswith("ring") else hand if r["rule"].startswith("hand") else [True] * len(taps)
        same(f"validity {r['rule']}", r["taps"], sum(counts))
        same(f"validity {r['rule']}, both", r["by_both"], sum(a and b for a, b in zip(ring, hand)))
        x = [1e3 * t["d_max_m"] for t, c in zip(taps, counts) if c]
        same(f"validity {r['rule']}, d_max", r["d_max"], np.median(x) if x else NAN)

def check(folder):
    s = Study(folder)
    if s.kind not in SCALES: # a real simulation, of one tap a cell
        check_claims(s)
        for line in failed[:12]:
            print("FAILED", line)
        print(f"{compared} figures of the claims of {folder}: {len(failed)} differ; {len(overlaps)} tests of people who overlap")
        return bool(failed) or len(overlaps) != 3
    check_summary(s)
    counts = check_pairs(s), check_interaction(s), check_survey(s)
    check_claims(s)
    check_table1(s)
    check_tidy(s, folder)
    check_validity(s)
    for line in failed[:12]:
        print("FAILED", line)
    print(f"{compared} figures of {folder}: {len(failed)} differ; exact ones by {worst:.1e} at most;"
          f" {counts[0]} differences, {counts[1]} interactions, {counts[2]} tests of answers")
    return bool(failed)

if sys.argv[1] == "make":
    make(sys.argv[2], sys.argv[3])
else:
    sys.exit(check(sys.argv[2]))
