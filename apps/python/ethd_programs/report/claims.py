"""The paper's figures and sentences, tested within people: a person has one number of each kind, and its contrasts between
strategies and speeds are what is tested, never the pooled taps."""
import math
from dataclasses import dataclass, field
from typing import Callable, Dict, List, Sequence, Tuple

import numpy as np

from ethd_programs.report.bootstrap import Clusters, Weights, middle_of
from ethd_programs.report.statistics import (FEWEST_PEOPLE, NAN, Interval, Numbers, Published, beside_published,
                                             compare, equivalent, holm, overlapping, t_interval)
from ethd_programs.report.taps import QUANTITIES, Cell, Quantity, Taps

TOO_FEW, SHOWN, OPEN, CONTRARY = "too few people", "shown", "not shown", "the contrary is shown"
_LEVEL = 0.05


# ---- Table 1 ----

NINE = 9  #: taps behind each figure of the paper


@dataclass(frozen=True)
class Mean:
    name: str
    quantity: Quantity
    speed: str
    paper: float
    paper_sd: float
    people: int = 0
    average: float = NAN  #: of people's means
    interval: Interval = Interval()  #: 95 %
    beside: Published = Published()


_TABLE1 = (("Delta_s, low", "delta_s", "low", 3.111, 2.804), ("eps, low", "eps", "low", 0.388, 0.251),
           ("Delta_s, high", "delta_s", "high", 14.556, 1.424), ("eps, high", "eps", "high", 2.434, 0.357))


def means(taps: Taps) -> List[Mean]:
    out = []
    for name, key, speed, paper, sd in _TABLE1:
        quantity, cell = QUANTITIES[key], taps.cell("offset", speed)
        own = taps.by_person(cell, cell.of(quantity) if cell else None, "mean")
        own = own[~np.isnan(own)]
        made = cell is not None and len(own) >= FEWEST_PEOPLE
        out.append(Mean(name, quantity, speed, paper, sd, len(own), float(np.mean(own)) if len(own) else NAN,
                        t_interval(own, 0.95) if len(own) > 2 else Interval(),
                        beside_published(own, cell.values(quantity), NINE, paper, sd) if cell and made else Published()))
    return out


# ---- sentences ----


@dataclass
class Part:
    """A contrast of people's figures that must lie above `low`, below `high`, or between the two where both are finite."""

    what: str
    unit: str
    low: float
    high: float
    people: int = 0
    mean: float = NAN
    interval: Interval = Interval()  #: 95 %
    p: float = NAN  #: by `test`, two-sided but for TOST
    p_shown: float = NAN  #: p where the mean lies within the bounds, else 1
    p_contrary: float = NAN  #: two-sided p that it lies outside where it does, else 1
    d_z: float = NAN  #: of contrasts that are compared with 0
    test: str = ""  #: sign flip, TOST, overlap or bootstrap; "": no test was made
    at_low: int = 0  #: of an overlap: people who have both strategies at this speed
    at_high: int = 0


@dataclass
class Claim:
    """It holds when all its parts do: its p is the largest of theirs. The contrary holds when that of one part does: its p is
    the smallest of theirs by Bonferroni."""

    text: str
    parts: List[Part] = field(default_factory=list)
    p: float = NAN
    holm: float = NAN  #: corrected for all claims that could be tested
    p_contrary: float = NAN
    holm_contrary: float = NAN
    verdict: str = TOO_FEW


_Coefficients = Tuple[float, float, float, float]
_CELLS = (("smooth", "low"), ("offset", "low"), ("smooth", "high"), ("offset", "high"))


@dataclass(frozen=True)
class _Contrast:
    """Weights of the four cells; people who lack one with a weight are left out."""

    what: str
    unit: str
    of: Callable[[Cell], Numbers]
    how: str
    weights: _Coefficients
    low: float = -math.inf
    high: float = math.inf
    margin: str = ""  #: whose margin stands for low and high

    def of_people(self, taps: Taps, cells: Sequence[int] = range(4)) -> Numbers:
        total: Numbers = np.zeros(len(taps.people))
        for k in cells:
            if self.weights[k]:
                cell = taps.cell(*_CELLS[k])
                total = total + self.weights[k] * taps.by_person(cell, self.of(cell) if cell else None, self.how)
        return total

    @property
    def is_interaction(self) -> bool:
        a, b, c, d = self.weights
        return a + b == 0 and c + d == 0 and a != 0 and c != 0 and self.low == 0


def _figure(key: str, size: bool = False) -> Callable[[Cell], Numbers]:
    return lambda cell: np.asarray(np.abs(cell.of(QUANTITIES[key])) if size else cell.of(QUANTITIES[key]), np.float64)


def _with_finger(cell: Cell) -> Numbers:
    v = cell.of(QUANTITIES["v_of"])
    return np.where(np.isnan(v), NAN, 100.0 * (v > 0))


def _is_valid(cell: Cell) -> Numbers:
    return np.where(cell.valid, 100.0, 0.0)


def _alike(key: str, unit: str) -> _Contrast:
    return _Contrast(f"{key}: offset - smooth", unit, _figure(key), "median", (-1, 1, 0, 0), margin=key)


def _more_at_high(words: str, unit: str, of: Callable[[Cell], Numbers]) -> _Contrast:
    return _Contrast(f"{words}: (smooth - offset), high - low", unit, of, "median", (-1, 1, 1, -1), low=0)


_MOST = 90  # %: of a person's taps that keep a limit which the paper calls kept


def _mostly_below(key: str, limit: float, unit: str) -> List[_Contrast]:
    def share(cell: Cell) -> Numbers:
        values = cell.of(QUANTITIES[key])
        return np.where(np.isnan(values), NAN, 100.0 * (values < limit))

    return [_Contrast(f"share of taps with {key} under {limit} {unit}: offset, {speed}", "%", share, "mean", weights, low=_MOST)
            for speed, weights in (("low", (0, 1, 0, 0)), ("high", (0, 0, 0, 1)))]


_SENTENCES: List[Tuple[str, List[_Contrast]]] = [
    ("low speed: smooth and offset are alike in d_max, v_of and v_rmin",
     [_alike("d_max", "mm"), _alike("v_of", "m/s"), _alike("v_rmin", "m/s")]),
    ("high speed: smooth rebounds several times as far as offset (more than 3 times)",
     [_Contrast("d_max: smooth - 3 offset", "mm", _figure("d_max"), "median", (0, 0, 1, -3), low=0)]),
    ("high speed: smooth rebounds much faster than offset (more than twice as fast)",
     [_Contrast("|v_rmin|: smooth - 2 offset", "m/s", _figure("v_rmin", True), "median", (0, 0, 1, -2), low=0)]),
    ("high speed: the ring's speed at the touch is nearer to zero under offset",
     [_Contrast("|v_of|: smooth - offset", "m/s", _figure("v_of", True), "median", (0, 0, 1, -1), low=0)]),
    ("high speed: in at least 25 % of the taps under offset the ring moves with the finger",
     [_Contrast("share of v_of > 0: offset", "%", _with_finger, "mean", (0, 0, 0, 1), low=25)]),
    ("the strategies differ more at high speed than at low, in d_max, |v_of| and |v_rmin|",
     [_more_at_high("d_max", "mm", _figure("d_max")), _more_at_high("|v_of|", "m/s", _figure("v_of", True)),
      _more_at_high("|v_rmin|", "m/s", _figure("v_rmin", True))]),
    ("high speed: 20 to 30 % of the taps are valid, as 10 to 15 taps were needed for three",
     [_Contrast("valid taps: mean of smooth and offset", "%", _is_valid, "mean", (0, 0, 0.5, 0.5), 20, 30)]),
    ("the ring is stopped in practice in less than 20 ms (over 90 % of a person's taps)", _mostly_below("delta_s", 20, "ms")),
    ("the offset of the wall remains below 3 mm (over 90 % of a person's taps)", _mostly_below("eps", 3, "mm")),
]


def _directed(out: Part, p: float, is_inside: bool) -> None:
    """Of a two-sided p that belongs to the side on which the mean lies."""
    out.p, out.p_shown, out.p_contrary = p, p if is_inside else 1.0, 1.0 if is_inside else p


def _judge_overlap(taps: Taps, contrast: _Contrast, out: Part) -> None:
    """A difference of differences that too few people have whole: those who have the strategies' difference at one speed
    alone count, too."""
    o = overlapping(contrast.of_people(taps, (2, 3)), -contrast.of_people(taps, (0, 1)))
    if o.first < FEWEST_PEOPLE or o.second < FEWEST_PEOPLE or math.isnan(o.p):
        return
    out.test, out.people, out.at_low, out.at_high = "overlap", o.first + o.second - o.both, o.second, o.first
    out.mean, out.interval = o.difference, o.interval
    _directed(out, o.p, o.difference > 0)


def _judge(taps: Taps, contrast: _Contrast, margins: Dict[str, float], seed: int) -> Part:
    low, high = contrast.low, contrast.high
    if contrast.margin:
        high = margins[contrast.margin]
        low = -high
    out = Part(contrast.what, contrast.unit, low, high)
    values = contrast.of_people(taps)
    values = values[~np.isnan(values)]
    found = compare(values, seed, with_effect=False)
    out.people, out.mean, out.interval = found.n, found.mean, found.interval
    if found.n < FEWEST_PEOPLE:
        if contrast.is_interaction:
            _judge_overlap(taps, contrast, out)
    elif math.isfinite(low) and math.isfinite(high):
        e = equivalent(values, low, high)
        out.test, out.p, out.p_shown, out.p_contrary = "TOST", e.p, e.p, e.p_outside
    else:
        above = math.isfinite(low)
        shifted = compare(values - low if above else high - values, seed, with_effect=False)
        out.test = "sign flip"
        _directed(out, shifted.p, shifted.mean > 0)
        if low == 0:
            out.d_z = shifted.d_z
    return out


# ---- from which speed on the finger touches before the ring meets the wall ----

_EARLY = 0.4, 0.6  # m/s: the paper says 0.5


def threshold(c: Clusters, weight: Weights) -> Numbers:
    """Of all commanded speeds the one that misjudges the fewest taps when all above it are called early; NaN unless taps of
    both kinds are there. Side 1: early."""
    in_time = np.where(c.side == 0, weight, 0).sum(axis=1)
    step = np.where(c.side == 1, weight, -weight)
    mistakes = np.where(weight > 0, in_time[:, None] + np.cumsum(step, axis=1) - step, np.iinfo(np.int32).max)
    best, rows = np.argmin(mistakes, axis=1), np.arange(len(weight))
    # the threshold stands between this tap and the last one before it that was drawn
    drawn = np.maximum.accumulate(np.where(weight > 0, np.arange(len(c.value)), -1), axis=1)
    before = drawn[rows, np.maximum(best - 1, 0)]
    better = (mistakes[rows, best] < in_time) & (best > 0) & (weight[:, c.side == 1].sum(axis=1) > 0)
    return np.where(better, (c.value[before] + c.value[best]) / 2, NAN)


def _early(taps: Taps, seed: int) -> Claim:
    """People are drawn, then their taps; p is the share of draws on the worse side of the bounds."""
    low, high = _EARLY
    part = Part("commanded speed, threshold", "m/s", low, high)
    speed = np.concatenate([c.figures["commanded_mps"] for c in taps.cells])
    side, person = np.concatenate([c.reason == "early-contact" for c in taps.cells]), np.concatenate([c.person for c in taps.cells])
    there = ~np.isnan(speed)
    clusters = Clusters(speed[there], person[there], side[there].astype(np.int64))
    part.people = clusters.people
    part.mean = clusters.here(threshold) if clusters.people else NAN
    draws = clusters.draws(threshold, seed) if part.people >= FEWEST_PEOPLE and not math.isnan(part.mean) else np.empty(0)
    if len(draws):
        part.test, part.interval = "bootstrap", middle_of(draws)
        below, above = np.count_nonzero(draws < low), np.count_nonzero(draws > high)
        part.p = part.p_shown = (1 + max(below, above)) / (len(draws) + 1)
        part.p_contrary = min(1.0, 2 * (1 + len(draws) - max(below, above)) / (len(draws) + 1))
    return Claim("the finger touches before the ring meets the wall from about 0.5 m/s on", [part])


def claims(taps: Taps, margins: Dict[str, float], seed: int) -> List[Claim]:
    out = [Claim(text, [_judge(taps, c, margins, seed) for c in contrasts]) for text, contrasts in _SENTENCES]
    out.append(_early(taps, seed))
    for claim in out:
        shown, contrary = [x.p_shown for x in claim.parts], [x.p_contrary for x in claim.parts]
        if not any(map(math.isnan, shown)):
            claim.p, claim.p_contrary = max(shown), min(1.0, len(contrary) * min(contrary))
    for claim, claim.holm, claim.holm_contrary in zip(out, holm([c.p for c in out]), holm([c.p_contrary for c in out])):
        if not math.isnan(claim.holm):
            claim.verdict = SHOWN if claim.holm < _LEVEL else CONTRARY if claim.holm_contrary < _LEVEL else OPEN
    return out
