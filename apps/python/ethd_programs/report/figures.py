"""Sections of a report that count and draw taps: boxes, all figures by cell, reasons, validity, the grid, the table for R."""
import math
from typing import Dict, List, Optional

import numpy as np

from ethd_programs.cli import plural
from ethd_programs.report.bootstrap import Clusters, median
from ethd_programs.report.output import Cell as Text
from ethd_programs.report.output import harmless
from ethd_programs.report.page import interval_text, mean_text, number_text
from ethd_programs.report.pictures import Path
from ethd_programs.report.report import Report
from ethd_programs.report.statistics import FEWEST_PEOPLE, NAN, summarise
from ethd_programs.report.taps import QUANTITIES, REASONS, Cell, Quantity, Taps

_DOTS = 300  # that are drawn for a cell; of more taps only each k-th is shown
_COLOURS = 8  # participants at most whom report-boxes.gp gives colours
_LINES = 12  # participants at most for whom lines are drawn between the strategies

# ---- boxes ----


def _places(taps: Taps, quantity: Quantity) -> Dict[int, float]:
    """The place of each cell on the axis, with a gap between speeds; cells without the figure have none."""
    places, at, before = {}, 0.0, None
    for i, cell in enumerate(taps.cells):
        if len(cell.values(quantity)):
            at += 1.5 if before is not None and cell.speed.centre != before else 1
            places[i], before = at, cell.speed.centre
    return places


def _lines(taps: Taps, quantity: Quantity, places: Dict[int, float]) -> List[List[Text]]:
    """From a participant's median under one strategy to the median under the next one."""
    rows: List[List[Text]] = []
    for i, x in places.items():
        if len(taps.people) > _LINES or i + 1 == len(taps.cells) or taps.cells[i].speed.word != taps.cells[i + 1].speed.word:
            continue
        a, b = (taps.medians(taps.cells[k], quantity) for k in (i, i + 1))
        rows += [[quantity.key, x, a[p], places.get(i + 1, 0) - x, b[p] - a[p], p] for p in range(len(taps.people)) if not np.isnan(a[p] + b[p])]
    return rows


def _write_boxes(r: Report, taps: Taps, prefix: str) -> None:
    boxes: List[List[Text]] = []
    points: List[List[Text]] = []
    lines: List[List[Text]] = []
    for quantity in QUANTITIES.values():
        places = _places(taps, quantity)
        for i, x in places.items():
            cell, values = taps.cells[i], taps.cells[i].of(quantity)
            there = ~np.isnan(values)
            s = summarise(values[there])
            boxes.append([quantity.key, x, cell.law, cell.speed.word, s.n, s.min, s.q1, s.median, s.q3, s.max])
            # dots are moved a little so that equal values don't hide each other: by the golden ratio, which spreads any number
            for k in range(0, s.n, s.n // _DOTS + 1):
                points.append([quantity.key, x + 0.22 + 0.2 * (0.618034 * k % 1), values[there][k], int(cell.person[there][k])])
        lines += _lines(taps, quantity, places)
    r.output.table(f"{prefix}boxes.csv", "metric,x,transition,speed,n,min,q1,median,q3,max", boxes)
    r.output.table(f"{prefix}points.csv", "metric,x,value,person", points)
    r.output.table(f"{prefix}lines.csv", "metric,x,y,dx,dy,person", lines)


def _draw_boxes(r: Report, taps: Taps, prefix: str, name: str, metrics: str, heading: str, caption: str) -> None:
    people = len(taps.people)
    whose = ("; colours, dashed lines (medians): participants" if people <= _COLOURS
             else "; dashed lines: participants' medians" if people <= _LINES else "")
    measured = "Measured." if r.measured and not prefix else "Simulated, not measured."
    r.draw("report-boxes.gp", f"{prefix}{name}.png", caption, {
        "in": Path(f"{prefix}boxes.csv"), "points": Path(f"{prefix}points.csv"), "between": Path(f"{prefix}lines.csv"),
        "metrics": metrics, "heading": heading, "people": str(people),
        "note": f"{measured} Valid taps. Box: median (red), quartiles, extremes. Dots: taps{whose}"})


def _pictures(r: Report, taps: Taps, prefix: str, whose: str) -> None:
    _write_boxes(r, taps, prefix)
    _draw_boxes(r, taps, prefix, "boxes", "v_rvo v_of d_max v_rmin", f"Taps on a virtual wall: {whose}",
                "As figures 14 to 17 of the paper, which show nine taps in each cell: the ring's speed as it meets the wall (14) and as the finger "
                f"touches it (15), its first rebound (16) and its smallest speed after the touch (17). Here: {whose}. Speeds are positive toward "
                f"the wall. Of more than {_DOTS} taps in a "
                "cell every second, third and so on is drawn.")
    if any(len(c.values(QUANTITIES["delta_s"])) for c in taps.cells):
        _draw_boxes(r, taps, prefix, "braking", "delta_s eps", f"Braking: {whose}",
                    f"Time of braking and offset of the wall, {whose}: what Table 1 sums up. If the dots form two groups, no tap "
                    "is near the mean. A strategy that brakes before the wall has no time of braking.")


def boxes(r: Report) -> None:
    r.page.heading("figures", "Speeds, rebounds, braking")
    _pictures(r, r.taps, "", "this study")
    if r.beside:
        _pictures(r, r.beside, "beside-", r.beside_name)
    _summary(r)
    r.page.heading("delay", "Visual and haptic delay")
    r.page.put("<p>When the touch is felt, less when it is seen: positive, felt late; negative, felt early. A delay under 45 ms is not "
               "noticed (Vogels 2004); in a tap, touch before sight is noticed from about 15 ms, touch after sight from about 50 ms "
               "(Di Luca and Mahnan 2019). A screen's own delay comes on top of what is seen, and makes these figures smaller.</p>\n")
    _draw_boxes(r, r.taps, "", "delay", "delay", "Touch felt after it is seen", "Signed delay between sight and touch, by cell.")


# ---- every figure ----


def _summary(r: Report) -> None:
    people = len(r.taps.people)
    if people < FEWEST_PEOPLE:
        r.page.put('<p class="note">The medians have no 95 %% interval: a bootstrap of %d participant%s would give little more than the '
                   "smallest and largest of them.</p>\n", people, plural(people))
    r.page.table("Every figure by cell: valid test taps", ("cell", "n (people)", "mean (sd)", "median", "quartiles", "extremes",
                                                           "median, 95 %"), 1)
    rows: List[List[Text]] = []
    for q in QUANTITIES.values():
        found = [(cell, cell.of(q)) for cell in r.taps.cells]
        found = [(cell, values) for cell, values in found if not np.isnan(values).all()]
        if found:
            r.page.span(f"{q.title} ({q.key}), {q.unit}", 7)
        for cell, values in found:
            there = ~np.isnan(values)
            s = summarise(values[there])
            clusters = Clusters(values[there], cell.person[there], np.zeros(s.n, np.int64))
            interval = clusters.interval(median, r.seed)
            d = q.digits
            r.page.row(cell.label, f"{s.n} ({clusters.people})", mean_text(s.n, s.mean, s.sd, d), number_text(s.median, d),
                       interval_text(s.q1, s.q3, d), interval_text(s.min, s.max, d), interval_text(interval.low, interval.high, d))
            rows.append([q.key, q.unit, cell.law, cell.speed.word, s.n, clusters.people, s.mean, s.sd, s.min, s.q1, s.median, s.q3, s.max,
                         interval.low, interval.high])
    r.page.end_table()
    r.output.table("summary.csv", "metric,unit,transition,speed,n,participants,mean,sd,min,q1,median,q3,max,median_low,median_high", rows)


# ---- reasons, validity ----


def reasons(r: Report) -> None:
    r.page.heading("valid", "Valid taps")
    if r.folder.facts["valid_by_finger"]:
        r.page.put("<p>A tap is valid when the hand's own speed was within the band, the finger didn't touch before the ring was there, "
                   "and it pressed once. The paper judges by the ring's speed.</p>\n")
    else:
        r.page.put("<p>A tap is valid when the ring met the wall before the finger touched it, at a speed within the band, and the finger "
                   "pressed once. The paper's participants needed 10 to 15 taps for three valid ones.</p>\n")
    r.page.table("Taps by reason", ("cell", "taps", "valid", "for 3 valid", *REASONS), 1)
    rows: List[List[Text]] = []
    for i, cell in enumerate(r.taps.cells, 1):
        counts = [int(np.count_nonzero(cell.reason == reason)) for reason in REASONS]
        each = f"{3 * cell.count / counts[0]:.1f}" if counts[0] else "-"
        r.page.row(cell.label, str(cell.count), f"{100 * counts[0] / cell.count:.0f} %", each, *map(str, counts))
        rows.append([cell.law, cell.speed.word, i, cell.count, *counts])
    r.page.end_table()
    r.output.table("reasons.csv", "transition,speed,row,taps," + ",".join(REASONS), rows)
    r.draw("report-reasons.gp", "reasons.png", "Why taps count or don't, by cell.",
           {"in": Path("reasons.csv"), "note": "test taps of this study"})


_NEAR, _STILL = 0.3, 0.02  # mm, m/s: a ring that is so near to the wall and so slow stands at it (apps/tap/felt.h)


def validity(r: Report) -> None:
    by_finger = r.folder.facts["valid_by_finger"]
    shown = [QUANTITIES[key] for key in ("v_rvo", "v_hand", "v_of", "d_max", "v_rmin")]
    r.page.heading("rules", "What validity does to the comparison")
    r.page.put("<p>This study's taps are valid by the hand's own speed and by when the finger touched: no strategy can change by which "
               "taps it is judged.</p>\n" if by_finger else
               "<p>This study's taps are valid, as the paper's, by the speed at which the <em>ring</em> meets the wall. A strategy that "
               "slows the ring down beforehand changes that speed, and therefore which of its taps are valid: see v_rvo of every tap.</p>\n")
    rows: List[List[Text]] = []
    if any("" in column for cell in r.taps.cells for column in (cell.by_ring, cell.by_finger)):
        r.page.put("<p>These taps come from an earlier version, which didn't judge them by the other rule.</p>\n")
    else:
        r.page.put("<p>By the ring, a tap counts when the ring meets the wall at the speed asked for, before the finger touches it. By hand "
                   "and finger, it counts when the hand's own path crosses the wall at that speed and the finger doesn't touch before the "
                   "ring is behind the wall, or the ring is within %g mm of the wall and slower than %g m/s. Either way the finger has to press for a while, "
                   "once.</p>\n", _NEAR, _STILL)
        r.page.table("Medians of the taps that each rule lets count",
                     ("cell", "valid by", "taps", "by both", "v_rvo m/s", "v_hand m/s", "v_of m/s", "d_max mm", "v_rmin m/s"), 2)
        for cell in r.taps.cells:
            ring, hand = cell.by_ring == "ok", cell.by_finger == "ok"
            rules = (("ring" if by_finger else "ring, the study's rule", ring),
                     ("hand and finger, the study's rule" if by_finger else "hand and finger", hand), ("every tap", np.ones_like(ring)))
            for k, (words, counts) in enumerate(rules):
                values = [q.of(cell.figures)[counts] for q in shown]
                medians = [summarise(v[~np.isnan(v)]).median for v in values]
                taps, both = int(np.count_nonzero(counts)), int(np.count_nonzero(ring & hand))
                r.page.row("" if k else cell.label, words, str(taps), str(both), *(number_text(m, q.digits) for m, q in zip(medians, shown)))
                rows.append([cell.law, cell.speed.word, harmless(words), taps, both, *medians])
        r.page.end_table()
    r.output.table("validity.csv", "transition,speed,rule,taps,by_both,v_rvo,v_hand,v_of,d_max,v_rmin", rows)


# ---- the table for R, the grid ----


def tidy(r: Report) -> None:
    shown = [QUANTITIES[key] for key in ("v_rvo", "v_of", "d_max", "v_rmin", "delta_s", "eps", "delay")]
    rows: List[List[Text]] = []
    for cell in r.taps.cells:
        values = [q.of(cell.figures) for q in shown]
        for i in np.flatnonzero(cell.valid):
            rows.append([r.taps.people[cell.person[i]], cell.law, cell.speed.word, int(cell.row[i]) + 1, *(float(v[i]) for v in values)])
    r.output.table("tidy.csv", "participant,strategy,speed,tap," + ",".join(q.column for q in shown), rows)
    r.page.heading("model", "The same as a mixed model, in R")
    r.page.put("<p><code>tidy.csv</code> has a row for each valid test tap: participant, strategy, speed, the tap's row in taps.csv, and its "
               "figures, each with its unit in the column's name. A linear mixed model of all taps, with what differs between participants as "
               "random effects, is</p>\n"
               "<pre>library(lmerTest)\n"
               'taps &lt;- read.csv("tidy.csv", stringsAsFactors = TRUE)\n'
               "model &lt;- lmer(d_max_mm ~ strategy * speed + (1 + strategy | participant), data = taps)\n"
               "anova(model)    # the row strategy:speed is the interaction\n"
               "emmeans::emmeans(model, pairwise ~ strategy | speed)</pre>\n"
               "<p>With few participants such a model often doesn't converge; then <code>(1 | participant)</code> is what is left, and the "
               "tables above, which assume less, are the safer reading.</p>\n")


_ROWS = 400  # of the page; grid.csv has all


def grid(r: Report) -> None:
    axes, points = r.folder.facts["grid"], max(r.points) + 1
    if points < 2 or not axes:
        return
    shown = [QUANTITIES[key] for key in ("delta_s", "eps", "d_max", "v_rmin", "v_of")]
    r.page.heading("grid", "The grid of gains")
    r.page.put("<p>Medians of the valid taps; speeds in m/s, lengths in mm, times in ms. Gains: %s. The other sections show point %d of %d.</p>\n",
               ", ".join(axis["key"] for axis in axes), r.point, points)
    r.page.table("All points", ("gains", "cell", "valid", "", *(q.key for q in shown)), 2)
    rows: List[List[Text]] = []
    for point in range(points):
        taps: Optional[Taps] = r.points.get(point)
        for cell in taps.cells if taps else []:
            gains = _gains(axes, point)
            rows.append(_grid_row(point, gains, cell, shown))
            if len(rows) <= _ROWS:
                valid = int(np.count_nonzero(cell.valid))
                medians = (number_text(summarise(cell.values(q)).median, q.digits) for q in shown)
                r.page.row(", ".join(gains)[:159], cell.label, str(valid), f"{100 * valid / cell.count:.0f} %", *medians)
    r.page.end_table()
    header = ["point", *(axis["key"] for axis in axes), "transition", "speed", "taps", "valid"]
    r.output.table("grid.csv", ",".join(header + [f"{q.key}_{s}" for q in shown for s in ("mean", "sd", "median")]), rows)


def _gains(axes: List[Dict[str, List[str]]], point: int) -> List[str]:
    """The values at a combination; the last axis varies fastest."""
    shape = [len(axis["values"]) for axis in axes]
    return [axis["values"][k] for axis, k in zip(axes, np.unravel_index(point % math.prod(shape), shape))]


def _grid_row(point: int, gains: List[str], cell: Cell, shown: List[Quantity]) -> List[Text]:
    row: List[Text] = [point, *map(harmless, gains), cell.law, cell.speed.word, cell.count, int(np.count_nonzero(cell.valid))]
    for q in shown:
        s = summarise(cell.values(q))
        row += [s.mean, s.sd, s.median if s.n else NAN]
    return row
