"""Recordings, the folders that the programs write (include/ethd/record.h), read in pieces."""
import math
import os
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import Refusal
from ethd_programs.files import opened, reason, there
from ethd_programs.npy import array_in
from ethd_programs.table import lines

FILES = ("tick.npy", "config.ini", "scene.scene", "events.csv", "truth.npy", "snapshot.npy", "taps.csv")
PIECE = 4096  #: rows that are read at once


class Field(NamedTuple):
    """A field of a tick (include/ethd/sense.h, include/ethd/space.h)."""

    name: str
    unit: str
    columns: Tuple[str, ...]  #: what a table calls its numbers
    given_by: Tuple[int, ...]  #: for each column, or for all: bits of `have` that mark it as given by the device, any of them suffices; 0: always given


#: What a table calls a field's numbers: @ stands for each axis, # for 1, 2 and so on. What ethd-replay reads and writes has the
#: same names.
_COLUMNS = {
    "time_ns": "t_s", "sample_ns": "t_ring_s", "q": "q#_rad", "dq": "dq#_radps", "x": "@_m", "v": "v@_mps", "normal": "normal_@",
    "finger": "finger_@_m", "finger_v": "finger_v@_mps", "centre": "centre_@_m", "ring": "ring_@_m",
    "rays": " ".join(f"r{i}_m" for i in range(16)), "bodies": "body#_x_m body#_y_m body#_angle_rad body#_vx_mps body#_vy_mps body#_spin_radps",
    "reading": "reading_@_m", "reading_v": "reading_v@_mps", "commanded": "commanded#_Nm", "age": "age#_s",
    "ability": "able_speed_mps able_acceleration_mps2 able_delay_s able_mass_kg able_force_N able_friction_N",
    "xf": "@f_m", "vf": "v@f_mps", "qd": "qd#_radps", "eps_q": "epsq#_rad", "eps_q_dot": "depsq#_radps", "fe": "fe@_N", "fd": "fd@_N",
    "tau_raw": "tau#_raw_Nm", "tau": "tau#_Nm", "asked": "asked_@", "command": "command_@", "facing": "facing_@", "learnt": "learnt#",
    "near_point": "near#_@_m", "near_n": "near#_n@", "near_v": "near#_v@_mps", "near_id": "near#_id", "near_material": "near#_material",
    **{name: f"{name}_m" for name in ("finger_noise", "reading_noise", "rf", "eps", "d_re", "d_fe")},
    **{name: f"{name}_mps" for name in ("reading_v_noise", "v_n", "speed")},
    **{name: name for name in ("have", "missed", "step_ns", "faults", "grave", "tick", "fault", "guard", "swap", "queried", "contacts",
                               "overflow", "object", "body", "state", "beta", "near")},
}  # fmt: skip
_GIVEN_BY = {"dq": 1, "finger": 2 | 4, "finger_v": 2, "sample_ns": 8 | 16, "centre": 8, "ring": 32, "rays": 16, "commanded": 2048, "age": 4096}
#: The same of space where it differs.
_SPACE_COLUMNS = {**_COLUMNS, "sample_ns": "t_reading_s", "commanded": "commanded_@"}
_SPACE_GIVEN_BY = {"normal": 16, "finger": 1, "finger_v": 1, "sample_ns": 2, "reading": 2, "reading_v": 4, "reading_noise": 2, "reading_v_noise": 4,
                   "ability": 32, "commanded": 128}  # fmt: skip
_UNITS = {"mps": "m/s", "radps": "rad/s", "bodies": "m, rad, s", "ability": "m/s, m/s2, s, kg, N, N", **dict.fromkeys(("commanded", "asked", "command"), "N, m/s")}
_MOST = 48  # numbers of a field


def _unit(name: str, columns: Sequence[str]) -> str:
    """By the ending of the columns if they have the same one."""
    if name.endswith("_ns"):
        return "ns"
    endings = {column.rpartition("_")[2] for column in columns}
    ending = endings.pop()
    return _UNITS.get(name, "1") if endings or ending not in ("m", "mps", "rad", "radps", "s", "N", "Nm") else _UNITS.get(ending, ending)


def fields_of(dtype: "np.dtype[Any]") -> Tuple[Field, ...]:
    """The fields that a recording's rows have, of the plane or of space; none: they are other rows. An earlier version's lack some."""
    names = dtype.names or ()
    is_space = "reading" in names
    known, given_by, axes = (_SPACE_COLUMNS, _SPACE_GIVEN_BY, "xyz") if is_space else (_COLUMNS, _GIVEN_BY, "xy")
    found = []
    for name in names:
        count = math.prod(dtype[name].shape)
        parts = [part.replace("@", axis) for part in known.get(name, "").split() for axis in (axes if "@" in part else axes[0])]
        columns = [part.replace("#", str(i)) for i in range(1, min(count, _MOST) + 1) for part in parts][:count]
        if not parts or count % len(parts) or len(set(columns)) != count or dtype[name].base.str not in ("<i8", "<f8"):
            return ()
        given = [64 << i // len(parts) for i in range(count)] if name == "bodies" else [given_by.get(name, 0)]
        found.append(Field(name, _unit(name, columns), tuple(columns), tuple(given)))
    return tuple(found) if names[:2] == ("time_ns", "have") else ()


class RecordedEvent(NamedTuple):
    """A line of events.csv; the event comes before row `row` of tick."""

    row: int
    kind: str  #: setup, start, transition, contact, tracking, set, clear, heat, learned, fault, lost, thinned, clock, end: include/ethd/record.h
    detail: str


def events(folder: str) -> List[RecordedEvent]:
    """The events of a recording; none if it has no such file."""
    path = os.path.join(folder, "events.csv")
    if not there(folder, "events.csv"):
        return []
    rows = lines(path, "replace")
    if next(rows, (1, []))[1] != list(RecordedEvent._fields):
        raise ValueError(f"{path}:1: the first line must be row,kind,detail")
    found: List[RecordedEvent] = []
    for number, cells in rows:
        if len(cells) != 3 or not cells[0].isdecimal():
            raise ValueError(f"{path}:{number}: row,kind,detail are allowed, the row a number")
        found.append(RecordedEvent(int(cells[0]), cells[1], cells[2]))
        if len(found) > 1 and found[-1].row < found[-2].row:
            raise ValueError(f"{path}:{number}: row: found {cells[0]}, {found[-2].row} or more is allowed")
    return found


class Ticks:
    """The ticks of a recording, in pieces, so that the longest one takes little memory."""

    def __init__(self, folder: str):
        self._folder = folder
        try:
            self._rows: Any = array_in(folder, "tick.npy")
        except (FileNotFoundError, NotADirectoryError) as e:
            raise Refusal(f"{folder}: no recording, whose tick.npy is needed: {reason(e)}; ethd-run --record makes one") from None
        self.count, self.fields = self._rows.size, fields_of(self._rows.dtype)
        if not self.fields or self._rows.ndim != 1:
            raise Refusal(f"{folder}/tick.npy: other columns than those of this version of libethd")

    def pieces(self) -> Iterator[Tuple[NDArray[Any], NDArray[Any]]]:
        """Rows, and what to add to their instants, ns, so that they never go back: where the recording's time starts again, as
        it does with each tap, it goes on a millisecond later."""
        last, shift, rows = None, 0, self._rows
        with opened(self._folder, "tick.npy") as file:  # read, not mapped: a file may be cut short meanwhile
            file.seek(rows.offset)
            for i in range(0, self.count, PIECE):
                size = min(PIECE, self.count - i) * rows.dtype.itemsize
                data = file.read(size)
                if len(data) < size:
                    raise Refusal(f"{self._folder}/tick.npy: was cut short while it was read")
                piece = np.frombuffer(data, rows.dtype)
                time = piece["time_ns"]
                steps = np.diff(time, prepend=time[0] if last is None else last)
                shifts = shift + np.cumsum(np.where(steps < 0, 1_000_000 - steps, 0))
                last, shift = int(time[-1]), int(shifts[-1])
                yield piece, shifts


def utc_offset(found: List[RecordedEvent]) -> Optional[int]:
    """What added to the recording's instants gives UTC, ns since 1970, by the event `clock`; None: nobody knows."""
    for e in found:
        instant, _, date = e.detail.partition(" ")
        if e.kind == "clock" and instant.isdecimal() and date[:1].isdecimal():
            return int(np.datetime64(date.rstrip("Z"), "ns").astype(np.int64)) - int(instant)
    return None
