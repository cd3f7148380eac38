"""A bootstrap of people, then of their taps: figures of many draws, and their intervals."""
from typing import Callable

import numpy as np
from numpy.typing import NDArray

from ethd_programs.report.statistics import FEWEST_PEOPLE, Interval, Numbers

Weights = NDArray[np.int32]  #: how often each tap counts: a row for each draw, a column for each tap
DRAWS, FEW_DRAWS = 2000, 200  #: of a bootstrap; fewer when they would be more than 2e7 taps in all


def middle_of(draws: Numbers) -> Interval:
    """Where 95 % of the draws lie."""
    return Interval(*map(float, np.quantile(draws, [0.025, 0.975]))) if len(draws) else Interval()


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
        return middle_of(draws)


#: A figure of the taps, for each draw.
Figure = Callable[[Clusters, Weights], Numbers]


def median(c: Clusters, weight: Weights) -> Numbers:
    """Of all taps; both sides are one sample."""
    twice = 2 * np.cumsum(weight, axis=1)
    total = twice[:, -1:] // 2
    lower, upper = (twice < total).sum(axis=1), (twice <= total).sum(axis=1)
    return np.asarray((c.value[lower] + c.value[upper]) / 2)


def cliff(c: Clusters, weight: Weights) -> Numbers:
    """Cliff's delta (1993): the share of pairs with a larger value on side 1, minus the share with a smaller one."""
    starts = np.flatnonzero(np.concatenate(([True], np.diff(c.value) != 0)))
    a, b = (np.add.reduceat(np.where(c.side == side, weight, 0), starts, axis=1).astype(float) for side in (0, 1))
    below_a, below_b = np.cumsum(a, axis=1) - a, np.cumsum(b, axis=1) - b
    with np.errstate(invalid="ignore"):
        return np.asarray((b * below_a - a * below_b).sum(axis=1) / (a.sum(axis=1) * b.sum(axis=1)))
