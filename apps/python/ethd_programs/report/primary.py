"""The outcomes that a study file declares as primary: tested as one family, and how many people they need."""
from typing import List, Optional, Tuple

from ethd_programs.cli import plural
from ethd_programs.report.comparisons import PAIRED, corrected, print_tests, test_row, within
from ethd_programs.report.report import Report
from ethd_programs.report.statistics import people_needed
from ethd_programs.report.taps import QUANTITIES, Cell, Quantity, Taps

_LEVEL, _POWER = 0.05, 0.8


def _outcome(word: str, taps: Taps) -> Optional[Tuple[Quantity, Cell, Cell]]:
    """FIGURE:A-B:SPEED as (figure, B, A), which is tested as A - B. None: a cell has no taps."""
    figure, pair, speed = word.split(":")
    return next(((QUANTITIES[figure], b, a) for a in taps.cells for b in taps.cells
                 if a.speed.word == b.speed.word == speed and f"{a.law}-{b.law}" == pair), None)


def primary(r: Report) -> None:
    words = r.folder.facts["primary"]
    if not words:
        return
    r.page.heading("primary", "Primary outcomes")
    tests = [within(r, *outcome) if outcome else None for outcome in (_outcome(word, r.taps) for word in words)]
    missing = [word for word, test in zip(words, tests) if not test]
    r.page.put("<p>The study file declares %d primary outcome%s before the first tap; its hash, below, covers them. All other tests of this page "
               "are exploratory.%s</p>\n<p>Exclusions that it declares: %s.</p>\n", len(words), plural(len(words)),
               f" No taps are there yet for: {', '.join(missing)}." if missing else "", r.folder.facts["exclusions"] or "none")
    made = corrected(tests)
    print_tests(r, made, "Differences of participants' medians. Family of Holm's correction: the primary outcomes", "difference", True)
    r.output.table("primary.csv", PAIRED, map(test_row, made))


def print_power(name: str, words: List[str], taps: Taps) -> None:
    level = _LEVEL / len(words)
    print(f"{name}: {len(taps.people)} participant{plural(len(taps.people))}. How many show each primary outcome with a probability of {100 * _POWER:.0f} % "
          f"(two-sided p under {level:.4g},\nwhich is 0.05 for {len(words)} outcome{plural(len(words))} together; paired t test of participants' medians), if people "
          "differ as these do:\n\noutcome                            unit  with both        mean          sd     d_z  participants")
    for word in words:
        outcome = _outcome(word, taps)
        values = taps.medians(outcome[2], outcome[0]) - taps.medians(outcome[1], outcome[0]) if outcome else None
        values = None if values is None else values[values == values]
        if outcome is None or values is None or len(values) < 2 or not values.std() > 0:
            print(f"{word:33}  too few participants have both, or they do not differ")
            continue
        mean, sd = float(values.mean()), float(values.std(ddof=1))
        n = people_needed(mean / sd, level, _POWER)
        print(f"{word:33}  {outcome[0].unit:>4}  {len(values):9}  {mean:10.4g}  {sd:10.4g}  {mean / sd:6.2f}  {n or 'over 10000':>12}")
