"""The paper's sentences, tested within the fingers of ethd-tap's table: each tap number is one finger.

tap_claims.py TAPS.csv PLANT   plant n: what has to come out for any seed; plant p: the finger touches early at another speed
"""
import csv, os, sys
import numpy as np
sys.path.insert(0, os.path.join(os.environ["BUILD"], "share/ethd/python"))
from ethd_programs.report import claims as paper
from ethd_programs.report.taps import Cell, Speed, Taps

def numbers(rows, column):
    return np.array([float(r[column]) if r[column] else np.nan for r in rows])

def cell(law, speed, rows):
    figures = {c: numbers(rows, c) for c in ("v_rvo_mps", "v_of_mps", "d_max_m", "v_rmin_mps", "delta_s_ms", "eps_m", "t_of_s", "v_hand_mps")}
    figures["commanded_mps"] = figures["v_hand_mps"] # a synthetic hand's own speed
    words = np.array([r["reason"] for r in rows])
    tap = np.array([int(r["tap"]) for r in rows])
    return Cell(law, Speed(speed, {"low": 0.2, "high": 0.4}[speed], 0), words, words, words, words, tap, tap, words, figures)

with open(sys.argv[1], newline="") as f:
    rows = list(csv.DictReader(f))
cells = [cell(law, speed, [r for r in rows if (r["transition"], r["speed"]) == (law, speed)])
         for speed in ("low", "high") for law in ("abrupt", "smooth", "offset", "predictive")]
taps = Taps(cells, [str(k) for k in range(1 + max(int(r["tap"]) for r in rows))])
margins = {"d_max": 0.3, "v_of": 0.02, "v_rmin": 0.02} # mm, m/s
means = {m.name: m for m in paper.means(taps)}
found = paper.claims(taps, margins, 1)
wanted = {"the finger touches before the ring meets the wall": paper.CONTRARY}
if sys.argv[2] == "n":
    # The strategies are NOT alike at low speed, whatever d_max alone says. No finger makes valid taps at both speeds: other
    # fingers at each are compared; whether |v_of| differs more at high speed depends on the seed.
    wanted = {
        "low speed: smooth and offset are alike in d_max, v_of and v_rmin": paper.CONTRARY,
        "high speed: smooth rebounds several times as far": paper.SHOWN,
        "high speed: smooth rebounds much faster": paper.SHOWN,
        "high speed: the ring's speed at the touch is nearer to zero": paper.SHOWN,
        "high speed: in at least 25 % of the taps": paper.SHOWN,
        "the ring is stopped in practice in less than 20 ms": paper.SHOWN,
        "the offset of the wall remains below 3 mm": paper.CONTRARY, # a quarter of the fast taps are deeper
        "high speed: 20 to 30 % of the taps are valid": paper.SHOWN,
        "the finger touches before the ring meets the wall": paper.SHOWN,
    }
    for m in means["Delta_s, low"], means["eps, low"]:
        assert abs(m.average - m.paper) < m.paper_sd, m
    d_max, v_of, _ = found[0].parts
    assert d_max.p < 1e-4 < 0.9999 < v_of.p, f"at low speed d_max alone is alike, v_of isn't: p {d_max.p}, {v_of.p}"
    for part in (found[5].parts[0], found[5].parts[2]):
        assert part.test == "overlap" and part.p < 1e-4, f"rebounds don't differ more at high speed: {part}"
for text, verdict in wanted.items():
    claim = next(c for c in found if c.text.startswith(text))
    assert claim.verdict == verdict, f"{claim.text}: {claim.verdict}, not {verdict}: {claim}"
