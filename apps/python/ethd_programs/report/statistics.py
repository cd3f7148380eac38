"""Statistics of a report: tests within people, effect sizes, equivalence.

A figure that isn't defined is NaN. What is drawn, is drawn from a generator of the report's seed, anew for each figure, so
that the same data give the same figures.
"""
import math
from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special, stats

Numbers = NDArray[np.float64]
NAN = math.nan
#: With fewer people no test is made and no bootstrap interval shown: the smallest two-sided p that the signs of five people
#: can have is 0.0625, and the bootstrap's intervals of 95 % cover far less.
FEWEST_PEOPLE = 6
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
    return Summary(len(values), float(np.mean(values)), sd_of(values), *np.quantile(values, [0, 0.25, 0.5, 0.75, 1]).tolist())


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
    """A sample compared with a published one, whose n, mean and sd are known."""

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
    two-sided level with this probability (noncentral t, of its own sign), and with whom a sign-flip test can be that sure at all; 0: over
    10000."""
    for n in range(max(FEWEST_PEOPLE, math.ceil(1 - math.log2(level / 2) - 1)), 10001):
        t, shift = student(1 - level / 2, n - 1), abs(d_z) * math.sqrt(n)
        if 1 - special.nctdtr(n - 1, shift, t) >= power:  # SciPy 1.15 has NaN for the other tail
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
