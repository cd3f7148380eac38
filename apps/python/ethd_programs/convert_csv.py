"""A recording's ticks as CSV."""
from typing import Any, Callable, List, Optional

import numpy as np
from numpy.typing import NDArray

from ethd_programs.files import Output
from ethd_programs.recording import Field, RecordedEvent, Ticks, utc_offset


def _seconds(instant: int) -> str:
    """ns as s, exactly; as other real numbers, with a point."""
    sign, instant = "-" if instant < 0 else "", abs(instant)
    text = f"{sign}{instant // 1_000_000_000}.{instant % 1_000_000_000:09d}".rstrip("0")
    return text + "0" if text.endswith(".") else text


def _cell(value: Any) -> str:
    return "" if value != value else repr(value)


def _cells(values: NDArray[Any], given: Optional[NDArray[np.bool_]], text: Callable[[Any], str]) -> List[str]:
    """A column of a piece. Most columns hardly change, and what is equal is written out once."""
    if len(values) and (values == values[0]).all():
        cells = [text(values[0].item())] * len(values)
    else:
        cells = [text(value) for value in values.tolist()]
    return cells if given is None else [cell if there else "" for cell, there in zip(cells, given)]


def _columns(piece: NDArray[Any], f: Field, shifts: NDArray[Any]) -> List[List[str]]:
    values = piece[f.name].reshape(len(piece), -1)
    given = [piece["have"] & bits != 0 if bits else None for bits in f.given_by]
    if f.unit == "ns" and f.columns[0].endswith("_s"):
        return [_cells(values[:, 0] + shifts, given[0], _seconds)]
    return [_cells(values[:, i], given[i % len(given)], _cell) for i in range(values.shape[1])]


def write(ticks: Ticks, events: List[RecordedEvent], out: str, folder: str, progress: Callable[[int, int], None]) -> None:
    names = [name for f in ticks.fields for name in f.columns]
    offset, done = utc_offset(events), 0
    with Output(out, folder) as file:
        file.write(",".join([names[0], "utc_s", *names[1:]]).encode() + b"\n")
        for piece, shifts in ticks.pieces():
            columns = [column for f in ticks.fields for column in _columns(piece, f, shifts)]
            utc = [""] * len(piece) if offset is None else [_seconds(t + offset) for t in piece["time_ns"].tolist()]
            columns.insert(1, utc)
            file.write(("\n".join(map(",".join, zip(*columns))) + "\n").encode())
            done += len(piece)
            progress(done, ticks.count)
