"""How often the intervals of a report hold the truth, found by simulating studies whose truth is known."""
import math
from dataclasses import dataclass

import numpy as np

from ethd_programs.report.statistics import Clusters, Interval, Numbers, cliff, compare, median

TAPS = 3  #: of each person in each cell, as in the paper
_MOVE = 1.0  # by which the strategy shifts the mean
_ANSWER = 0.5  # standard deviation, between people, of that shift


@dataclass(frozen=True)
class Coverage:
    """Shares of simulated studies whose 95 % interval holds the truth."""

    people: int
    median: float  #: these two by a bootstrap of people, then of taps
    cliff: float
    mean: float  #: Student's t of people's differences
    effect: float  #: d_z from the noncentral t


# What a long run found; tests/README.md has its command.
_KNOWN = (Coverage(3, 0.872, 0.911, 0.951, 0.948), Coverage(6, 0.946, 0.960, 0.954, 0.955),
          Coverage(12, 0.958, 0.977, 0.955, 0.953), Coverage(24, 0.967, 0.980, 0.956, 0.948))


def known(people: int) -> Coverage:
    """What was found for the largest number of people that is at most this one; for three if there are fewer."""
    return next((c for c in reversed(_KNOWN) if c.people <= people), _KNOWN[0])


def simulate(people: int, runs: int, seed: int) -> Coverage:
    """People, their responses to the strategy and their taps are normal with standard deviations 1, 0.5 and 1; the strategy
    shifts the mean by 1. The intervals of median and Cliff's delta stay valid when any increasing function stretches the
    values; the other two need differences that are about normal."""
    # the median of three standard normal numbers has the variance 1 - sqrt(3)/pi
    d_z = _MOVE / math.sqrt(_ANSWER**2 + 2 * (1 - math.sqrt(3) / math.pi))
    delta = math.erf(_MOVE / math.sqrt(4 + _ANSWER**2) / math.sqrt(2))
    person = np.repeat(np.arange(people), TAPS)
    hits = np.zeros(4)
    for run in range(runs):
        rng = np.random.default_rng((seed, run))
        own, moved = rng.normal(size=people), _MOVE + _ANSWER * rng.normal(size=people)
        taps: Numbers = own[:, None] + rng.normal(size=(2, people, TAPS))
        taps[1] += moved[:, None]
        draws = seed + 1 + run
        both = Clusters(taps.ravel(), np.tile(person, 2), np.repeat([0, 1], people * TAPS))
        found = compare(np.median(taps[1], axis=1) - np.median(taps[0], axis=1), seed)
        intervals = (Clusters(taps[0].ravel(), person, 0 * person).interval(median, draws, 2), both.interval(cliff, draws, 2),
                     found.interval, found.effect)
        hits += [_holds(interval, truth) for interval, truth in zip(intervals, (0.0, delta, _MOVE, d_z))]
    return Coverage(people, *(float(h) / runs for h in hits))


def _holds(interval: Interval, truth: float) -> bool:
    return interval.low <= truth <= interval.high
