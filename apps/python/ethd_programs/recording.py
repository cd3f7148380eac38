"""Recordings, the folders that the programs write (include/ethd/record.h), read in pieces."""
import datetime
import mmap
import os
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import Refusal
from ethd_programs.files import reason, there
from ethd_programs.npy import mapped
from ethd_programs.table import lines

FILES = ("tick.npy", "config.ini", "scene.scene", "events.csv", "truth.npy", "snapshot.npy", "taps.csv")
PIECE = 4096  #: rows that are read at once


class Field(NamedTuple):
    """A field of a tick (include/ethd/sense.h)."""

    name: str
    unit: str
    columns: Tuple[str, ...]  #: what a table calls its numbers
    given_by: Tuple[int, ...] = (0,)  #: for each column, or for all: bits of `have` that mark it as given by the device, any of them suffices; 0: always given


def _pair(name: str, unit: str) -> Tuple[str, ...]:
    return tuple(name.format(axis) + unit for axis in "xy")


_BODY = ("x_m", "y_m", "angle_rad", "vx_mps", "vy_mps", "spin_radps")

#: What ethd-replay reads and writes has the same names.
FIELDS = (
    Field("time_ns", "ns", ("t_s",)),
    Field("have", "1", ("have",)),
    Field("missed", "1", ("missed",)),
    Field("step_ns", "ns", ("step_ns",)),
    Field("faults", "1", ("faults",)),
    Field("grave", "1", ("grave",)),
    Field("q", "rad", ("q1_rad", "q2_rad")),
    Field("dq", "rad/s", ("dq1_radps", "dq2_radps"), (1,)),
    Field("finger", "m", _pair("finger_{}", "_m"), (2 | 4,)),
    Field("finger_v", "m/s", _pair("finger_v{}", "_mps"), (2,)),
    Field("sample_ns", "ns", ("t_ring_s",), (8 | 16,)),
    Field("centre", "m", _pair("centre_{}", "_m"), (8,)),
    Field("ring", "m", _pair("ring_{}", "_m"), (32,)),
    Field("rays", "m", tuple(f"r{i}_m" for i in range(16)), (16,)),
    Field("bodies", "m, rad, s", tuple(f"body{i + 1}_{part}" for i in range(4) for part in _BODY), tuple(64 << i for i in range(4) for _ in _BODY)),
    Field("finger_noise", "m", ("finger_noise_m",)),
    Field("commanded", "Nm", ("commanded1_Nm", "commanded2_Nm"), (2048,)),
    Field("age", "s", ("age1_s", "age2_s"), (4096,)),
    Field("tick", "1", ("tick",)),
    Field("fault", "1", ("fault",)),
    Field("guard", "1", ("guard",)),
    Field("swap", "1", ("swap",)),
    Field("queried", "1", ("queried",)),
    Field("contacts", "1", ("contacts",)),
    Field("overflow", "1", ("overflow",)),
    Field("object", "1", ("object",)),
    Field("body", "1", ("body",)),
    Field("state", "1", ("state",)),
    Field("x", "m", ("x_m", "y_m")),
    Field("v", "m/s", ("vx_mps", "vy_mps")),
    Field("xf", "m", ("xf_m", "yf_m")),
    Field("vf", "m/s", ("vxf_mps", "vyf_mps")),
    Field("rf", "m", ("rf_m",)),
    Field("qd", "rad/s", ("qd1_radps", "qd2_radps")),
    Field("eps_q", "rad", ("epsq1_rad", "epsq2_rad")),
    Field("eps_q_dot", "rad/s", ("depsq1_radps", "depsq2_radps")),
    Field("beta", "1", ("beta",)),
    Field("fe", "N", ("fex_N", "fey_N")),
    Field("fd", "N", ("fdx_N", "fdy_N")),
    Field("eps", "m", ("eps_m",)),
    Field("d_re", "m", ("d_re_m",)),
    Field("d_fe", "m", ("d_fe_m",)),
    Field("v_n", "m/s", ("v_n_mps",)),
    Field("tau_raw", "Nm", ("tau1_raw_Nm", "tau2_raw_Nm")),
    Field("tau", "Nm", ("tau1_Nm", "tau2_Nm")),
    Field("learnt", "1", tuple(f"learnt{i}" for i in range(1, 5))),
)
def _axes(name: str, unit: str) -> Tuple[str, ...]:
    return tuple(name.format(axis) + unit for axis in "xyz")


_NEAR = range(1, 17)

#: The same of space (include/ethd/space.h).
SPACE_FIELDS = (
    Field("time_ns", "ns", ("t_s",)),
    Field("have", "1", ("have",)),
    Field("missed", "1", ("missed",)),
    Field("step_ns", "ns", ("step_ns",)),
    Field("faults", "1", ("faults",)),
    Field("grave", "1", ("grave",)),
    Field("x", "m", ("x_m", "y_m", "z_m")),
    Field("v", "m/s", ("vx_mps", "vy_mps", "vz_mps")),
    Field("normal", "1", _axes("normal_{}", ""), (16,)),
    Field("finger", "m", _axes("finger_{}", "_m"), (1,)),
    Field("finger_v", "m/s", _axes("finger_v{}", "_mps"), (1,)),
    Field("sample_ns", "ns", ("t_reading_s",), (2,)),
    Field("reading", "m", _axes("reading_{}", "_m"), (2,)),
    Field("reading_v", "m/s", _axes("reading_v{}", "_mps"), (4,)),
    Field("reading_noise", "m", ("reading_noise_m",), (2,)),
    Field("reading_v_noise", "m/s", ("reading_v_noise_mps",), (4,)),
    Field(
        "ability",
        "m/s, m/s2, s, kg, N, N",
        ("able_speed_mps", "able_acceleration_mps2", "able_delay_s", "able_mass_kg", "able_force_N", "able_friction_N"),
        (32,),
    ),
    Field("commanded", "N, m/s", _axes("commanded_{}", ""), (128,)),
    Field("tick", "1", ("tick",)),
    Field("fault", "1", ("fault",)),
    Field("guard", "1", ("guard",)),
    Field("swap", "1", ("swap",)),
    Field("contacts", "1", ("contacts",)),
    Field("overflow", "1", ("overflow",)),
    Field("object", "1", ("object",)),
    Field("state", "1", ("state",)),
    Field("xf", "m", ("xf_m", "yf_m", "zf_m")),
    Field("vf", "m/s", ("vxf_mps", "vyf_mps", "vzf_mps")),
    Field("beta", "1", ("beta",)),
    Field("fe", "N", _axes("fe{}", "_N")),
    Field("fd", "N", _axes("fd{}", "_N")),
    Field("eps", "m", ("eps_m",)),
    Field("d_re", "m", ("d_re_m",)),
    Field("d_fe", "m", ("d_fe_m",)),
    Field("v_n", "m/s", ("v_n_mps",)),
    Field("speed", "m/s", ("speed_mps",)),
    Field("asked", "N, m/s", _axes("asked_{}", "")),
    Field("command", "N, m/s", _axes("command_{}", "")),
    Field("facing", "1", _axes("facing_{}", "")),
    Field("learnt", "1", tuple(f"learnt{i}" for i in range(1, 5))),
    Field("near", "1", ("near",)),
    Field("near_point", "m", tuple(f"near{i}_{axis}_m" for i in _NEAR for axis in "xyz")),
    Field("near_n", "1", tuple(f"near{i}_n{axis}" for i in _NEAR for axis in "xyz")),
    Field("near_v", "m/s", tuple(f"near{i}_v{axis}_mps" for i in _NEAR for axis in "xyz")),
    Field("near_id", "1", tuple(f"near{i}_id" for i in _NEAR)),
    Field("near_material", "1", tuple(f"near{i}_material" for i in _NEAR)),
)
INTEGERS = {"time_ns", "have", "missed", "step_ns", "faults", "grave", "sample_ns", "tick", "fault", "guard", "swap", "queried",
            "contacts", "overflow", "object", "body", "state", "near", "near_id", "near_material"}  # fmt: skip


def _dtype(fields: Sequence[Field]) -> "np.dtype[Any]":
    def entry(f: Field) -> Tuple[Any, ...]:
        kind = "=i8" if f.name in INTEGERS else "=f8"
        return (f.name, kind, (len(f.columns),)) if len(f.columns) > 1 else (f.name, kind)

    return np.dtype([entry(f) for f in fields])


def _newer() -> Set[str]:
    """Fields that a recording of an earlier version may lack: what follows on finger_noise in the sense, and on learnt."""
    names = [f.name for f in FIELDS]
    tick = names.index("tick")
    return {*names[names.index("finger_noise") : tick], *names[names.index("learnt") :]}


def fields_of(dtype: "np.dtype[Any]") -> Tuple[Field, ...]:
    """The fields that a recording's rows have, of the plane or of space; none: they are other rows."""
    newer, has = _newer(), set(dtype.names or ())
    for all_fields in FIELDS, SPACE_FIELDS:
        fields = tuple(f for f in all_fields if f.name in has or all_fields is SPACE_FIELDS or f.name not in newer)
        if dtype == _dtype(fields):
            return fields
    return ()


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
        try:
            self._rows = mapped(folder, "tick.npy")
        except (FileNotFoundError, NotADirectoryError) as e:
            raise Refusal(f"{folder}: no recording, whose tick.npy is needed: {reason(e)}; ethd-run --record makes one") from None
        self.count, self.fields = self._rows.size, fields_of(self._rows.dtype)
        if not self.fields or self._rows.ndim != 1:
            raise Refusal(f"{folder}/tick.npy: other columns than those of this version of libethd")

    def pieces(self) -> Iterator[NDArray[Any]]:
        for i in range(0, self.count, PIECE):
            yield self._rows[i : i + PIECE]
            file: Any = self._rows.base
            file.madvise(mmap.MADV_DONTNEED)  # else its pages stay in memory


def ahead(piece: NDArray[Any], last: Optional[int], shift: int) -> Tuple[NDArray[Any], int]:
    """What to add to a piece's instants, ns, and to the next ones, so that they never go back: where the recording's time
    starts again, as it does with each tap, it goes on a millisecond later. `last` is the instant before the piece as
    recorded, None at the beginning, and `shift` what was added to it."""
    time = piece["time_ns"]
    steps = np.diff(time, prepend=time[0] if last is None else last)
    shifts = shift + np.cumsum(np.where(steps < 0, 1_000_000 - steps, 0))
    return shifts, int(shifts[-1])


def utc_offset(found: List[RecordedEvent]) -> Optional[int]:
    """What added to the recording's instants gives UTC, ns since 1970, by the event `clock`; None: nobody knows."""
    for e in found:
        instant, _, date = e.detail.partition(" ")
        whole, _, fraction = date.rstrip("Z").partition(".")
        if e.kind == "clock" and instant.isdecimal() and fraction.isdecimal():
            seconds = datetime.datetime.strptime(whole + "+0000", "%Y-%m-%dT%H:%M:%S%z").timestamp()
            return int(seconds) * 1_000_000_000 + int(fraction.ljust(9, "0")[:9]) - int(instant)
    return None
