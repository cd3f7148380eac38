"""The taps of a table, by cell: a strategy at a speed."""
import re
from array import array
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Set, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import Refusal, quoted
from ethd_programs.report.statistics import NAN, Numbers
from ethd_programs.report.study import Folder, Table

REASONS = ("ok", "early-contact", "too-slow", "too-fast", "no-contact", "grazing", "double", "fault")
_CELLS = 64  # that a table may have
_POINTS = 100000  # of a grid
_WORDS = ("participant", "transition", "speed")  # that stand in names of files
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
    reason: NDArray[np.str_]
    by_ring: NDArray[np.str_]
    by_finger: NDArray[np.str_]
    hand: NDArray[np.str_]
    person: NDArray[np.int64]  #: an index of Taps.people
    row: NDArray[np.int64]  #: of the table, from 0
    name: NDArray[np.str_]  #: of the tap's recording
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
        order = np.lexsort((value, person))
        person, value = person[order], value[order]
        if not len(person):
            return out
        first = np.flatnonzero(np.concatenate(([True], np.diff(person) != 0)))
        count = np.diff(np.append(first, len(person)))
        if how == "median":
            found = (value[first + (count - 1) // 2] + value[first + count // 2]) / 2
        else:
            found = np.add.reduceat(value, first) / count
        out[person[first]] = found
        return out

    def medians(self, cell: Optional["Cell"], quantity: Quantity) -> Numbers:
        return self.by_person(cell, cell.of(quantity) if cell else None)


# ---- reading ----


def _real(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return NAN


class _Reader:
    """Takes the rows of a table into cells, point by point."""

    def __init__(self, table: Table, speeds: Dict[str, Any], absent: Set[str]):
        self.table, self.speeds, self.absent = table, speeds, absent
        self.taps: Dict[int, Taps] = {}
        self.rows: Dict[int, Dict[Tuple[str, str], Any]] = {}

    def refuse(self, row: int, column: str, found: str, allowed: str) -> Refusal:
        return Refusal(f"{self.table.path}:{row + 2}: {column}: found {quoted(found)}, {allowed} is allowed")

    def number(self, row: int, column: str, cell: str) -> float:
        if not cell:
            return NAN
        try:
            if cell.strip("0123456789.eE+-") and cell != "nan":
                raise ValueError
            return float(cell)
        except ValueError:
            raise self.refuse(row, column, cell, "a number") from None

    def point(self, row: int, cell: str) -> int:
        point = _real(cell or "0")
        if not 0 <= point <= _POINTS:
            raise self.refuse(row, "point", cell, "a point of the grid")
        return int(point)

    def speed(self, row: int, word: str) -> Speed:
        known = self.speeds.get(word)
        if known:
            return Speed(word, known["centre_mps"], known["band_mps"])
        v = _real(word)
        if not 0.01 <= v <= 2:
            raise self.refuse(row, "speed", word, "low, high or a number, in 64 cells,")
        return Speed(word, v, 0.04 + 0.1 * v)

    def reason(self, row: int, column: str, cell: str) -> str:
        """A table of an earlier version may leave the other rule's empty."""
        if cell in REASONS or (not cell and column != "reason"):
            return cell
        raise self.refuse(row, column, cell, "ok, early-contact and the like")

    def take(self, row: int, cells: Dict[str, str]) -> None:
        at = self.point(row, cells["point"])
        taps, lists = self.taps.setdefault(at, Taps()), self.rows.setdefault(at, {})
        for column in _WORDS:
            if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.+-]{0,30}", cells[column]):
                raise self.refuse(row, column, cells[column], "a word of up to 31 letters, digits, _ . + -")
        if cells["part"] == "training":
            taps.training += 1
            return
        if cells["participant"] in self.absent:
            taps.left_out += 1
            return
        taps.accepted += cells["checked"] == "accepted"
        if cells["checked"] == "rejected":
            taps.rejected += 1
            return
        key = (cells["transition"], cells["speed"])
        if key not in lists:
            if len(lists) == _CELLS:
                raise self.refuse(row, "speed", cells["speed"], "low, high or a number, in 64 cells,")
            lists[key] = (self.speed(row, cells["speed"]), {c: [] for c in ("reason", "by_ring", "by_finger", "hand", "participant", "row", "name")},
                          {c: array("d") for c in (*_NEEDED, *_LATER)})
        _, plain, figures = lists[key]
        for column in ("reason", "by_ring", "by_finger"):
            plain[column].append(self.reason(row, column, cells[column]))
        for column, numbers in figures.items():
            numbers.append(self.number(row, column, cells[column]))
        for column in ("hand", "participant"):
            plain[column].append(cells[column])
        plain["row"].append(row)
        plain["name"].append(_recording(cells))

    def finish(self, at: int) -> Taps:
        taps, lists = self.taps[at], self.rows[at]
        everybody: List[str] = list(dict.fromkeys(p for _, i, p in sorted(
            (row, k, p) for k, (_, plain, _) in enumerate(lists.values()) for row, p in zip(plain["row"], plain["participant"]))))
        index = {p: i for i, p in enumerate(everybody)}
        taps.people = everybody
        for (law, _), (speed, plain, lists_of) in lists.items():
            figures = {c: np.array(v) for c, v in lists_of.items()}
            figures["delay_s"] = figures["t_of_s"] - figures["t_seen_s"]
            taps.cells.append(Cell(law, speed, np.array(plain["reason"]), np.array(plain["by_ring"]), np.array(plain["by_finger"]),
                                   np.array(plain["hand"]), np.array([index[p] for p in plain["participant"]]), np.array(plain["row"]),
                                   np.array(plain["name"]), figures))
        taps.cells.sort(key=lambda c: (c.speed.centre, _ORDER.index(c.law) if c.law in _ORDER else len(_ORDER), c.law))
        return taps


def _whole(cell: str) -> int:
    found = re.match(r"\s*[-+]?[0-9]{1,9}", cell)
    return int(found.group()) if found else 0


def _recording(cells: Dict[str, str]) -> str:
    point = [cells["point"]] if cells["point"] else []
    return "-".join([*point, cells["participant"], f"{_whole(cells['block']):02d}", f"{_whole(cells['attempt']):03d}"])


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
    columns: Sequence[str] = (*_WORDS, "point", "part", "block", "attempt", "reason", "by_ring", "by_finger", "checked", "hand", *_NEEDED, *_LATER)
    reader = _Reader(table, folder.facts["speeds"], absent)
    for row, cells in enumerate(table.cells(*columns)):
        reader.take(row, dict(zip(columns, cells)))
    found = {at: reader.finish(at) for at in sorted(reader.taps)}
    if point not in found or not found[point].cells:
        raise Refusal(f"{table.path}: no test tap at point {point} of {max(found, default=0) + 1}")
    return found, absent
