"""The taps of a table, by cell: a strategy at a speed."""
import re
import sys
from dataclasses import dataclass, field
from typing import Any, Callable, Dict, List, Optional, Set, Tuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ethd_programs.cli import Refusal, quoted
from ethd_programs.report.statistics import NAN, Numbers
from ethd_programs.report.study import Folder, Table

REASONS = ("ok", "early-contact", "too-slow", "too-fast", "no-contact", "grazing", "double", "fault")
_A_REASON = "ok, early-contact and the like"
_CELLS = 64  # that a table may have
_POINTS = 100000  # of a grid
_NEEDED = ("v_rvo_mps", "v_of_mps", "d_max_m", "v_rmin_mps", "delta_s_ms", "eps_m", "t_rvo_s", "t_of_s", "t_seen_s",
           "peak_force_n", "finger_radius_m", "commanded_mps")
_LATER = ("v_hand_mps", "touch_depth_m", "eps_felt_m")  # a table of an earlier version lacks these
_ORDER = ("abrupt", "smooth", "offset")  # from the one that brakes least; others follow by name


@dataclass(frozen=True)
class Speed:
    word: str  #: as it was asked for: low, high or a number
    centre: float  #: m/s
    band: float  #: m/s: valid within centre +- band


@dataclass
class Cell:
    """All test taps of one strategy at one speed."""

    law: str
    speed: Speed
    reason: NDArray[Any]
    by_ring: NDArray[Any]
    by_finger: NDArray[Any]
    hand: NDArray[Any]
    person: NDArray[np.int64]  #: an index of Taps.people
    row: NDArray[np.int64]  #: of the table, from 0
    name: NDArray[Any]  #: of the tap's recording
    figures: Dict[str, Numbers]  #: by column of the table; and delay_s

    @property
    def label(self) -> str:
        return f"{self.law}, {self.speed.word}"

    @property
    def count(self) -> int:
        return len(self.reason)

    @property
    def valid(self) -> NDArray[np.bool_]:
        return np.asarray(self.reason == "ok")

    def of(self, quantity: "Quantity") -> Numbers:
        """Of every tap; NaN where it isn't valid, or hasn't the figure."""
        return np.where(self.valid, quantity.of(self.figures), NAN)

    def values(self, quantity: "Quantity") -> Numbers:
        """Of the valid taps that have it."""
        found = self.of(quantity)
        return np.asarray(found[~np.isnan(found)])


@dataclass(frozen=True)
class Quantity:
    """A figure of a tap as people read it."""

    key: str
    title: str
    unit: str
    digits: int
    source: str  #: the column of the taps
    scale: float = 1

    def of(self, figures: Dict[str, Numbers]) -> Numbers:
        return self.scale * figures[self.source]

    @property
    def column(self) -> str:
        """The name of a table's column, with its unit."""
        return f"{self.key}_{self.unit.replace('/', 'p')}"


QUANTITIES = {q.key: q for q in (
    Quantity("v_rvo", "Ring's speed as it meets the wall", "m/s", 3, "v_rvo_mps"),
    Quantity("v_of", "Ring's speed as the finger touches it", "m/s", 3, "v_of_mps"),
    Quantity("d_max", "First rebound", "mm", 3, "d_max_m", 1e3),
    Quantity("v_rmin", "Ring's smallest speed after the touch", "m/s", 3, "v_rmin_mps"),
    Quantity("delta_s", "Time of braking", "ms", 2, "delta_s_ms"),
    Quantity("eps", "Offset of the wall", "mm", 3, "eps_m", 1e3),
    Quantity("delay", "Touch felt after it is seen", "ms", 1, "delay_s", 1e3),
    Quantity("peak_force", "Largest force that the wall asks for", "N", 2, "peak_force_n"),
    Quantity("v_hand", "Hand's own speed at the touch plane", "m/s", 3, "v_hand_mps"),
    Quantity("touch_depth", "Ring behind the wall at the touch", "mm", 3, "touch_depth_m", 1e3),
    Quantity("eps_felt", "Offset of the wall 60 ms after the touch", "mm", 3, "eps_felt_m", 1e3),
)}


@dataclass
class Taps:
    """The test taps of one point of a grid, but for those of participants who aren't analysed."""

    cells: List[Cell] = field(default_factory=list)  #: speeds from low to high, strategies within
    people: List[str] = field(default_factory=list)
    training: int = 0
    left_out: int = 0
    accepted: int = 0  #: by the experimenter, who looked at it
    rejected: int = 0  #: valid taps that the experimenter rejected; they are in no cell

    @property
    def count(self) -> int:
        return sum(c.count for c in self.cells)

    @property
    def valid(self) -> int:
        return sum(int(np.count_nonzero(c.valid)) for c in self.cells)

    def cell(self, law: str, speed: str) -> Optional["Cell"]:
        return next((c for c in self.cells if (c.law, c.speed.word) == (law, speed)), None)

    def by_person(self, cell: Optional["Cell"], values: Optional["Numbers"], how: str = "median") -> Numbers:
        """One number for each person: the median or mean of their values in the cell, which has a value for each tap;
        NaN without any."""
        out = np.full(len(self.people), NAN)
        if cell is None or values is None:
            return out
        there = ~np.isnan(values)
        person, value = cell.person[there], values[there]
        if len(person):
            index = np.unique(person)
            out[index] = {"median": ndimage.median, "mean": ndimage.mean}[how](value, person, index)
        return out

    def medians(self, cell: Optional["Cell"], quantity: Quantity) -> Numbers:
        return self.by_person(cell, cell.of(quantity) if cell else None)


# ---- reading ----


def _word(cell: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.+-]{0,30}", cell):
        raise ValueError
    return sys.intern(cell)


def _reason(cell: str) -> str:
    return REASONS[REASONS.index(cell)]


def _other_reason(cell: str) -> str:
    """A table of an earlier version may leave the other rule's empty."""
    return _reason(cell) if cell else ""


def _number(cell: str) -> float:
    if cell.strip("0123456789.eE+-") and cell != "nan":
        raise ValueError
    return float(cell or "nan")


def _point(cell: str) -> int:
    point = float(cell or "0")
    if not 0 <= point <= _POINTS:
        raise ValueError
    return int(point)


def _whole(cell: str) -> int:
    return int(cell) if cell.isdecimal() else 0


def _speed(word: str, known: Dict[str, Any]) -> Speed:
    if word in known:
        return Speed(_word(word), known[word]["centre_mps"], known[word]["band_mps"])
    v = float(_word(word))
    if not 0.01 <= v <= 2:
        raise ValueError
    return Speed(word, v, 0.04 + 0.1 * v)


_A_SPEED = f"low, high or a number, in {_CELLS} cells,"
_PARSED: Dict[str, Tuple[Callable[[str], Any], str]] = {
    "part": (sys.intern, ""), "checked": (sys.intern, ""), "hand": (sys.intern, ""), "block": (_whole, ""), "attempt": (_whole, ""),
    **dict.fromkeys(("participant", "transition"), (_word, "a word of up to 31 letters, digits, _ . + -")),
    "point": (_point, "a point of the grid"), **dict.fromkeys((*_NEEDED, *_LATER), (_number, "a number")),
    "reason": (_reason, _A_REASON), **dict.fromkeys(("by_ring", "by_finger"), (_other_reason, _A_REASON))}


def _refuse(table: Table, row: int, column: str, cell: str, allowed: str) -> Refusal:
    return Refusal(f"{table.path}:{row + 2}: {column}: found {quoted(cell)}, {allowed} is allowed")


def read(table: Table, speeds: Dict[str, Any]) -> Dict[str, NDArray[Any]]:
    """The columns of a table of taps. speeds: what its words for speeds mean."""
    parsed = {**_PARSED, "speed": (lambda cell: _speed(cell, speeds), _A_SPEED)}
    found: Dict[str, List[Any]] = {column: [] for column in parsed}
    for row, cells in enumerate(table.cells(*parsed)):
        for cell, (column, (of, allowed)) in zip(cells, parsed.items()):
            try:
                found[column].append(of(cell))
            except ValueError:
                raise _refuse(table, row, column, cell, allowed) from None
    return {column: np.array(values, float if parsed[column][0] is _number else object) for column, values in found.items()}


def _of_rows(table: Table, columns: Dict[str, NDArray[Any]], rows: NDArray[np.int64], absent: Set[str]) -> Taps:
    """The taps of these rows, all of one point of a grid."""
    training = columns["part"][rows] == "training"
    away = ~training & np.array([person in absent for person in columns["participant"][rows]], bool)
    accepted, rejected = (~training & ~away & (columns["checked"][rows] == word) for word in ("accepted", "rejected"))
    counts = (int(np.count_nonzero(which)) for which in (training, away, accepted, rejected))
    rows = rows[~(training | away | rejected)]
    people = {person: i for i, person in enumerate(dict.fromkeys(columns["participant"][rows]))}
    taps = Taps([], list(people), *counts)
    cells: Dict[Tuple[str, Speed], List[int]] = {}
    for row in rows.tolist():
        cells.setdefault((columns["transition"][row], columns["speed"][row]), []).append(row)
    for k, ((law, speed), i) in enumerate(cells.items()):
        if k == _CELLS:
            raise _refuse(table, i[0], "speed", speed.word, _A_SPEED)
        figures = {c: columns[c][i] for c in (*_NEEDED, *_LATER)}
        figures["delay_s"] = figures["t_of_s"] - figures["t_seen_s"]
        words = {c: columns[c][i] for c in ("reason", "by_ring", "by_finger", "hand", "name")}
        person = np.array([people[who] for who in columns["participant"][i]])
        taps.cells.append(Cell(law, speed, person=person, row=np.array(i), figures=figures, **words))
    taps.cells.sort(key=lambda c: (c.speed.centre, _ORDER.index(c.law) if c.law in _ORDER else len(_ORDER), c.law))
    return taps


def of_folder(folder: Folder, point: int) -> Tuple[Dict[int, Taps], Set[str]]:
    """The test taps by point of a grid (0 without one), where `point` must exist; and the participants who aren't
    analysed, whose taps are left out."""
    table, participants = folder.table("taps"), folder.table("participants")
    if not table.names:
        here = folder.folders[0]
        raise Refusal(f"{table.path}: No such file; ethd-study --resume {here} or --merge {here} makes it")
    missing = [c for c in ("transition", "speed", "valid", "reason", *_NEEDED, "participant") if c not in table.names]
    if missing:
        raise Refusal(f"{table.path}:1: no column {missing[-1]}; a taps.csv of ethd-study has it")
    absent = {p for p, analysed in participants.cells("participant", "analysed") if analysed == "0"}
    columns = read(table, folder.facts["speeds"])
    named = zip(*(columns[c].tolist() for c in ("point", "participant", "block", "attempt")))
    before = "{0}-" if "point" in table.names else ""
    columns["name"] = np.array([(before + "{1}-{2:02d}-{3:03d}").format(*tap) for tap in named], object)
    rows = np.argsort(columns["point"], kind="stable")
    each, first = np.unique(columns["point"][rows].astype(int), return_index=True)
    found = {int(at): _of_rows(table, columns, part, absent) for at, part in zip(each, np.split(rows, first[1:]))}
    if point not in found or not found[point].cells:
        raise Refusal(f"{table.path}: no test tap at point {point} of {max(found, default=0) + 1}")
    return found, absent
