"""Sections of a report that test: Table 1, the paper's sentences, strategies within people, strategy by speed."""
import math
from dataclasses import dataclass
from itertools import combinations
from typing import List, Optional, Sequence, Tuple

import numpy as np

from ethd_programs.cli import plural
from ethd_programs.report import claims as paper
from ethd_programs.report.bootstrap import Clusters, cliff
from ethd_programs.report.output import Cell as Text
from ethd_programs.report.output import harmless
from ethd_programs.report.page import interval_text, mean_text, number_text, p_text
from ethd_programs.report.report import CAVEATS, Report
from ethd_programs.report.statistics import (FEWEST_PEOPLE, NAN, Equivalence, Interval, Paired, Summary, compare,
                                             equivalent, holm, summarise)
from ethd_programs.report.taps import QUANTITIES, Cell, Quantity, Taps

# ---- Table 1 ----


def _of_offset(taps: Optional[Taps], mean: paper.Mean) -> Summary:
    cell = taps.cell("offset", mean.speed) if taps else None
    return summarise(cell.values(mean.quantity)) if cell else Summary(0)


def table1(r: Report) -> None:
    if not any(r.taps.cell("offset", speed) for speed in ("low", "high")):
        return
    r.page.heading("table1", "Table 1 of the paper")
    if not r.measured or r.beside:
        r.page.put("<p>The simulated device and finger were <b>fitted to the four means of this table</b>, not measured: agreement proves "
                   "nothing.</p>\n")
    if r.folder.facts["valid_by_finger"]:
        r.page.put("<p>Taps of this study are valid by the hand's speed, those of the paper by the ring's: they aren't the same taps.</p>\n")
    r.page.put("<p>The last columns compare the people of %s with the paper's nine taps: the mean of people's means minus the paper's (Welch's t "
               "test), and the standard deviation of all taps over the paper's (F test, as if all taps were independent). A small p speaks "
               "against agreement; a large one shows none.</p>\n", r.judged_name)
    beside = ("beside", "n") if r.beside else ()
    r.page.table("Table 1: mean (sample standard deviation) of all valid taps, n; then the mean of people's means",
                 ("offset", "paper, n = 9", "this study", "n", *beside, "people's mean, 95 %", "minus the paper's, 95 %", "p", "sd / paper's", "p"), 1)
    rows: List[List[Text]] = []
    for m in paper.means(r.judged):
        q, study, other, judged = m.quantity, _of_offset(r.taps, m), _of_offset(r.beside, m), _of_offset(r.judged, m)
        low, high, found = m.interval.low, m.interval.high, m.beside
        average = f"{m.average:.{q.digits}f} ({interval_text(low, high, q.digits)})"
        less = f"{number_text(found.difference, q.digits)} ({interval_text(found.interval.low, found.interval.high, q.digits)})"
        also = (mean_text(other.n, other.mean, other.sd, q.digits), str(other.n)) if r.beside else ()
        r.page.row(f"{m.name} ({q.unit})", f"{m.paper:.3f} ({m.paper_sd:.3f})", mean_text(study.n, study.mean, study.sd, q.digits), str(study.n),
                   *also, average, less, p_text(found.p_mean), number_text(judged.sd / m.paper_sd, 2), p_text(found.p_sd))
        rows.append([q.key, q.unit, m.speed, m.paper, m.paper_sd, study.mean, study.sd, study.n, other.mean, other.sd,
                     other.n if r.beside else None, m.average, m.people, low, high, found.difference, found.interval.low, found.interval.high,
                     found.p_mean, judged.sd / m.paper_sd, found.p_sd])
    r.page.end_table()
    r.output.table("table1.csv", "metric,unit,speed,paper_mean,paper_sd,study_mean,study_sd,study_n,beside_mean,beside_sd,beside_n,people_mean,"
                   "people,people_low,people_high,difference,difference_low,difference_high,p_mean,sd_ratio,p_sd", rows)


# ---- the paper's sentences ----


def _bounds(part: paper.Part) -> str:
    if math.isinf(part.high):
        return f"above {part.low:g} {part.unit}"
    return f"below {part.high:g} {part.unit}" if math.isinf(part.low) else f"{part.low:g} to {part.high:g} {part.unit}"


def _print_part(r: Report, part: paper.Part) -> None:
    both = part.at_low + part.at_high - part.people
    n = f"{part.people} (low {part.at_low}, high {part.at_high}, both {both})" if part.at_low else str(part.people)
    most = 100.0 if part.unit == "%" else math.inf  # a t interval of shares knows no bound
    low, high = max(part.interval.low, -most), min(part.interval.high, most)
    r.page.row(part.what, _bounds(part), part.test or "-", n, number_text(part.mean, 3), interval_text(low, high, 3),
               number_text(part.d_z, 2), p_text(part.p))


def _part_row(number: int, claim: paper.Claim, part: paper.Part) -> List[Text]:
    bounds = (None if math.isinf(b) else b for b in (part.low, part.high))
    return [number, harmless(claim.text), harmless(part.what), harmless(part.unit), *bounds, part.people, part.mean, part.interval.low,
            part.interval.high, part.d_z, part.p, claim.p, claim.holm, claim.p_contrary, claim.holm_contrary, claim.verdict, part.test,
            part.at_low or None, part.at_high or None]


def _outcome(r: Report, found: Sequence[paper.Claim]) -> str:
    r.verdicts.update(c.verdict for c in found)
    counts = [f"{'of ' if verdict == paper.CONTRARY else ''}{r.verdicts[verdict]} {verdict}"
              for verdict in (paper.SHOWN, paper.CONTRARY, paper.OPEN, paper.TOO_FEW) if r.verdicts[verdict]]
    return ", ".join(counts)


def claims(r: Report) -> None:
    if not any(r.judged.cell("offset", speed) for speed in ("low", "high")):
        return
    people, m = len(r.judged.people), r.margins
    found = paper.claims(r.judged, m, r.seed)
    r.page.heading("claims", "The paper's sentences")
    r.page.put("<p>Judged by the taps of %s, %d participant%s. A sentence is shown only if each of its parts is: its p is the largest p of the parts, "
               "corrected by Holm for all sentences of this table. The contrary of a sentence is shown if the contrary of one part is: its p is "
               "the smallest p of the parts times their number, corrected by Holm in the same way. &quot;Not shown&quot; says neither. "
               "Smooth and offset are alike when their difference lies within &#177;%g mm (d_max) and &#177;%g and &#177;%g m/s (v_of, v_rmin): "
               "margins of the study file.</p>\n", r.judged_name, people, plural(people), *m.values())
    r.page.put("<p>Tests: <em>sign flip</em>, the exact permutation test of people's contrasts; <em>TOST</em>, two one-sided t tests; "
               "<em>bootstrap</em> of people and their taps, for the threshold; <em>overlap</em>, where fewer than six people have a valid tap in "
               "all four cells: the strategies' differences of all people who have one at high speed are compared with those of all who have one "
               "at low speed, by a t test that takes into account who is in both (Derrick and others 2017). It assumes that missing taps are "
               "unrelated to the difference.</p>\n"
               "<p>The threshold is the hand's voluntary speed that best separates the taps that touch early from the others, "
               "of all strategies together; a hand is seldom as fast as it was asked to be. Limits of braking time and offset are judged by "
               "the share of a person's valid taps that keep them. The share of valid taps is the mean of the people's shares; the table of valid taps pools all taps, so that those who needed many weigh more there.</p>\n")
    r.page.put('<p class="note">%s</p>\n', CAVEATS["simulated"] if r.beside else r.caveat)
    r.page.put("<p>Of %d sentences: %s.</p>\n", len(found), _outcome(r, found))
    r.page.table("Sentences of the paper; n, mean and interval of people's contrasts",
                 ("tested within people", "must be", "test", "n", "mean", "95 %", "d_z", "p"), 3)
    rows: List[List[Text]] = []
    for number, claim in enumerate(found, 1):
        corrected = claim.holm_contrary if claim.verdict == paper.CONTRARY else claim.holm
        p = "" if math.isnan(corrected) else f"; by Holm p {'' if corrected < 1e-4 else '= '}{p_text(corrected)}"
        r.page.span(f"{claim.text}: {claim.verdict}{p}", 8)
        for part in claim.parts:
            _print_part(r, part)
            rows.append(_part_row(number, claim, part))
    r.page.end_table()
    r.output.table("claims.csv", "claim,text,contrast,unit,from,to,participants,mean,low,high,d_z,p,p_claim,p_holm,p_contrary,p_contrary_holm,verdict,test,people_low,"
                   "people_high", rows)


# ---- strategies within people ----


@dataclass
class Within:
    """Two strategies at one speed, or their difference at one speed minus that at another."""

    quantity: Quantity
    a: Cell  #: b - a
    b: Cell
    less: Optional[Tuple[Cell, Cell]]  #: less the same two at another speed
    paired: Paired
    alike: Equivalence  #: p NaN: no margin is set, or too few people
    delta: float = NAN  #: Cliff's
    delta_interval: Interval = Interval()
    holm: float = NAN

    @property
    def what(self) -> str:
        if self.less:
            return f"({self.b.law} - {self.a.law}): {self.a.speed.word} less {self.less[0].speed.word}"
        return f"{self.b.law} - {self.a.law}, {self.a.speed.word}"


def within(r: Report, quantity: Quantity, a: Cell, b: Cell, less: Optional[Tuple[Cell, Cell]] = None) -> Optional[Within]:
    """None: nobody has taps in all of these cells."""
    values = r.taps.medians(b, quantity) - r.taps.medians(a, quantity)
    if less:
        values = values - (r.taps.medians(less[1], quantity) - r.taps.medians(less[0], quantity))
    values, margin = values[~np.isnan(values)], r.margins.get(quantity.key, NAN)
    if not len(values):
        return None
    tested = len(values) >= FEWEST_PEOPLE and not math.isnan(margin)
    out = Within(quantity, a, b, less, compare(values, r.seed), equivalent(values, -margin, margin) if tested else Equivalence())
    if not less:
        value, person = np.concatenate([a.of(quantity), b.of(quantity)]), np.concatenate([a.person, b.person])
        side = np.repeat([0, 1], [a.count, b.count])
        there = ~np.isnan(value)
        clusters = Clusters(value[there], person[there], side[there])
        out.delta, out.delta_interval = clusters.here(cliff), clusters.interval(cliff, r.seed)
    return out


def print_tests(r: Report, tests: Sequence[Within], caption: str, what: str, with_alike: bool) -> None:
    header = ("figure", what, "n (> 0)", "mean", "95 %", "unit", "p", "p, Holm", "p, alike" if with_alike else None)
    r.page.table(caption, header, 2)
    for w in tests:
        q, c = w.quantity, w.paired
        r.page.row(q.title, w.what, f"{c.n} ({c.positive})", number_text(c.mean, q.digits), interval_text(c.interval.low, c.interval.high, q.digits),
                   q.unit, p_text(c.p), p_text(w.holm), p_text(w.alike.p) if with_alike else None)
    r.page.end_table()
    with_delta = with_alike and bool(tests)
    r.page.table("Effect sizes: d_z of people's differences; Cliff's delta of their taps, -1 to 1" if with_delta
                 else "Effect sizes: d_z of people's differences of differences",
                 ("figure", "difference", "d_z", "95 %", *(("Cliff's delta", "95 %") if with_delta else ())), 2)
    for w in tests:
        effect, delta = w.paired.effect, w.delta_interval
        also = (number_text(w.delta, 2), interval_text(delta.low, delta.high, 2)) if with_delta else ()
        r.page.row(w.quantity.title, w.what, number_text(w.paired.d_z, 2), interval_text(effect.low, effect.high, 2), *also)
    r.page.end_table()


#: The columns of test_row for two strategies at one speed.
PAIRED = ("metric,unit,transition_a,transition_b,speed,participants,positive,mean_b_minus_a,sd,mean_low,mean_high,median,p,p_holm,d_z,d_z_low,"
          "d_z_high,cliff_delta,cliff_low,cliff_high,mean_low_90,mean_high_90,p_equivalent")


def test_row(w: Within) -> List[Text]:
    c, q = w.paired, w.quantity
    speeds = (w.a.speed.word, w.less[0].speed.word) if w.less else (w.a.speed.word,)
    row: List[Text] = [q.key, q.unit, w.a.law, w.b.law, *speeds, c.n, c.positive, c.mean, c.sd, c.interval.low, c.interval.high, c.median, c.p,
                       w.holm, c.d_z, c.effect.low, c.effect.high]
    if not w.less:
        row += [w.delta, w.delta_interval.low, w.delta_interval.high, w.alike.interval.low, w.alike.interval.high, w.alike.p]
    return row


def corrected(tests: Sequence[Optional[Within]]) -> List[Within]:
    made = [w for w in tests if w]
    for w, p in zip(made, holm([w.paired.p for w in made])):
        w.holm = p
    return made


def _pairs_at_one_speed(taps: Taps) -> List[Tuple[Cell, Cell]]:
    return [(a, b) for a, b in combinations(taps.cells, 2) if a.speed.word == b.speed.word]


def pairs(r: Report) -> None:
    people = len(r.taps.people)
    r.page.heading("pairs", "Strategies compared within participants")
    r.page.put('<p class="note">%s', r.caveat)
    if people < FEWEST_PEOPLE:
        r.page.put(" <b>No significance is claimed:</b> with %d participant%s the smallest two-sided p is %.3g.", people, plural(people),
                   min(1, 2 / 2**people))
    r.page.put("</p>\n")
    tests = corrected([within(r, q, a, b) for q in QUANTITIES.values() for a, b in _pairs_at_one_speed(r.taps)])
    r.differences, r.significant = len(tests), sum(w.holm < 0.05 for w in tests)
    print_tests(r, tests, "Differences of participants' medians. n: participants with both, in brackets those with a difference above 0. Family "
                 "of Holm's correction: the p of this table. p, alike: equivalence within the study's margin, not corrected", "difference", True)
    r.output.table("pairs.csv", PAIRED, map(test_row, tests))


def interaction(r: Report) -> None:
    r.page.heading("interaction", "Does the strategy matter more at higher speed?")
    r.page.put("<p>The interaction of strategy and speed: each participant's difference between two strategies at one speed, less the same "
               "difference at a lower speed. It is zero where the speed makes no difference to what the strategy does. %s</p>\n", r.caveat)
    tests: List[Optional[Within]] = []
    for q in QUANTITIES.values():
        for a, b in _pairs_at_one_speed(r.taps):
            for low_a in r.taps.cells:
                low_b = r.taps.cell(b.law, low_a.speed.word)
                if low_a.law == a.law and low_a.speed.centre < a.speed.centre and low_b:
                    tests.append(within(r, q, a, b, (low_a, low_b)))
    made = corrected(tests)
    print_tests(r, made, "Differences of differences, tested by an exact sign-flip test. Family of Holm's correction: the p of this table",
                 "difference of differences", False)
    r.output.table("interaction.csv", "metric,unit,transition_a,transition_b,speed,less_speed,participants,positive,mean,sd,mean_low,mean_high,"
                   "median,p,p_holm,d_z,d_z_low,d_z_high", map(test_row, made))
