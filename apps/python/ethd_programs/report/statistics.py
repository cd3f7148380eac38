"""Statistics of a report: tests within people, effect sizes, equivalence, a bootstrap of people, the dip.

A figure that isn't defined is NaN. What is drawn, is drawn from a generator of the report's seed, anew for each figure, so
that the same data give the same figures.
"""
import math
from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special, stats

Numbers = NDArray[np.float64]
Weights = NDArray[np.int32]  #: how often each tap counts: a row for each draw, a column for each tap
NAN = math.nan
#: With fewer people no test is made and no bootstrap interval shown: the smallest two-sided p that the signs of five people
#: can have is 0.0625, and the bootstrap's intervals of 95 % cover far less (coverage.py).
FEWEST_PEOPLE = 6
DRAWS, FEW_DRAWS = 2000, 200  #: of a bootstrap; fewer when they would be more than 2e7 taps in all
_EXACT_SIGNS = 16  #: people up to whom all signs are tried
_EXACT_RANKS = 200


@dataclass(frozen=True)
class Interval:
    low: float = NAN
    high: float = NAN


@dataclass(frozen=True)
class Summary:
    """Quantiles are linear between order statistics (Hyndman and Fan's type 7); sd with n - 1."""

    n: int
    mean: float = NAN
    sd: float = NAN
    min: float = NAN
    q1: float = NAN
    median: float = NAN
    q3: float = NAN
    max: float = NAN


def sd_of(values: Numbers) -> float:
    return float(np.std(values, ddof=1)) if len(values) > 1 else NAN


def summarise(values: Numbers) -> Summary:
    if not len(values):
        return Summary(0)
    least, q1, median, q3, most = np.quantile(values, [0, 0.25, 0.5, 0.75, 1])
    return Summary(len(values), float(np.mean(values)), sd_of(values), *map(float, (least, q1, median, q3, most)))


# ---- one number for each person ----


@dataclass(frozen=True)
class Paired:
    """What people's differences say. With fewer than FEWEST_PEOPLE no test is made, and p is NaN."""

    n: int
    positive: int
    mean: float
    sd: float
    median: float
    interval: Interval  #: 95 % of the mean by Student's t, from three people on
    p: float  #: two-sided, by flipping signs
    d_z: float  #: mean/sd (Cohen 1988)
    effect: Interval  #: 95 % of d_z, from the noncentral t (Cumming and Finch 2001)


def sign_flip(differences: Numbers, seed: int) -> float:
    """Fisher's test (1935): of all ways to flip the signs of the differences, the share whose sum is at least as far from
    zero. Beyond 16 people signs are drawn, fewer for many people."""
    n = len(differences)
    if not n:
        return NAN
    # sums that are equal but for rounding count as equal
    here = abs(float(differences.sum())) - 1e-12 * float(np.abs(differences).sum())
    if n <= _EXACT_SIGNS:
        sums = np.zeros(1)
        for d in differences:
            sums = np.concatenate((sums - d, sums + d))
        return float(np.mean(np.abs(sums) >= here))
    rng, as_far, left = np.random.default_rng(seed), 0, int(min(20000, max(2000, 4e7 / n)))
    count = left
    while left:
        rows = min(left, 1 + 2_000_000 // n)  # a piece at a time, for the memory
        bits = np.unpackbits(rng.integers(256, size=(rows, (n + 7) // 8), dtype=np.uint8), axis=1, count=n)
        as_far += int(np.count_nonzero(np.abs((2.0 * bits - 1) @ differences) >= here))
        left -= rows
    return (as_far + 1) / (count + 1)


def _shift(t: float, freedom: int, p: float) -> float:
    """The noncentrality at which a share p of the noncentral t lies below t. Far from it SciPy's distribution may be NaN, so
    the bracket grows from an approximation."""

    def above(shift: float) -> float:
        with np.errstate(invalid="ignore", divide="ignore"):
            return float(stats.nct.cdf(t, freedom, shift)) - p

    spread_of = math.sqrt(1 + t * t / (2 * freedom))
    low = high = t - float(special.ndtri(p)) * spread_of
    while not above(low) > 0:
        low -= 0.1 * spread_of
    while not above(high) < 0:
        high += 0.1 * spread_of
    return float(optimize.brentq(above, low, high, xtol=1e-12))


def _effect(d_z: float, n: int) -> Interval:
    if n < 3 or not math.isfinite(d_z):
        return Interval()
    root = math.sqrt(n)
    return Interval(*(_shift(d_z * root, n - 1, p) / root for p in (0.975, 0.025)))


def student(p: float, freedom: float) -> float:
    """The t below which a share p > 0.5 of Student's t lies; SciPy's stdtrit has but nine digits in some versions."""
    return math.sqrt(freedom * (1 / float(special.betaincinv(freedom / 2, 0.5, 2 * (1 - p))) - 1))


def t_interval(values: Numbers, level: float) -> Interval:
    n = len(values)
    if n < 2:
        return Interval()
    reach = student((1 + level) / 2, n - 1) * sd_of(values) / math.sqrt(n)
    return Interval(float(np.mean(values)) - reach, float(np.mean(values)) + reach)


def compare(differences: Numbers, seed: int, with_effect: bool = True) -> Paired:
    s = summarise(differences)
    d_z = s.mean / s.sd if s.sd > 0 else NAN
    return Paired(s.n, int(np.count_nonzero(differences > 0)), s.mean, s.sd, s.median,
                  t_interval(differences, 0.95) if s.n > 2 else Interval(),
                  sign_flip(differences, seed) if s.n >= FEWEST_PEOPLE else NAN, d_z,
                  _effect(d_z, s.n) if with_effect else Interval())


@dataclass(frozen=True)
class Equivalence:
    p: float = NAN  #: the larger p of the two tests, small when the mean lies within; NaN with fewer than two people
    p_outside: float = NAN  #: two-sided p of the mean against the nearest margin where it lies outside of both, else 1
    interval: Interval = Interval()  #: 90 % of the mean, which lies within the margins when p < 0.05


def equivalent(values: Numbers, low: float, high: float) -> Equivalence:
    """Schuirmann (1987): two one-sided t tests that the mean lies in (low, high)."""
    n = len(values)
    if n < 2:
        return Equivalence()
    mean, error = float(np.mean(values)), sd_of(values) / math.sqrt(n)
    distance = min(mean - low, high - mean)
    # differences without spread have no error: the mean is clearly inside the margin or clearly outside
    t = distance / error if error > 0 else math.copysign(math.inf, distance if distance else -1)
    return Equivalence(float(special.stdtr(n - 1, -t)), min(1.0, 2 * float(special.stdtr(n - 1, t))), t_interval(values, 0.9))


@dataclass(frozen=True)
class Published:
    """A sample beside a published one, of which n, mean and sd are known."""

    difference: float = NAN  #: of the means, less the published one
    interval: Interval = Interval()  #: 95 %
    p_mean: float = NAN  #: Welch's t test, two-sided
    p_sd: float = NAN  #: F test of the variances, two-sided


def beside_published(people: Numbers, taps: Numbers, n: int, mean: float, sd: float) -> Published:
    """people: one mean of each person, whose spread says how sure their mean is; taps: all taps, whose sd is compared."""
    if len(people) < 2:
        return Published()
    difference, own, other = float(np.mean(people)) - mean, sd_of(people) ** 2 / len(people), sd**2 / n
    freedom = (own + other) ** 2 / (own**2 / (len(people) - 1) + other**2 / (n - 1))
    reach = student(0.975, freedom) * math.sqrt(own + other)
    ratio = (sd_of(taps) / sd) ** 2
    below = float(special.fdtr(len(taps) - 1, n - 1, ratio))
    return Published(difference, Interval(difference - reach, difference + reach),
                     2 * float(special.stdtr(freedom, -abs(difference) / math.sqrt(own + other))), 2 * min(below, 1 - below))


@dataclass(frozen=True)
class Overlap:
    first: int  #: people in each sample, and in both
    second: int
    both: int
    difference: float = NAN  #: mean of the first minus mean of the second
    interval: Interval = Interval()
    p: float = NAN


def overlapping(first: Numbers, second: Numbers) -> Overlap:
    """Compares two means where some people are in both samples and some in one alone (Derrick, Russ, Toher and White 2017,
    with unequal variances). NaN says that the person isn't in that sample. It is the paired t test if everybody is in both,
    and Welch's if nobody is. Who is missing must not depend on the values."""
    a, b, whole = first[~np.isnan(first)], second[~np.isnan(second)], ~np.isnan(first + second)
    n, m, both = len(a), len(b), int(np.count_nonzero(whole))
    if n < 2 or m < 2:
        return Overlap(n, m, both)
    difference, va, vb = float(np.mean(a) - np.mean(b)), float(np.var(a, ddof=1)) / n, float(np.var(b, ddof=1)) / m
    x, y = first[whole], second[whole]
    # with fewer than three people in both, or without spread, nothing is known about the correlation
    known = both > 2 and np.ptp(x) > 0 and np.ptp(y) > 0
    shared = 2 * float(np.corrcoef(x, y)[0, 1]) * math.sqrt(va * vb) * both / math.sqrt(n * m) if known else 0.0
    error = math.sqrt(max(0.0, va + vb - shared))
    if not error > 0:
        return Overlap(n, m, both, difference)
    welch = (va + vb) ** 2 / (va**2 / (n - 1) + vb**2 / (m - 1))
    freedom = (both - 1) + (welch - both + 1) / (n + m) * (n + m - 2 * both)
    reach = student(0.975, freedom) * error
    return Overlap(n, m, both, difference, Interval(difference - reach, difference + reach),
                   2 * float(special.stdtr(freedom, -abs(difference) / error)))


def holm(p: Sequence[float]) -> List[float]:
    """Holm's correction (1979). NaN stands for a test that wasn't made."""
    out, least = list(p), 0.0
    made = sorted((i for i, value in enumerate(p) if not math.isnan(value)), key=lambda i: p[i])
    for k, i in enumerate(made):
        least = max(least, min(1.0, p[i] * (len(made) - k)))
        out[i] = least
    return out


def people_needed(d_z: float, level: float, power: float = 0.8) -> int:
    """The smallest number of people with whom a paired t test finds a mean difference of d_z standard deviations at this
    two-sided level with this probability (noncentral t), and with whom a sign-flip test can be that sure at all; 0: over
    10000."""
    for n in range(max(FEWEST_PEOPLE, math.ceil(1 - math.log2(level / 2) - 1)), 10001):
        t, shift = student(1 - level / 2, n - 1), abs(d_z) * math.sqrt(n)
        if 1 - special.nctdtr(n - 1, shift, t) + special.nctdtr(n - 1, shift, -t) >= power:
            return n
    return 0


# ---- ranks ----


def wilcoxon(differences: Numbers) -> Tuple[float, float]:
    """(W, two-sided p) of Wilcoxon's signed rank test. Zeros take part in the ranking (Pratt 1959), and equal sizes share
    their mean rank. Exact up to 200 people, with ties too, which SciPy's isn't; p is NaN where all are zero."""
    ranks = stats.rankdata(np.abs(differences))
    above, below = float(ranks[differences > 0].sum()), float(ranks[differences < 0].sum())
    used = ranks[differences != 0]
    if not len(used):
        return min(above, below), NAN
    if len(used) > _EXACT_RANKS:
        z = -abs(above - used.sum() / 2) / math.sqrt(float((used**2).sum()) / 4)
        return min(above, below), min(1.0, 2 * float(special.ndtr(z)))
    share: Numbers = np.ones(1)  # of all signs, by the sum of the ranks that are above, doubled: a whole number
    for step in np.rint(2 * used).astype(int):
        share = (np.pad(share, (0, step)) + np.pad(share, (step, 0))) / 2
    at = round(2 * above)
    return min(above, below), min(1.0, 2 * float(min(share[: at + 1].sum(), share[at:].sum())))


def friedman(rows: Numbers) -> Tuple[float, float]:
    """(chi square with the correction for ties, p) of Friedman's test: a row is a person, a column a condition."""
    if len(rows) < 2 or not np.any(np.ptp(rows, axis=1)):
        return NAN, NAN
    found = stats.friedmanchisquare(*rows.T)
    return float(found.statistic), float(found.pvalue)


# ---- a bootstrap of people, then of their taps ----


class Clusters:
    """Taps of one sample or of two (side 0 and 1), which the same people made. People are drawn with replacement, then taps
    of each person, since taps of one person are not independent (Davison and Hinkley 1997, 3.8)."""

    def __init__(self, value: Numbers, person: NDArray[np.int64], side: NDArray[np.int64]):
        order = np.lexsort((side, person, value))
        self.value, self.side = value[order], side[order]
        people, self._person = np.unique(person[order], return_inverse=True)
        self.people = len(people)

    def here(self, figure: "Figure") -> float:
        """The figure of the taps themselves."""
        return float(figure(self, np.ones((1, len(self.value)), np.int32))[0])

    def draws(self, figure: "Figure", seed: int) -> Numbers:
        """The figures of many draws; those that aren't defined are left out."""
        n = len(self.value)
        if not n:
            return np.empty(0)
        rng, count = np.random.default_rng(seed), int(min(DRAWS, max(FEW_DRAWS, 2e7 / (n + 1))))
        rows = 1 + 300_000 // n  # a piece at a time, for the cache
        pieces = [figure(self, self._weights(rng, min(rows, count - k))) for k in range(0, count, rows)]
        found = np.concatenate(pieces)
        defined: Numbers = found[~np.isnan(found)]
        return defined

    def _weights(self, rng: np.random.Generator, count: int) -> Weights:
        """How often each tap is drawn: a person's taps of a side as often as the person, times their number."""
        who = rng.integers(self.people, size=(count, self.people)) + self.people * np.arange(count)[:, None]
        times = np.bincount(who.ravel(), minlength=count * self.people).reshape(count, self.people)
        weight = np.empty((count, len(self.value)), np.int32)
        group, members = np.unique(2 * self._person + self.side, return_inverse=True)
        sizes = np.bincount(members)
        by_group = np.argsort(members, kind="stable")
        first = np.cumsum(sizes) - sizes
        for size in np.unique(sizes):
            chosen = np.flatnonzero(sizes == size)
            taps = by_group[first[chosen][:, None] + np.arange(size)]
            drawn = times[:, group[chosen] // 2]
            weight[:, taps.ravel()] = (drawn if size == 1 else rng.multinomial(drawn * size, np.full(size, 1 / size))).reshape(count, -1)
        return weight

    def interval(self, figure: "Figure", seed: int, fewest: int = FEWEST_PEOPLE) -> Interval:
        """The 95 % percentile interval of the draws; none with fewer people."""
        draws = self.draws(figure, seed) if self.people >= fewest else np.empty(0)
        return Interval(*map(float, np.quantile(draws, [0.025, 0.975]))) if len(draws) else Interval()


#: A figure of the taps, for each draw.
Figure = Callable[[Clusters, Weights], Numbers]


def median(c: Clusters, weight: Weights) -> Numbers:
    """Of all taps; both sides are one sample."""
    twice = 2 * np.cumsum(weight, axis=1)
    total = twice[:, -1:] // 2
    lower, upper = (twice < total).sum(axis=1), (twice <= total).sum(axis=1)
    return np.asarray((c.value[lower] + c.value[upper]) / 2)


def cliff(c: Clusters, weight: Weights) -> Numbers:
    """Cliff's delta (1993): the share of pairs in which side 1 is larger, minus the share in which it is smaller."""
    starts = np.flatnonzero(np.concatenate(([True], np.diff(c.value) != 0)))
    a, b = (np.add.reduceat(np.where(c.side == side, weight, 0), starts, axis=1).astype(float) for side in (0, 1))
    below_a, below_b = np.cumsum(a, axis=1) - a, np.cumsum(b, axis=1) - b
    with np.errstate(invalid="ignore"):
        return np.asarray((b * below_a - a * below_b).sum(axis=1) / (a.sum(axis=1) * b.sum(axis=1)))


# ---- one heap, or several? ----

_SHARES = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995,
           0.9999)
#: By the number of values: quantiles of the dip times the root of that number, of 200 000 uniform samples each; a uniform
#: sample is the least favourable one with a single heap. tests/python/test_report.py draws some again.
_DIPS = {
    8: (0.1768, 0.2090, 0.2319, 0.2610, 0.2819, 0.2989, 0.3139, 0.3278, 0.3410, 0.3547, 0.3758, 0.4006, 0.4194,
        0.4351, 0.4558, 0.4697, 0.4897, 0.5059, 0.5271, 0.5519, 0.5725, 0.6073),
    9: (0.1846, 0.2202, 0.2414, 0.2672, 0.2853, 0.2999, 0.3125, 0.3241, 0.3379, 0.3691, 0.3877, 0.4099, 0.4265,
        0.4404, 0.4589, 0.4721, 0.4941, 0.5185, 0.5477, 0.5652, 0.5823, 0.6032),
    10: (0.1934, 0.2276, 0.2467, 0.2699, 0.2857, 0.2984, 0.3093, 0.3233, 0.3476, 0.3755, 0.3920, 0.4121, 0.4276,
         0.4407, 0.4606, 0.4771, 0.5052, 0.5289, 0.5546, 0.5725, 0.5874, 0.6180),
    12: (0.2045, 0.2348, 0.2510, 0.2695, 0.2821, 0.2956, 0.3153, 0.3354, 0.3568, 0.3814, 0.3966, 0.4159, 0.4330,
         0.4499, 0.4721, 0.4882, 0.5129, 0.5352, 0.5629, 0.5865, 0.6066, 0.6482),
    15: (0.2114, 0.2362, 0.2486, 0.2679, 0.2886, 0.3066, 0.3238, 0.3414, 0.3608, 0.3860, 0.4041, 0.4264, 0.4439,
         0.4592, 0.4815, 0.4989, 0.5272, 0.5524, 0.5826, 0.6016, 0.6216, 0.6611),
    20: (0.2121, 0.2363, 0.2543, 0.2776, 0.2951, 0.3113, 0.3279, 0.3471, 0.3686, 0.3951, 0.4123, 0.4351, 0.4538,
         0.4705, 0.4944, 0.5118, 0.5402, 0.5687, 0.6018, 0.6245, 0.6499, 0.6895),
    30: (0.2168, 0.2436, 0.2597, 0.2831, 0.3020, 0.3194, 0.3365, 0.3555, 0.3774, 0.4049, 0.4231, 0.4465, 0.4656,
         0.4829, 0.5084, 0.5269, 0.5563, 0.5827, 0.6148, 0.6406, 0.6619, 0.7080),
    50: (0.2218, 0.2494, 0.2666, 0.2904, 0.3094, 0.3273, 0.3454, 0.3650, 0.3874, 0.4155, 0.4341, 0.4586, 0.4789,
         0.4973, 0.5232, 0.5427, 0.5738, 0.6041, 0.6415, 0.6669, 0.6910, 0.7514),
    100: (0.2283, 0.2565, 0.2740, 0.2981, 0.3176, 0.3360, 0.3547, 0.3747, 0.3980, 0.4270, 0.4461, 0.4712, 0.4921,
          0.5108, 0.5373, 0.5562, 0.5884, 0.6195, 0.6580, 0.6852, 0.7113, 0.7813),
    200: (0.2340, 0.2622, 0.2798, 0.3043, 0.3240, 0.3428, 0.3617, 0.3822, 0.4057, 0.4358, 0.4553, 0.4807, 0.5019,
          0.5211, 0.5488, 0.5693, 0.6028, 0.6326, 0.6700, 0.7005, 0.7290, 0.8002),
}


def _bends(x: List[float], low: int, high: int, side: int) -> NDArray[np.int64]:
    """Where the greatest convex minorant of the points (x[i], i) bends, or with side -1 the least concave majorant."""
    out: List[int] = []
    for i in range(low, high + 1):
        while len(out) > 1:
            a, b = out[-2], out[-1]
            if side * ((x[b] - x[a]) * (i - a) - (x[i] - x[a]) * (b - a)) > 0:
                break
            out.pop()
        out.append(i)
    return np.array(out)


def _heights(x: Numbers, hull: NDArray[np.int64], low: int, high: int) -> Numbers:
    """Of the hull at each value from low to high, in counts."""
    at = np.arange(low, high + 1)
    piece = np.minimum(np.searchsorted(hull, at, "right") - 1, len(hull) - 2)
    a, b = hull[piece], hull[piece + 1]
    wide = x[b] > x[a]
    return np.asarray(a + np.where(wide, (b - a) * (x[at] - x[a]) / np.where(wide, x[b] - x[a], 1), 0))


def dip(values: Numbers) -> float:
    """Hartigan's dip (Hartigan and Hartigan 1985): the largest distance between the distribution function of the sorted
    values and the nearest one with a single mode. It is at least 1/(2 n).

    The mode lies between two values, which close in on it step by step. Before them the nearest unimodal function is the
    greatest convex minorant, behind them the least concave majorant. Counts of values stand for probabilities: in units of
    1/n, the sample's distribution function is i just before value i and i + 1 from value i on."""
    x, n = values.tolist(), len(values)
    if not n:
        return NAN
    low, high, most = 0, n - 1, 1.0
    while x[high] > x[low]:
        under, over = _bends(x, low, high, 1), _bends(x, low, high, -1)
        below, above = _heights(values, under, low, high), _heights(values, over, low, high)
        # both are furthest apart at a bend of one of them
        ends = over[np.minimum(np.searchsorted(over, under, "right"), len(over) - 1)]
        begins = under[np.minimum(np.searchsorted(under, over, "right") - 1, len(under) - 2)]
        sizes = np.concatenate((above[under - low] + 1 - under, over + 1 - below[over - low]))
        widest = int(np.argmax(sizes))
        left, right = np.concatenate((under, begins))[widest], np.concatenate((ends, over))[widest]
        if sizes[widest] <= most:
            break
        step = np.arange(low, high + 1)
        most = max(most, (step + 1 - below)[: left - low + 1].max(), (above + 1 - step)[right - low :].max())
        if left == low and right == high:
            break
        low, high = int(left), int(right)
    return float(most) / (2 * n)


def dip_share(found: float, n: int) -> float:
    """The share of uniform samples of this size whose dip is larger, at least 0.0001; beyond 200 values the root of the size
    scales the dip. NaN with fewer than eight values."""
    sizes = list(_DIPS)
    if n < sizes[0] or math.isnan(found):
        return NAN
    table = np.array(list(_DIPS.values()))
    quantiles = [float(np.interp(n, sizes, column)) for column in table.T]
    return float(np.interp(found * math.sqrt(n), [0.5 / math.sqrt(min(n, sizes[-1])), *quantiles, 2 * quantiles[-1]], [1, *(1 - np.array(_SHARES)), 1e-4]))


def spread(values: Numbers, grain: float) -> Numbers:
    """Sorts the values and spreads equal ones evenly over `grain`, the step in which they were measured, because equal values
    look like modes of their own."""
    x = np.sort(values)
    i = 0
    while i < len(x):
        j = int(np.searchsorted(x, x[i] + grain / 4, "right"))
        x[i:j] = x[i] + grain * ((np.arange(j - i) + 0.5) / (j - i) - 0.5)
        i = j
    return x
